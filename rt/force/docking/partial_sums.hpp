// Sums a large level in slices. A step recomputes a fraction of the slices and reuses earlier sums for the rest.
// All points always count, so a change of the fraction causes no step of the force.
//
// Work      proportional to the fraction; slices are renewed in turn, so each is at most kSlices - 1 steps old.
//           Steps with less work are shorter, so the oldest sum is hardly older than a whole step takes.
// Late      after the deadline, slices with a sum near enough (kFarthestVoxels) are not recomputed: the step is
//           late but includes all points. Without such sums it is incomplete.
// Forced    a slice is recomputed at any fraction if its sum is of another level or map, does not exist, or is
//           more than kFarthestVoxels of motion old. A sum depends on nothing else, so grips, orders and resets
//           need no call.
// Stale     estimated error of reused sums: motion since each sum, times its largest recent change per motion,
//           times kMargin, added up. The density may be steeper in a direction without recent motion, so this is
//           no strict bound.
// Frame     gradients in sigma per model metre, model axes; motion is that of the fastest-moving point
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
    static constexpr std::size_t kPointsMin = 2048;  // smaller levels cost little beside the rest of a cycle
    static constexpr double kFarthestVoxels = 0.5;
    static constexpr double kMargin = 2.0;

    struct Result {
        DensitySums sums{};
        double stale = 0.0;                // estimated error of the gradient
        float recomputed_fraction = 1.0F;  // fraction of the points summed in this step
        bool complete = true;              // false: the deadline passed first; finished slices are kept
        bool late = false;                 // the deadline passed before all due slices were summed
    };

    // work_fraction in (0, 1]; other values count as 1. The pose must be finite.
    Result step(const DensityMap& map, const PointSet& points, const Pose& T_model_body, double work_fraction,
                const Deadline& deadline) noexcept TACT_RT;

private:
    struct Slice {
        DensitySums sums{};
        Pose made_at{};
        double slope = -1.0;  // recent change of the gradient per motion; negative: unknown
        bool made = false;
    };

    std::array<Slice, kSlices> slices_{};
    std::size_t next_ = 0;
    const DensityMap* map_ = nullptr;
    const PointSet* points_ = nullptr;
};

// Largest motion between two poses of a point within radius_m of the body's origin.
[[nodiscard]] double motion_m(const Pose& from, const Pose& to, double radius_m) noexcept TACT_RT;

// Sums in chunks and checks the deadline before each; false: the deadline passed first.
bool sum_until(const DensityMap& map, const PointsView& points, const Pose& T_model_body,
               const Deadline& deadline, DensitySums& sums) noexcept TACT_RT;

// The sum of a step: of a large level in slices, if a place for them is given. Slices read the map in another way than one
// large sum (density_map.cpp, kMany), so only this tells what a step costs.
PartialSums::Result sum_of_step(const DensityMap& map, const PointSet& points, const Pose& T_model_body,
                                double work_fraction, const Deadline& deadline,
                                PartialSums* kept) noexcept TACT_RT;

}  // namespace tact
