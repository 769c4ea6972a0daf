// How docking starts: what a user may set, and the bodies that come of it.
//
// Frames   bodies in model; SceneMeta maps it to world
// Thread   any, before the model runs
// Fails by StartupError: numbers that are not finite or out of range, too many bodies, a body of no structure
//          or out of a hand's reach
#pragma once

#include <cstdint>
#include <vector>

#include "ipc/scene/file/scene_meta.hpp"
#include "rt/force/docking/docking_bodies.hpp"
#include "rt/force/docking/docking_parts.hpp"

namespace tact {

struct DockingSettings {
    // Where the first body starts, away from its home: a distance in a random direction, an angle about a
    // random axis.
    double start_offset_m = 0.0;
    double start_rotation_rad = 0.0;
    std::uint64_t seed = 1;
    double force_scale = 1.0;  // times the scene's gain
    // In place of one body of each structure at home; the offset and rotation above are then not used.
    std::vector<StartBody> bodies{};
    // Behind the others.
    std::vector<StartBody> more_bodies{};
};

// The scene's gain, k_E, times the force scale.
double start_energy_j_per_sigma(const SceneMeta& meta, const DockingSettings& settings);
std::vector<StartBody> start_bodies(const DockingParts& parts, const DockingSettings& settings);

}  // namespace tact
