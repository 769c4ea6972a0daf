// What a scene needs to know about a map's values: mean, spread, what it continues with, where its surface
// is.
#pragma once

#include <string>

#include "ipc/scene/density/density_map.hpp"

namespace tact {

struct MapStatistics {
    double mean = 0.0, sigma = 0.0;  // over all voxels
    double low = 0.0, high = 0.0;
    double background = 0.0;  // median of the faces of the box: the map is continued with it outside
};
MapStatistics map_statistics(const DensityGrid& grid);

struct ContourChoice {
    double level = 0.0;  // in the map's unit
    std::string rule;    // in words
};
// The level that parts structure from solvent best (Otsu 1979: the largest variance between the two classes).
// In a masked map, where at least a fifth of the voxels has exactly the background value, those do not count.
ContourChoice choose_contour(const DensityGrid& grid, const MapStatistics& statistics);

}  // namespace tact
