// Start of docking: the user's settings and the resulting bodies.
//
// Frames   bodies in model; SceneMeta converts it to world
// Thread   any, before the model runs
// Fails by StartupError: numbers that are not finite or out of range, too many bodies, a body of an unknown
//          structure or out of reach
#pragma once

#include <cstdint>
#include <vector>

#include "ipc/scene/file/scene_meta.hpp"
#include "rt/force/docking/docking_bodies.hpp"
#include "rt/force/docking/docking_parts.hpp"

namespace tact {

struct DockingSettings {
    // Start pose of the first body relative to its home: a distance in a random direction and an angle about a
    // random axis.
    double start_offset_m = 0.0;
    double start_rotation_rad = 0.0;
    std::uint64_t seed = 1;
    double force_scale = 1.0;  // times the scene's gain
    bool flexible = false;     // starts with kDockingFlexible; the scene must have modes
    // Replaces the default of one body of each structure at home; offset and rotation above are then unused.
    std::vector<StartBody> bodies{};
    // Appended to the bodies above.
    std::vector<StartBody> more_bodies{};
};

// The scene's gain k_E times the force scale (J/sigma).
double start_energy_j_per_sigma(const SceneMeta& meta, const DockingSettings& settings);
std::vector<StartBody> start_bodies(const DockingParts& parts, const DockingSettings& settings);

}  // namespace tact
