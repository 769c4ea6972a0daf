// The density map that makes the force, with cost and error of each level of each structure in it.
//
// Options   kDockingSubtraction and kDockingLaplacian, as applied to the density; kForceMapOptions holds both.
// Laplacian ipc/scene/density/laplacian_map.hpp, at the resolution of the map or 20 A, whichever is coarser. Its
//           unit replaces sigma and is chosen so that the scene's gain gives the force range of
//           ipc/scene/density/docking_gain.hpp.
// Subtract  removes all bodies except the one in the hand (ipc/scene/density/subtracted_map.hpp) before the
//           Laplacian. The unit stays that of the whole map, so the remaining density keeps its force.
// Error     of a level: the largest |F_level - F_atoms| over seeded poses, with a margin. It estimates a bound
//           without proof; error_audit.hpp continues to measure while the loop runs.
// Thread    made off the servo thread, in up to seconds; then immutable.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/topics/bodies.hpp"
#include "rt/force/docking/docking_parts.hpp"
#include "rt/force/force_model.hpp"

namespace tact {

struct LevelMetrics {
    Duration cost{0};      // measured cost of a sum
    double error_n = 0.0;  // does not rise with the level; 0 for all atoms
};

struct ForceMap {
    DensityMap map;
    std::uint32_t options = 0;
    // With subtraction: id of the body that was not subtracted, and ModelBodies::others at that time.
    std::uint32_t active_id = 0;
    std::uint64_t others = 0;
    std::vector<std::vector<LevelMetrics>> metrics;  // by structure and level
};

// Factor on the largest error over the sampled poses.
inline constexpr double kErrorMargin = 1.25;
inline constexpr std::uint32_t kForceMapOptions = kDockingSubtraction | kDockingLaplacian;
// Finer maps use the contours of this resolution: their own are too narrow to find by hand (README.md).
inline constexpr double kContourResolutionM = 20e-10;

// newtons_per_gradient: world force (N) per weighted gradient (sigma per model metre).
std::shared_ptr<const ForceMap> make_force_map(const DockingParts& parts, double newtons_per_gradient,
                                               std::uint32_t options, const ModelBodies& bodies);

}  // namespace tact
