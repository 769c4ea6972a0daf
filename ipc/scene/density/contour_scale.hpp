// Converts a contour level of a map to sigma and to the enclosed fraction of the map; also gives the
// histogram.
//
// Counts   once, in kBins bins between the least and the greatest value. Non-finite voxels count as
//          outside, as in isosurface(), and do not belong to the map's volume.
// Exact    up to a bin, within which values are assumed to be evenly distributed
// Thread   immutable after construction
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ipc/scene/density/density_map.hpp"

namespace tact {

class ContourScale {
public:
    static constexpr std::size_t kBins = 4096;

    ContourScale() = default;  // without a map: everything is 0
    // mean and sigma from SceneMeta; for a sigma that is not positive, all sigmas are 0.
    ContourScale(const DensityGrid& grid, double mean, double sigma);

    [[nodiscard]] double sigma_of(double level) const;
    [[nodiscard]] double level_of_sigma(double sigma) const { return mean_ + sigma_ * sigma; }
    // Fraction of the map's volume above the level: 1 below the least value, 0 above the greatest.
    [[nodiscard]] double fraction_inside(double level) const;
    // The level that encloses this fraction, clamped to [0, 1].
    [[nodiscard]] double level_of_fraction(double fraction) const;
    [[nodiscard]] double volume_m3(double level) const { return fraction_inside(level) * volume_m3_; }

    [[nodiscard]] double least() const { return least_; }
    [[nodiscard]] double greatest() const { return greatest_; }
    [[nodiscard]] std::uint64_t voxels() const { return above_.empty() ? 0 : above_.front(); }
    // Voxels in `bins` bins of equal width from least() to greatest(); a power of two up to kBins.
    [[nodiscard]] std::vector<std::uint64_t> histogram(std::size_t bins) const;

private:
    double mean_ = 0.0, sigma_ = 0.0, least_ = 0.0, greatest_ = 0.0, volume_m3_ = 0.0;
    std::vector<std::uint64_t> above_;  // kBins + 1 entries: voxels in bin k and above; the last is 0
};

}  // namespace tact
