// A map without the density explained by placed structures, so that the next structure is not attracted to
// their places.
//
// Model     map - background = scale * simulated + rest, with simulated_map.hpp at the map's resolution.
//           The scale is the least-squares one over the region where the simulated density is above 5 % of
//           its largest value, and not negative
// Result    map - scale * simulated, in the map's unit, same voxels and frame. Its lower bound is the
//           background, or the map where that is lower: a deficit under a structure must not repel the next
//           one
// Thread    slow (30 ms for 27 000 atoms in 100^3 voxels); never on the servo thread. Allocates two copies
// Errors    StartupError if the resolution is not positive and finite. Structures off the map leave it
//           unchanged
#pragma once

#include <cstdint>
#include <span>

#include "ipc/scene/density/simulated_map.hpp"

namespace tact {

struct SubtractedMap {
    DensityGrid grid;
    double scale = 0.0;      // map unit per unit of simulated density
    double explained = 0.0;  // fraction of the region's squared density, 1: all of it
    std::uint64_t region_voxels = 0;
};

[[nodiscard]] SubtractedMap subtract_placed(const DensityGrid& grid, double background,
                                            std::span<const PlacedStructure> placed, double resolution_m);

}  // namespace tact
