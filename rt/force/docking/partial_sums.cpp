// Staleness depends on motion, not on time: at rest old sums stay exact, and during motion only the distance from
// the pose of the sum counts. Between two poses, every point within r of the body's origin moves by at most
// |dp| + 2 r sin(angle / 2).
#include "rt/force/docking/partial_sums.hpp"

#include <algorithm>
#include <cmath>

namespace tact {

namespace {

// Points between two readings of the clock: about 25 us.
constexpr std::size_t kChunk = 2048;
// Smaller motion is below the rounding of the sums and does not update the slope.
constexpr double kStillVoxels = 1e-4;
// Decay of the slope per renewal; a peak lasts for about a hundred renewals.
constexpr double kSlopeKept = 0.99;

void add(DensitySums& to, const DensitySums& part) {
    to.density_sigma += part.density_sigma;
    to.gradient += part.gradient;
    to.moment += part.moment;
}

}  // namespace

bool sum_until(const DensityMap& map, const PointsView& points, const Pose& T_model_body,
               const Deadline& deadline, DensitySums& sums) noexcept {
    sums = DensitySums{};
    const std::size_t n = points.size();
    for (std::size_t begin = 0; begin < n; begin += kChunk) {
        if (deadline.passed()) return false;
        const std::size_t count = std::min(kChunk, n - begin);
        add(sums, map.sum({points.x.subspan(begin, count), points.y.subspan(begin, count),
                           points.z.subspan(begin, count), points.weight.subspan(begin, count)},
                          T_model_body));
    }
    return true;
}

double motion_m(const Pose& from, const Pose& to, double radius_m) noexcept {
    // |q1 - q2| = 2 sin(angle / 4), for the nearer of q and -q.
    const double apart =
        std::min((to.q.coeffs() - from.q.coeffs()).norm(), (to.q.coeffs() + from.q.coeffs()).norm());
    return (to.p_m - from.p_m).norm() + 2.0 * radius_m * apart;
}

PartialSums::Result PartialSums::step(const DensityMap& map, const PointSet& points, const Pose& T_model_body,
                                      double share, const Deadline& deadline) noexcept {
    if (map_ != &map || points_ != &points) {
        map_ = &map;
        points_ = &points;
        slices_.fill({});
    }
    const bool part = share > 0.0 && share < 1.0;
    const auto due = part ? static_cast<std::size_t>(std::ceil(share * kSlices)) : kSlices;
    const double voxel_m = map.spacing_m().minCoeff();
    const std::size_t n = points.size(), first = next_;
    Result result;
    std::size_t summed = 0;
    for (std::size_t turn = 0; turn < kSlices; ++turn) {
        const std::size_t k = (first + turn) % kSlices;
        Slice& slice = slices_[k];
        const double moved_m = slice.made ? motion_m(slice.made_at, T_model_body, points.radius_m) : 0.0;
        const double most = slice.slope < 0.0 ? kStillVoxels : kFarthestVoxels;
        const bool near = slice.made && moved_m <= most * voxel_m;
        const std::size_t begin = k * n / kSlices, end = (k + 1) * n / kSlices;
        DensitySums sums;
        const bool due_now = turn < due || !near;
        if (due_now && !result.late)
            result.late = !sum_until(map, points.view(begin, end - begin), T_model_body, deadline, sums);
        if (due_now && result.late && !near) {
            result.complete = false;
            break;
        }
        if (!due_now || result.late) {
            result.stale += kMargin * std::max(slice.slope, 0.0) * moved_m;
            continue;
        }
        summed += end - begin;
        if (moved_m > kStillVoxels * voxel_m)
            slice.slope =
                std::max((sums.gradient - slice.sums.gradient).norm() / moved_m, kSlopeKept * slice.slope);
        slice.sums = sums;
        slice.made_at = T_model_body;
        slice.made = true;
        if (turn < due) next_ = (k + 1) % kSlices;
    }
    for (const Slice& slice : slices_) add(result.sums, slice.sums);  // fixed order: runs repeat exactly
    result.recomputed_fraction = static_cast<float>(static_cast<double>(summed) / static_cast<double>(n));
    return result;
}

PartialSums::Result sum_of_step(const DensityMap& map, const PointSet& points, const Pose& T_model_body,
                                double work_fraction, const Deadline& deadline, PartialSums* kept) noexcept {
    if (kept != nullptr && points.size() >= PartialSums::kPointsMin)
        return kept->step(map, points, T_model_body, work_fraction, deadline);
    PartialSums::Result result;
    result.complete = sum_until(map, points.view(), T_model_body, deadline, result.sums);
    result.late = !result.complete;
    if (!result.complete) result.recomputed_fraction = 0.0F;
    return result;
}

}  // namespace tact
