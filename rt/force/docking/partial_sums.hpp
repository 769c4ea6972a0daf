// The sums of a big level in slices, so that a step may do a share of the work anew and use older sums for
// the rest. What is given up is freshness, not points: a share that changes moves nothing.
//
// Work      in proportion to the share; slices are renewed in turn, so with any share each of them is at most
//           kSlices - 1 steps old. As a step with less to do is over sooner, the oldest sum is hardly older
//           than the time that all of them take.
// Late      once the deadline has passed nothing is summed any more where an older sum is near enough (kFarthestVoxels): the
//           step is late, but no point is left out. Without such sums it is not complete.
// Whole     with share 1; and slice by slice, whatever the share, where a sum says nothing: of another level
//           or density, never made, or made more than kFarthestVoxels of motion ago. A sum is a function of
//           these and of the place, so no grip, order or reset need be told.
// Stale     what the old sums may be off by: the motion since each was made, times the most that the sum
//           changed per motion lately, times kMargin, added up. An estimate of a bound: in a direction in
//           which the body has not moved lately the density may be steeper.
// Frame     gradients in sigma per model metre, model axes; motion is that of the point that moves most
// Thread    one; no allocation
#pragma once

#include <array>
#include <cstddef>

#include "ipc/base/knob.hpp"
#include "ipc/base/rt.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "rt/force/docking/point_set.hpp"

namespace tact {

class PartialSums {
public:
    static constexpr std::size_t kSlices = 8;
    static constexpr std::size_t kPointsMin = 2048;  // below, a step costs little beside the cycle around it
    static constexpr double kFarthestVoxels = 0.5;
    static constexpr double kMargin = 2.0;

    struct Result {
        DensitySums sums{};
        double stale = 0.0;                // of the gradient
        float recomputed_fraction = 1.0F;  // of the points, summed in this step
        bool complete = true;              // else the deadline came first; the slices made by then are kept
        bool late = false;                 // the deadline passed before all due slices were summed
    };

    // share in (0, 1]; anything else is 1. The pose finite.
    Result step(const DensityMap& map, const PointSet& points, const Pose& T_model_body, double work_fraction,
                const Deadline& deadline) noexcept TACT_RT;

private:
    struct Slice {
        DensitySums sums{};
        Pose made_at{};
        double slope = -1.0;  // of the gradient per motion, lately; negative: not known
        bool made = false;
    };
    [[nodiscard]] double motion_m(const Pose& from, const Pose& to) const noexcept TACT_RT;

    std::array<Slice, kSlices> slices_{};
    std::size_t next_ = 0;
    const DensityMap* map_ = nullptr;
    const PointSet* points_ = nullptr;
};

// In pieces, with a look at the clock before each; false: the deadline came first.
bool sum_until(const DensityMap& map, const PointsView& points, const Pose& T_model_body,
               const Deadline& deadline, DensitySums& sums) noexcept TACT_RT;

}  // namespace tact
