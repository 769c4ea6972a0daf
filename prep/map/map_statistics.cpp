// Why Otsu: the contour of a fixed fraction of the voxels or a multiple of sigma depends on the amount of empty box
// around the structure; Otsu's threshold hardly does. tests/unit/prep_real_files_test.cpp states the fraction of the
// atoms of fitted structures inside the contour for each published map.
#include "prep/map/map_statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace tact {

MapStatistics map_statistics(const DensityGrid& grid) {
    MapStatistics s;
    const auto count = static_cast<double>(grid.values.size());
    s.low = s.high = static_cast<double>(grid.values.front());
    for (const float v : grid.values) {
        s.mean += static_cast<double>(v);
        s.low = std::min(s.low, static_cast<double>(v));
        s.high = std::max(s.high, static_cast<double>(v));
    }
    s.mean /= count;
    for (const float v : grid.values)
        s.sigma += (static_cast<double>(v) - s.mean) * (static_cast<double>(v) - s.mean);
    s.sigma = std::sqrt(s.sigma / count);
    std::vector<float> faces;
    std::size_t i = 0;
    for (std::uint32_t z = 0; z < grid.size[2]; ++z) {
        for (std::uint32_t y = 0; y < grid.size[1]; ++y) {
            for (std::uint32_t x = 0; x < grid.size[0]; ++x, ++i) {
                if (x == 0 || y == 0 || z == 0 || x + 1 == grid.size[0] || y + 1 == grid.size[1] ||
                    z + 1 == grid.size[2])
                    faces.push_back(grid.values[i]);
            }
        }
    }
    const auto middle = faces.begin() + static_cast<std::ptrdiff_t>(faces.size() / 2);
    std::nth_element(faces.begin(), middle, faces.end());
    s.background = static_cast<double>(*middle);
    return s;
}

ContourChoice choose_contour(const DensityGrid& grid, const MapStatistics& statistics) {
    const auto background = static_cast<float>(statistics.background);
    const auto flat =
        static_cast<std::size_t>(std::count(grid.values.begin(), grid.values.end(), background));
    const bool masked = flat >= grid.values.size() / 5;
    constexpr std::size_t kBins = 1024;
    std::array<double, kBins> histogram{};
    const double width = (statistics.high - statistics.low) / kBins;
    double total = 0.0, moment = 0.0;
    for (const float v : grid.values) {
        if (masked && v == background) continue;
        const auto bin =
            std::min(static_cast<std::size_t>((static_cast<double>(v) - statistics.low) / width), kBins - 1);
        histogram[bin] += 1.0;
        total += 1.0;
        moment += static_cast<double>(bin);
    }
    double below = 0.0, moment_below = 0.0, best = -1.0;
    std::size_t best_bin = kBins / 2;
    for (std::size_t bin = 0; bin + 1 < kBins; ++bin) {
        below += histogram[bin];
        moment_below += static_cast<double>(bin) * histogram[bin];
        if (below == 0.0 || below == total) continue;
        const double difference = moment * below / total - moment_below;
        const double between = difference * difference / (below * (total - below));
        if (between > best) {
            best = between;
            best_bin = bin;
        }
    }
    ContourChoice choice;
    choice.level = statistics.low + width * (static_cast<double>(best_bin) + 1.0);
    const auto inside = std::count_if(grid.values.begin(), grid.values.end(),
                                      [&](float v) { return static_cast<double>(v) >= choice.level; });
    char text[200];
    std::snprintf(text, sizeof text,
                  "%.5g, Otsu's threshold of the histogram%s; %.2f sigma above the mean, %.2f %% of the "
                  "voxels inside",
                  choice.level, masked ? " of the voxels inside the mask" : "",
                  (choice.level - statistics.mean) / statistics.sigma,
                  100.0 * static_cast<double>(inside) / static_cast<double>(grid.values.size()));
    choice.rule = text;
    return choice;
}

}  // namespace tact
