// Measures the stiffness of the levels in use while the loop runs, and bounds it in between.
//
// Measure   second derivatives of the summed density (DensityMap::bends), of all points of a level at the pose of one step, in
//           slices, one per step. A slice is as large as a measurement of kPass_s needs at the present length of a step, at
//           least kSliceMin points. With two blended levels they take turns, in kPassOfTwo_s each. So a result is at most a
//           tenth of a second older than its pose, and runs repeat exactly: no clock, no deadline.
// Bound     at the pose of the measurement, the measured value; from there it rises with the motion of the fastest-moving
//           point to the level's bound (LevelMetrics::bends) at kFarVoxels. Half a voxel is where the curvature of a map of three
//           voxels per resolution may go from nothing to its peak. Without a measurement: the level's bound.
// Raise     a measurement above the level's bound raises the bounds of all levels of this structure permanently, as for the
//           error (error_audit.hpp).
// Unit      spectral norms in sigma per model metre squared, and sigma per radian squared
// Runs on   servo thread, every step; no allocation
#pragma once

#include <array>
#include <cstddef>

#include "ipc/base/rt.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "rt/force/docking/force_map.hpp"
#include "rt/force/docking/level_blend.hpp"

namespace tact {

class StiffnessAudit {
public:
    static constexpr double kPass_s = 0.05, kPassOfTwo_s = 0.03;
    static constexpr std::size_t kSliceMin = 16;
    static constexpr double kFarVoxels = 0.5;

    // Call when map or body changes: drops all measurements.
    void restart() noexcept TACT_RT { *this = {}; }

    // Sums one slice for the levels of a fidelity, at the pose of this step. scale: factor on the levels' bounds, raised if
    // a measurement exceeds them.
    void step(const LevelBlend& blend, float fidelity, const Pose& T_model_body, double step_s,
              BendNorms& scale) noexcept TACT_RT;
    [[nodiscard]] BendNorms bound(const LevelBlend& blend, float fidelity, const Pose& T_model_body,
                                  const BendNorms& scale) const noexcept TACT_RT;
    // Of the last complete measurement of a level; negative: none.
    [[nodiscard]] BendNorms measured(std::size_t level) const noexcept TACT_RT;

private:
    struct Seen {
        BendNorms norms;
        Pose at;
        std::size_t level = kNone;
        std::size_t order = 0;  // of completion
    };
    static constexpr std::size_t kNone = ~std::size_t{0};

    [[nodiscard]] const Seen* seen(std::size_t level) const noexcept;
    [[nodiscard]] BendNorms bound_of(const LevelBlend& blend, std::size_t level, const Pose& T_model_body,
                                     const BendNorms& scale) const noexcept;
    void finish(const LevelBlend& blend, BendNorms& scale) noexcept;

    std::array<Seen, 2> seen_{};  // of an even and an odd level
    std::size_t level_ = kNone;   // being measured
    std::size_t next_ = 0, done_ = 0;
    Pose pose_;
    DensityBends sum_;
};

}  // namespace tact
