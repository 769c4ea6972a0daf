// Strength of the docking force: the energy per sigma of density, for a map and its structures.
//
// Chosen so that, over poses near high density and around the likely fits, the 99th percentile of the force is at most
// force_n (below the 3.3 N of a small haptic device) and the largest stiffness at most stiffness_n_m, which such a device
// renders stably at 1 kHz: the smaller of the two gains, over all structures. Measured with all atoms, and at the fits with
// every level of the codebook, in the maps in which they are felt.
//
// Unit     joules per sigma, as SceneMeta::energy_j_per_sigma. World is the hand's space, see SceneMeta
// Repeats  exactly for the same input and seed
// Thread   slow (about 150 ms per thousand atoms); never on the servo thread
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ipc/base/progress.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/level_maps.hpp"
#include "ipc/scene/density/structure.hpp"

namespace tact {

struct GainSettings {
    double force_n = 2.0;
    double stiffness_n_m = 300.0;
    std::uint32_t poses = 600;  // per structure
    std::uint32_t climbs = 16;  // per structure: starts of the search for fits
    std::uint64_t seed = 1;
};

struct DockingGain {
    double energy_j_per_sigma = 0.0;
    double force_n_p99 = 0.0;  // with this gain, over the poses
    double stiffness_n_m_max = 0.0, torque_n_m_rad_max = 0.0;
};

// A body with its home pose and the levels in which it is felt, in ascending size; the last is all atoms.
struct GainLevel {
    const DensityMap* map;
    PointsView points;
};
struct GainBody {
    std::vector<GainLevel> levels;
    Pose home;
};

// Throws StartupError if no pose overlaps any density.
DockingGain docking_gain(std::span<const GainBody> bodies, double world_per_model,
                         const GainSettings& settings = {}, const Progress& progress = {});
// The same; codebooks: one per structure, for which the maps were made.
DockingGain docking_gain(const LevelMaps& maps, std::span<const Structure> structures,
                         std::span<const Codebook> codebooks, double world_per_model,
                         const GainSettings& settings = {}, const Progress& progress = {});

}  // namespace tact
