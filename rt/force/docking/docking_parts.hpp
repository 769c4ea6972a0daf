// Data shared by all models of one docking scene: the map as read, structures, point sets.
//
// Levels   per structure: its codebook levels in ascending size, then all atoms. The first has at most kAlways
//          points, so that it fits every budget.
// Thread   made off the servo thread, then immutable; bodies and rebuilt models share it without a lock.
// Fails by StartupError: a scale, gain or pose that is not finite, levels that do not ascend, invalid points.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "rt/force/docking/clash_force.hpp"
#include "rt/force/docking/flexible_parts.hpp"
#include "rt/force/docking/point_set.hpp"

namespace tact {

// Unit of the Laplacian, independent of subtraction (force_map.hpp); computed at the first request, then kept.
struct LaplacianUnit {
    std::once_flag once;
    double value = 0.0;
};

struct DockingParts {
    // A level of at most this many points ignores the deadline: about 5 us.
    static constexpr std::size_t kAlways = 512;

    SceneMeta meta{};
    DensityGrid grid;  // map of the force without options
    std::vector<Structure> structures;
    std::vector<std::vector<PointSet>> levels;
    std::vector<FlexibleParts> flexible;  // by structure
    // By structure.
    std::vector<ClashField> clash;
    std::vector<double> gyration_m;  // radius
    ClashGains clash_gains;
    std::shared_ptr<LaplacianUnit> laplacian_unit = std::make_shared<LaplacianUnit>();
};

// codebooks: one per structure; modes: one per structure, or none.
std::shared_ptr<const DockingParts> make_docking_parts(const SceneMeta& meta, const DensityGrid& grid,
                                                       const std::vector<Structure>& structures,
                                                       const std::vector<Codebook>& codebooks,
                                                       const std::vector<NormalModes>& modes);

}  // namespace tact
