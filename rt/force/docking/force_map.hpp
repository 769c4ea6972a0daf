// The density maps that make the force, with cost, error and stiffness of each level of each structure in its map.
//
// Options   kDockingSubtraction and kDockingLaplacian, as applied to the density; kForceMapOptions holds both.
// Laplacian ipc/scene/density/laplacian_map.hpp, at the resolution of the map or 20 A, whichever is coarser. Its
//           unit replaces sigma and is chosen so that the scene's gain gives the force range of
//           ipc/scene/density/docking_gain.hpp.
// Subtract  removes all bodies except the one in the hand and the copies that move along with it (ipc/scene/density/subtracted_map.hpp) before the
//           Laplacian. The unit stays that of the whole map, so the remaining density keeps its force.
// Levels    the first map is that of all atoms; codebook levels have smoothed ones (ipc/scene/density/level_maps.hpp).
// Stiffness of a level: the largest over some of these poses and over the maxima to which home and other poses climb, with a
//           margin; a bound without proof too, raised while the loop runs (stiffness_audit.hpp).
// Error     of a level: the largest |F_level - F_atoms| over seeded poses and around maxima, with a margin. It estimates a bound
//           without proof; error_audit.hpp continues to measure while the loop runs.
// Thread    made off the servo thread, in up to seconds; then immutable.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/topics/bodies.hpp"
#include "rt/force/docking/docking_parts.hpp"
#include "rt/force/force_model.hpp"

namespace tact {

// Spectral norms of the second derivatives of the summed density (DensityBends).
struct BendNorms {
    double by_shift = 0.0;  // sigma per model metre squared
    double by_turn = 0.0;   // sigma per radian squared
};

struct LevelMetrics {
    Duration cost{0};      // measured cost of a sum
    double error_n = 0.0;  // does not rise with the level; 0 for all atoms
    std::size_t map = 0;   // index in ForceMap::maps
    BendNorms bends{};     // bound
};

struct ForceMap {
    std::vector<DensityMap> maps;
    std::uint32_t options = 0;
    // With subtraction: id of the body that was not subtracted, and ModelBodies::others at that time.
    std::uint32_t active_id = 0;
    std::uint64_t others = 0;
    std::vector<std::vector<LevelMetrics>> metrics;  // by structure and level
};

// Factors on the largest error and stiffness over the sampled poses.
inline constexpr double kErrorMargin = 2.0, kStiffnessMargin = 1.25;
inline constexpr std::uint32_t kForceMapOptions = kDockingSubtraction | kDockingLaplacian;
// Finer maps use the contours of this resolution: their own are too narrow to find by hand (README.md).
inline constexpr double kContourResolutionM = 20e-10;

// newtons_per_gradient: world force (N) per weighted gradient (sigma per model metre).
std::shared_ptr<const ForceMap> make_force_map(const DockingParts& parts, double newtons_per_gradient,
                                               std::uint32_t options, const ModelBodies& bodies);

}  // namespace tact
