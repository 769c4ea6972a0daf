// The state of a training task: what is done, and the points so far.
//
// Points     each part has its share from 0 to 1 times what the plan says it is worth, over all that can be had in this
//            task; out of 100. A part that the task does not ask for, or that cannot be measured, is left out.
//   goal        mean over the goals of taken / asked, at most 1 each
//   thin        the same over the structures to thin; 0 for one that was injured
//   outside     1 while the bone taken outside of the goals is at most 5 % of the goals', 0 from 50 %
//   structures  1, halved by each injury of a critical structure and by each forbidden zone that lost more than allowed
//   force       1 - (share of the drilling time above kForceExcessN) / 0.2
//   sight       share of the drilling time in which the burr was seen / 0.8
//   time        1 until the plan's time, 0 from twice of it
// Care       the parts after thin count in proportion to the work that is done (the mean of goal and thin): who does nothing
//            gets nothing for doing it carefully
// Thread     any; pure
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gui/drilling/drill_metrics.hpp"
#include "gui/drilling/drill_report.hpp"
#include "gui/drilling/training/training_volumes.hpp"

namespace tact {

struct TrainingItem {
    enum class State : std::uint8_t { open, done, failed };
    State state = State::open;
    std::string name, value;
};
struct TrainingPoints {
    TrainingPart part = TrainingPart::goal;
    double points = 0.0, of = 0.0;
};
struct TrainingScore {
    std::vector<TrainingItem> item;
    std::vector<TrainingPoints> part;
    double total = 0.0;   // of 100
    double work = 0.0;    // share of it that is done
    double time_s = 0.0;  // since the burr first turned
};

// time_s: since the burr first turned.
[[nodiscard]] TrainingScore training_score(const TrainingPlan& plan, const TrainingSums& sums,
                                           const DrillMetricsRow& metrics, const BoneLabelsView& labels,
                                           const std::optional<BurrVisibility>& visibility, double time_s);

}  // namespace tact
