// The correlation of a structure in one orientation with a map, at every position of its origin, by Fourier transforms.
//
// Score      about the mean, over the voxels where the simulated density of the structure exceeds 5 % of its maximum:
//            the local correlation (Roseman 2000), equal to cc_mean of ipc/scene/fit/fit_metrics.hpp on the grid of the
//            search. Where the map hardly varies in that region, its deviation counts as kVaryLeast of that of the whole map
// Laplacian  optional: of both densities, by differences of neighbours, before the correlation
// Grid       cubes of voxel_m; the map is smoothed to the resolution of the search and continues as 0 beyond its box
// Thread     MapWaves: immutable; one RotationScore per thread
#pragma once

#include <vector>

#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"
#include "ipc/scene/fit/refine.hpp"
#include "prep/map/fft_volume.hpp"

namespace tact {

inline constexpr double kSearchVoxelsPerResolution = 3.5;

struct SearchMap {
    double resolution_m = 0.0, voxel_m = 0.0;
    bool laplacian = false;
    DensityGrid grid;  // background 0
    std::vector<std::array<std::uint32_t, 3>>
        inside;  // voxels of at least one standard deviation above the mean
};
// resolution_m: of the map; search_m: of the search, not finer.
[[nodiscard]] SearchMap search_map(const DensityGrid& map, double background, double resolution_m,
                                   double search_m, bool laplacian,
                                   double voxels_per_resolution = kSearchVoxelsPerResolution);

// Six times each value less its neighbours; 0 outside.
[[nodiscard]] std::vector<float> laplacian_of(const std::vector<float>& values,
                                              const std::array<std::uint32_t, 3>& size);

// The values that such a map would have in the region of the structure, on a grid of the structure.
[[nodiscard]] CorrelationPoints search_points(const Structure& structure, const SearchMap& map);

inline constexpr double kBeadsPerResolution = 5.0;  // cubes along the resolution of the search
// At most one atom per cube of cell_m, with the weight of the atoms that it stands for.
[[nodiscard]] Structure coarse_structure(const Structure& structure, double cell_m);
[[nodiscard]] double radius_m(const Structure& structure);  // about the origin

// The density of a structure in one orientation, on a cube of voxels with the structure's origin in the middle.
struct Frame {
    Frame(const Structure& structure, const SearchMap& map);
    // False: no density.
    bool fill(const Structure& structure, const Quat& turn, const SearchMap& map);
    [[nodiscard]] bool inside(std::size_t i) const { return density_[i] > least_; }  // the region
    [[nodiscard]] const std::vector<float>& value() const { return filtered_.empty() ? density_ : filtered_; }

    std::uint32_t reach;  // voxels from the middle to a face
    DensityGrid grid;     // without values

private:
    std::vector<float> density_, filtered_;
    float least_ = 0.0F;
};

// The transforms of a map and of its square, padded for a structure.
class MapWaves {
public:
    MapWaves(const SearchMap& map, const Structure& structure);

private:
    friend class RotationScore;
    const SearchMap& map_;
    const Structure& structure_;
    Frame frame_;
    FftVolume fft_;
    FftBuffer<std::complex<float>> values_, squares_;
    double vary_least_2_;
};

struct SearchPeak {
    Vec3 at_m = Vec3::Zero();  // of the structure's origin
    double score = 0.0;
};

class RotationScore {
public:
    static constexpr double kVaryLeast = 0.1;

    explicit RotationScore(const MapWaves& map);
    // Scores of all positions; false if the structure has no density there.
    bool at(const Quat& turn);
    // Their highest local maxima, the best first. Between voxels, by parabolas. within_m of middle_m; 0: anywhere.
    [[nodiscard]] std::vector<SearchPeak> peaks(std::size_t most, const Vec3& middle_m = Vec3::Zero(),
                                                double within_m = 0.0) const;
    // At a voxel of the search map.
    [[nodiscard]] float score(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        const auto& n = map_.fft_.size();
        return score_.data()[(std::size_t{z} * n[1] + y) * n[0] + x];
    }

private:
    void correlate(const FftBuffer<std::complex<float>>& model, const FftBuffer<std::complex<float>>& with,
                   FftBuffer<float>& to);

    const MapWaves& map_;
    Frame frame_;
    FftBuffer<float> score_, mean_, square_;
    FftBuffer<std::complex<float>> model_, mask_, product_;
};

}  // namespace tact
