// What all models of one docking scene share, whatever they feel: the map as read, structures, point sets.
//
// Levels   of each structure: its codebook levels, sizes rising, then all atoms. The first has at most
//          kAlways points, so that it fits every budget.
// Thread   made off the servo thread; never changes afterwards, so copies of a body and rebuilt models share
//          it without a lock.
// Fails by StartupError: a scale, gain or place that is not finite, levels that do not rise, bad points.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "rt/force/docking/clash_force.hpp"
#include "rt/force/docking/point_set.hpp"

namespace tact {

// Of the Laplacian, the same whatever is subtracted (force_map.hpp): found when first asked for, then kept.
struct LaplacianUnit {
    std::once_flag once;
    double value = 0.0;
};

struct DockingParts {
    // A level of so few points is computed whatever the deadline says: some 5 us.
    static constexpr std::size_t kAlways = 512;

    SceneMeta meta{};
    DensityGrid grid;  // felt where no option is on
    std::vector<Structure> structures;
    std::vector<std::vector<PointSet>> levels;
    std::vector<ClashField> clash;  // by structure
    ClashGains clash_gains;
    std::shared_ptr<LaplacianUnit> laplacian_unit = std::make_shared<LaplacianUnit>();
};

// codebooks: one for each structure.
std::shared_ptr<const DockingParts> make_docking_parts(const SceneMeta& meta, const DensityGrid& grid,
                                                       const std::vector<Structure>& structures,
                                                       const std::vector<Codebook>& codebooks);

}  // namespace tact
