// Strength of the docking force: the energy per sigma of density, for a map and its structures.
//
// Chosen so that, over poses near high density, the 99th percentile of the force is at most force_n (below
// the 3.3 N of a small haptic device) and the largest stiffness at most stiffness_n_m, which such a device
// renders stably at 1 kHz: the smaller of the two gains, over all structures.
//
// Unit     joules per sigma, as SceneMeta::energy_j_per_sigma. World is the hand's space, see SceneMeta
// Repeats  exactly for the same input and seed
// Thread   slow (about 30 ms per structure); never on the servo thread
#pragma once

#include <cstdint>
#include <span>

#include "ipc/base/progress.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"

namespace tact {

struct GainSettings {
    double force_n = 2.0;
    double stiffness_n_m = 300.0;
    std::uint32_t poses = 600;  // per structure
    std::uint64_t seed = 1;
};

struct DockingGain {
    double energy_j_per_sigma = 0.0;
    double force_n_p99 = 0.0;  // with this gain, over the poses
    double stiffness_n_m_max = 0.0;
};

// A body as some hundreds of points, with its home pose.
struct GainBody {
    PointsView points;
    Pose home;
};
// Enough vectors to represent the body, few enough for thousands of sums.
inline constexpr std::size_t kGainVectors = 800;

// Throws StartupError if no pose overlaps any density.
DockingGain docking_gain(const DensityMap& map, std::span<const GainBody> bodies, double world_per_model,
                         const GainSettings& settings = {}, const Progress& progress = {});
// The same; codebooks: one per structure.
DockingGain docking_gain(const DensityMap& map, std::span<const Structure> structures,
                         std::span<const Codebook> codebooks, double world_per_model,
                         const GainSettings& settings = {}, const Progress& progress = {});

}  // namespace tact
