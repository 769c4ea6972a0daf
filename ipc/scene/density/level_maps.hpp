// The maps in which the codebook levels of structures are summed: smoothed by what each level loses.
//
// A vector stands for a cell of atoms. Their density, seen by the map, is that of a blob as wide as the cell; a bare vector
// sees details of the map that the atoms average out, and its force is wrong by as much as the force itself where the cells are
// wider than the map's resolution. A map smoothed by the variance of the cells restores the average, so a level differs from
// all atoms only by the third moments of its cells and by the shapes that differ from the mean.
//
// Memory   a smoothed map has fewer voxels where its smoothness permits. Levels share a map where their smoothings are
//          nearly equal, and where the maps would otherwise take more memory than kLevelMapBytes or the map itself:
//          then with the larger smoothing. Not counted: the fourfold copies of small maps
//          (DensityMap::Options), and one smoothed map is always made.
// Thread   slow (as smoothed_map.hpp); never on the servo thread
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"

namespace tact {

inline constexpr std::size_t kLevelMapBytes = std::size_t{256} << 20;

// Standard deviation of the smoothing for a level of these atoms in a map of this resolution; 0: none.
[[nodiscard]] double level_smoothing_m(const PointsView& level, const PointsView& atoms, double resolution_m);

// By structure and level, for all levels of the codebooks, one per structure.
[[nodiscard]] std::vector<std::vector<double>> level_smoothings_m(std::span<const Structure> structures,
                                                                  std::span<const Codebook> codebooks,
                                                                  double resolution_m);

struct LevelMaps {
    std::vector<DensityMap> maps;  // the first is the map itself
    std::vector<double> smoothing_m;
    std::vector<std::vector<std::size_t>> map_of;  // by structure and level
};

// smoothing_m: by structure and level.
[[nodiscard]] LevelMaps make_level_maps(const DensityGrid& grid, double background, double sigma,
                                        double resolution_m,
                                        const std::vector<std::vector<double>>& smoothing_m,
                                        std::size_t bytes_max = kLevelMapBytes);

}  // namespace tact
