// Which bricks are cut in a step: a fixed partition into groups, as many of them a step as the level allows.
//
// Groups   8 for a head of up to 48 voxels, more in proportion to its surface, up to 256. The level decides how many are
//          cut in a step, from one to all, in turn. Each keeps the place and the exposure since its own last cut, so a
//          lower level removes the same mass a little later.
// Passes   groups last cut in the same step have the same way and are cut in one pass, at most an eighth of all or
//          kPassGroups. The deadline is checked between passes; what is left waits for the next step.
// Start    a burr that starts cuts one group, then one more in each step: its cost is known before it is high.
// Wait     no group waits longer than kWaitSMost, whatever the level.
// Thread   servo; no allocation
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "ipc/base/knob.hpp"
#include "rt/force/drilling/burr_shapes.hpp"
#include "rt/force/drilling/erosion.hpp"

namespace tact {

class ErosionTurns {
public:
    static constexpr std::uint32_t kGroupsLeast = 8, kGroupsMost = 256, kPassGroups = 8;
    static constexpr double kGroupVoxels = 48.0;  // of a head, up to which there are kGroupsLeast
    static constexpr double kWaitSMost = 0.05;
    using Centres = std::array<Vec3, DrillTool::kMax>;

    explicit ErosionTurns(double head_radius_voxels) noexcept {
        const double size = head_radius_voxels / kGroupVoxels;
        while (groups_ < kGroupsMost && size * size * kGroupsLeast > groups_) groups_ *= 2;
    }
    [[nodiscard]] std::uint32_t groups() const noexcept TACT_RT { return groups_; }
    // Cut in a step of step_s at a level: 1 to groups(), in proportion from step to step of the knob.
    [[nodiscard]] std::uint32_t groups_at(float fidelity, double step_s) const noexcept TACT_RT;

    // Passes of a step that cuts so many groups, if those are always cut together.
    [[nodiscard]] std::uint32_t passes_of(std::uint32_t groups) const noexcept TACT_RT {
        return (groups + pass_groups() - 1) / pass_groups();
    }
    // Blocks that the last pass looked at.
    [[nodiscard]] double walked() const noexcept TACT_RT { return walked_; }

    // Nothing is pending; the way begins here.
    void forget(const Centres& now_voxels) noexcept TACT_RT;
    // most: of what one group can hold.
    void expose(double exposure, double most) noexcept TACT_RT;
    struct Job {
        const BrickKernels* kernels;
        const DrillTool* tool;
        const Centres* now_voxels;
        double per_voxel_m, soft;
        std::uint32_t groups;  // to be cut
        const Deadline* deadline;
    };
    struct Done {
        std::uint32_t wanted = 0, cut = 0;  // groups
    };
    Done cut(Erosion& erosion, const Job& job) noexcept TACT_RT;

    // Of a ball of weight 1: the mean over all groups, of what they were exposed to since their last cuts.
    [[nodiscard]] double pending() const noexcept TACT_RT { return pending_ / groups_; }
    // Of all groups, as of their last cuts; of groups that were not cut yet, as many as of the others. 0 where the burr
    // stands.
    struct Bricks {
        double computed = 0.0, changed = 0.0;
    };
    [[nodiscard]] Bricks bricks() const noexcept TACT_RT {
        const double all = known_ > 0 ? static_cast<double>(groups_) / known_ : 0.0;
        return {all * sum_.computed, all * sum_.changed};
    }

private:
    struct Group {
        Centres from_voxels{};
        double exposure = 0.0;   // since then, of a ball of weight 1
        std::uint64_t step = 0;  // of its last cut
        Bricks bricks;           // of its last cut
        bool was_cut = false;    // since the burr started
    };
    [[nodiscard]] std::uint32_t pass_groups() const noexcept TACT_RT {
        return std::max(kPassGroups, groups_ / kGroupsLeast);
    }

    std::array<Group, kGroupsMost> group_;
    std::uint32_t groups_ = kGroupsLeast, next_ = 0, started_ = 0;
    std::uint64_t step_ = 0;
    double pending_ = 0.0;  // sum over the groups
    Bricks sum_;            // the same
    double walked_ = 0.0;
    std::uint32_t known_ = 0;  // groups that were cut since the burr started
};

}  // namespace tact
