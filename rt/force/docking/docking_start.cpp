#include "rt/force/docking/docking_start.hpp"

#include <array>
#include <cmath>
#include <string>

#include "ipc/base/error.hpp"
#include "ipc/scene/density/start_place.hpp"
#include "rt/force/docking/reach.hpp"
#include "rt/force/docking/start_pose.hpp"

namespace tact {

double start_energy_j_per_sigma(const SceneMeta& meta, const DockingSettings& settings) {
    const std::array<double, 3> given{settings.force_scale, settings.start_offset_m,
                                      settings.start_rotation_rad};
    for (const double v : given) {
        if (!std::isfinite(v)) {
            throw StartupError("setting up docking", "a start offset, rotation or force scale is not finite",
                               "give finite numbers");
        }
    }
    if (settings.force_scale < 0.0 || settings.force_scale > 100.0) {
        throw StartupError("setting up docking", "the force scale is not in [0, 100]",
                           "use a value of 1 or slightly less");
    }
    return meta.energy_j_per_sigma * settings.force_scale;
}

std::vector<StartBody> start_bodies(const DockingParts& parts, const DockingSettings& settings) {
    std::vector<StartBody> start = settings.bodies;
    if (start.empty()) {
        const std::vector<Pose> places = start_places(parts.grid, parts.structures);
        for (std::uint32_t s = 0; s < places.size(); ++s)
            start.push_back({.structure = s, .T_model_body = places[s]});
        start[0].T_model_body = start_pose(start[0].T_model_body, settings.start_offset_m,
                                           settings.start_rotation_rad, settings.seed);
    }
    start.insert(start.end(), settings.more_bodies.begin(), settings.more_bodies.end());
    if (start.size() > ModelBodies::kMax)
        throw StartupError("setting up docking", "there are " + std::to_string(start.size()) + " bodies",
                           "start with at most " + std::to_string(ModelBodies::kMax));
    for (const StartBody& body : start) {
        if (body.structure >= parts.structures.size() || !is_placeable(parts.meta, body.T_model_body))
            throw StartupError("setting up docking",
                               "a body has an unknown structure, or a pose too far from the map",
                               "use structures and poses of this scene");
    }
    return start;
}

}  // namespace tact
