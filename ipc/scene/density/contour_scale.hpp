// What a contour level of a map means: in sigma, and in how much of the map it encloses; with the histogram.
//
// Counted  once, in kBins bins between the least and the greatest value. Voxels that are not finite count as
//          outside, as isosurface() has it, and are no part of the map's volume.
// Exact    up to a bin, within which values are taken as evenly spread.
// Thread   immutable after construction.
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

    ContourScale() = default;  // of no map: everything is 0
    // mean and sigma as the scene says them (SceneMeta); a sigma that is not positive makes all sigmas 0.
    ContourScale(const DensityGrid& grid, double mean, double sigma);

    [[nodiscard]] double sigma_of(double level) const;
    [[nodiscard]] double level_of_sigma(double sigma) const { return mean_ + sigma_ * sigma; }
    // Of the map's volume, above the level: 1 below the least value, 0 above the greatest.
    [[nodiscard]] double fraction_inside(double level) const;
    // The level that encloses this fraction, clamped to [0, 1].
    [[nodiscard]] double level_of_fraction(double fraction) const;
    [[nodiscard]] double volume_m3(double level) const { return fraction_inside(level) * volume_m3_; }

    [[nodiscard]] double least() const { return least_; }
    [[nodiscard]] double greatest() const { return greatest_; }
    [[nodiscard]] std::uint64_t voxels() const { return above_.empty() ? 0 : above_.front(); }
    // Voxels in so many bins of equal width from least() to greatest(); a power of two up to kBins.
    [[nodiscard]] std::vector<std::uint64_t> histogram(std::size_t bins) const;

private:
    double mean_ = 0.0, sigma_ = 0.0, least_ = 0.0, greatest_ = 0.0, volume_m3_ = 0.0;
    std::vector<std::uint64_t> above_;  // kBins + 1: voxels in bin k and all above; the last is 0
};

}  // namespace tact
