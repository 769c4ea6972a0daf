// Fidelity knobs: the interface of a rendering path to the governor, and the path's report.
//
// A fidelity is a number in [0, 1]. Cost rises with it and error falls with it. A path never sets its own
// level; the governor does, and every change is published.
#pragma once

#include <array>
#include <cstdint>

#include "ipc/base/clock.hpp"
#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

struct KnobSpec {
    const char* path = "";    // "docking.force", "gui.mesh"
    float floor = 0.0F;       // lowest level that is still correct; always fits the budget
    float start = 1.0F;       // level before the first measurement
    float slew_per_s = 1e9F;  // fastest imperceptible change
    bool haptic = false;      // haptic levels are lowered last
    // Equally spaced levels, from 0 to 1, between which a level costs as much as both of its neighbours; 0: none.
    std::uint32_t steps = 0;
    // Of a visual path: how much worse the display looks when the level falls by a given factor, relative to other paths. With levels at
    // their best, paths spend time in proportion to this weight.
    float loss = 1.0F;
};

// Reason for a level.
enum class LevelReason : std::uint8_t {
    start,
    hold,
    rate_low,
    rate_high,
    at_floor,
    at_top,
    by_command,
    display_low,  // the frame rate's own target, not the force rate's
    display_high,
    cost_high,        // the cost of a step no longer fits the period
    cost_low,         // a level with a smaller error fits
    deadline_missed,  // a step ended after its deadline
};

// Cost and error of one step. The unit of the error belongs to the path (N for forces).
struct PathLoad {
    Duration cost{0};
    Duration cost_predicted{0};  // of a whole step at the level, or of the work of this step; 0: unknown
    Duration cost_foreseen{0};   // of a contact that may come, ForceModel::predict(); 0: none
    double error = 0.0;
    std::uint32_t items = 0;  // vertices drawn, points summed, particles moved
    float recomputed_fraction =
        1.0F;  // of the items: summed in this step; the rest are sums of earlier steps
    // In (0, 1]: of the level's work, the part finished before the deadline. 1 where no deadline cut the step.
    float work_done = 1.0F;
};

// Checks of one deadline: their number, and the check that found it passed. Stored by the owner of the
// deadline and recorded; in a replay, the recorded values make the same check find it passed.
struct DeadlineChecks {
    std::uint32_t checks = 0;
    std::uint32_t passed_at = 0;  // from 1; 0: never found passed
    bool replayed = false;        // passed_at decides, not a clock
};

// Deadline of a step; none by default. Only passed() can be queried.
class Deadline {
public:
    Deadline() = default;
    Deadline(Instant at, DeadlineChecks* checks = nullptr) noexcept : at_(at), checks_(checks) {}

    [[nodiscard]] bool passed() const noexcept TACT_RT {
        if (checks_ == nullptr) return at_ != Instant::max() && Monotonic::now() >= at_;
        ++checks_->checks;
        if (!checks_->replayed && checks_->passed_at == 0 && at_ != Instant::max() && Monotonic::now() >= at_)
            checks_->passed_at = checks_->checks;
        return checks_->passed_at != 0 && checks_->checks >= checks_->passed_at;
    }

private:
    Instant at_ = Instant::max();
    DeadlineChecks* checks_ = nullptr;
};

// Resources of a step. The level fixes the work before the step starts, so that runs repeat exactly; the
// deadline is a safeguard.
struct Budget {
    float fidelity = 1.0F;
    Deadline deadline = {};
    // In (0, 1]: the fraction of the level's work to recompute, for a model that can keep the rest from
    // earlier steps. Nothing is omitted. For periods too short for a change of the level.
    float work_fraction = 1.0F;
};

}  // namespace tact
