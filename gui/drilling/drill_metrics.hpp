// What a trainee did: bone taken, by structure and near to critical ones, force, strokes, times, injuries.
//
// Fed       every servo cycle (traces), the newest state of the tools, every brick that changed
// Numbers   of the burr in the first hand. Drilling: it turns. Cutting: and bone went in that cycle.
//           Force is what the hand was shown; excess is above kForceExcessN while drilling.
//           Near: distance of the head's surface (times), or of the voxel that went (volumes), to a critical structure.
//           An injury is bone of a critical structure that goes, after none of it went for kInjuryPauseS.
//           Cycles that nobody saw, as the window was not there or stood still, are counted, not guessed.
// Unit      SI in the hand's space; bone in levels, 255 a voxel of solid bone
// Thread    one
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gui/drilling/strokes.hpp"
#include "gui/drilling/structure_watch.hpp"
#include "ipc/scene/bone/bone_labels.hpp"
#include "ipc/topics/event.hpp"

namespace tact {

inline constexpr std::array kDrillNearM{1e-3, 2e-3};  // red and amber
inline constexpr double kForceExcessN = 2.0, kInjuryPauseS = 1.0, kDrillGapS = 0.05;

// Of one labelled structure, or of bone that is none.
struct StructureMetrics {
    std::uint64_t removed_levels = 0;
    std::uint64_t injuries = 0;
    double nearest_m = 1e9;                           // while the burr turned; critical ones alone
    std::array<double, kDrillNearM.size()> near_s{};  // drilling within; likewise
};

struct DrillMetricsRow {
    double seen_s = 0.0, drilling_s = 0.0, cutting_s = 0.0;
    std::uint64_t unseen_cycles = 0;
    double force_cutting_n_s = 0.0, force_n_most = 0.0, excess_s = 0.0;  // impulse while cutting
    double path_m = 0.0;  // of the burr's centre while drilling
    StrokeMetrics strokes;
    std::uint64_t removed_levels = 0;
    std::array<std::uint64_t, kDrillNearM.size()> near_levels{};
    std::array<double, kDrillNearM.size()> near_s{};  // drilling within, of any critical structure
    std::uint64_t injuries = 0;
    std::vector<StructureMetrics> structure;  // by label; the first is bone without one
    double level_m3 = 0.0;

    [[nodiscard]] double force_cutting_n() const {
        return cutting_s > 0.0 ? force_cutting_n_s / cutting_s : 0.0;
    }
};

class DrillMetrics {
public:
    // What is referred to must outlive it.
    DrillMetrics(const BoneBricks& bricks, const BoneLabelsView& labels,
                 std::span<const DistanceField> fields, const SceneMeta& meta);

    void tools(const DrillTopic& drill);
    void cycle(const TraceTopic& trace);
    void unseen(std::uint64_t cycles) { metrics_.unseen_cycles += cycles; }
    // cut_now: at the time of the newest cycle; else it had gone when the controller was found. Returns the label of
    // the critical structure that is injured by it anew, or 0.
    std::uint8_t brick(std::uint32_t brick, std::span<const std::uint8_t> before,
                       std::span<const std::uint8_t> after, bool cut_now);

    [[nodiscard]] DrillMetricsRow metrics() const;

private:
    [[nodiscard]] double nearest_critical_m(const Vec3& model_m) const;

    BoneBricks bricks_;
    const BoneLabelsView& labels_;
    std::span<const DistanceField> fields_;
    SceneMeta meta_;
    DrillMetricsRow metrics_;
    Strokes strokes_;
    HeadBalls head_;  // of the burr, when tools() was last called
    Vec3 head_at_m_ = Vec3::Zero();
    bool head_known_ = false, seen_ = false;
    double cycle_s_ = 0.0;
    Vec3 path_at_m_ = Vec3::Zero();
    std::vector<double> injured_s_;  // by label: when it was cut last
};

}  // namespace tact
