#include "ipc/scene/density/contour_scale.hpp"

#include <algorithm>
#include <cmath>

namespace tact {

ContourScale::ContourScale(const DensityGrid& grid, double mean, double sigma)
    : mean_(mean), sigma_(sigma > 0.0 ? sigma : 0.0) {
    double least = INFINITY, greatest = -INFINITY;
    for (const float v : grid.values) {
        if (!std::isfinite(v)) continue;
        least = std::min(least, static_cast<double>(v));
        greatest = std::max(greatest, static_cast<double>(v));
    }
    if (least > greatest) return;
    least_ = least;
    greatest_ = greatest;
    above_.assign(kBins + 1, 0);
    const double per_bin = greatest > least ? static_cast<double>(kBins) / (greatest - least) : 0.0;
    for (const float v : grid.values) {
        if (!std::isfinite(v)) continue;
        const auto bin = static_cast<std::size_t>((static_cast<double>(v) - least) * per_bin);
        ++above_[std::min(bin, kBins - 1)];
    }
    for (std::size_t k = kBins; k-- > 0;) above_[k] += above_[k + 1];
    volume_m3_ = static_cast<double>(voxels()) * grid.spacing_m.prod();
}

double ContourScale::sigma_of(double level) const { return sigma_ > 0.0 ? (level - mean_) / sigma_ : 0.0; }

double ContourScale::fraction_inside(double level) const {
    if (voxels() == 0 || !(level < greatest_)) return 0.0;
    if (level < least_) return 1.0;
    const double place = (level - least_) / (greatest_ - least_) * static_cast<double>(kBins);
    const std::size_t bin = std::min(static_cast<std::size_t>(place), kBins - 1);
    const double into = std::clamp(place - static_cast<double>(bin), 0.0, 1.0);
    const double above =
        std::lerp(static_cast<double>(above_[bin]), static_cast<double>(above_[bin + 1]), into);
    return above / static_cast<double>(voxels());
}

double ContourScale::level_of_fraction(double fraction) const {
    if (voxels() == 0) return 0.0;
    const double wanted = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(voxels());
    // The first bin edge with at most the requested number of voxels above it.
    const auto at = std::find_if(above_.begin(), above_.end(), [wanted](std::uint64_t above) {
        return static_cast<double>(above) <= wanted;
    });
    const auto edge = static_cast<double>(at - above_.begin());
    double into = 0.0;
    if (at != above_.begin()) {
        const double in_bin = static_cast<double>(*(at - 1) - *at);
        into = (wanted - static_cast<double>(*at)) / in_bin;
    }
    return least_ + (edge - into) / static_cast<double>(kBins) * (greatest_ - least_);
}

std::vector<std::uint64_t> ContourScale::histogram(std::size_t bins) const {
    std::vector<std::uint64_t> counts(bins, 0);
    if (voxels() == 0 || bins == 0 || kBins % bins != 0) return counts;
    const std::size_t wide = kBins / bins;
    for (std::size_t k = 0; k < bins; ++k) counts[k] = above_[k * wide] - above_[(k + 1) * wide];
    return counts;
}

}  // namespace tact
