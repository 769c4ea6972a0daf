// Refines placed structures in turns, each in the map that all others leave.
//
// Goal     the sum of squares of map - scale * sum of the simulated densities. It falls when a structure climbs the smoothed
//          rest of the map, because the sum of squares of its own density does not depend on its pose
// Thread   slow (seconds); allocates
#pragma once

#include <vector>

#include "ipc/scene/density/simulated_map.hpp"

namespace tact {

void refine_in_turns(const DensityGrid& map, double background, double resolution_m,
                     std::vector<PlacedStructure>& placed, int turns);

}  // namespace tact
