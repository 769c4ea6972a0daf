// A relaxed hand led by the docking force alone, with and without the pull towards places found.
//
// Hand     hal/sim/sim_hand.hpp, moved only by the force; 1000 cycles per second of its own time, not of the clock
// Force    of all atoms, at most 3 N and 0.1 N m, as a small device gives
// Thread   slow: about a second per run
#pragma once

#include <memory>
#include <vector>

#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"
#include "prep/search/search.hpp"

namespace tact::launch {

class HandInMap {
public:
    HandInMap(const DensityGrid& grid, const Structure& structure, double resolution_m);
    ~HandInMap();
    HandInMap(const HandInMap&) = delete;
    HandInMap& operator=(const HandInMap&) = delete;

    // Where the structure is after this time. places: pull it; none: no pull. laplacian: the force of the Laplacian of the map.
    [[nodiscard]] Pose led_from(const Pose& start, const std::vector<SearchHit>& places, bool laplacian,
                                double seconds) const;

private:
    struct Scene;
    std::unique_ptr<Scene> scene_;
};

}  // namespace tact::launch
