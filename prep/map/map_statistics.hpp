// Statistics of a map's values that a scene needs: mean, spread, background and contour.
#pragma once

#include <string>

#include "ipc/scene/density/density_map.hpp"

namespace tact {

struct MapStatistics {
    double mean = 0.0, sigma = 0.0;  // over all voxels
    double low = 0.0, high = 0.0;
    double background = 0.0;  // median of the box faces; the map's value outside the box
};
MapStatistics map_statistics(const DensityGrid& grid);

struct ContourChoice {
    double level = 0.0;  // in the map's unit
    std::string rule;    // explanation for the note
};
// The level that best separates structure from solvent (Otsu 1979: largest variance between the two classes).
// Voxels with exactly the background value are excluded if they are at least a fifth of all (a masked map).
ContourChoice choose_contour(const DensityGrid& grid, const MapStatistics& statistics);

}  // namespace tact
