// A density that the hand feels, and what each level of each structure costs and errs in it.
//
// Options   which of kDockingSubtraction and kDockingLaplacian went into the density; kForceMapOptions are those
//           that can be made.
// Laplacian ipc/scene/density/laplacian_map.hpp, at the resolution of the map or 20 A, whichever is coarser. Its
//           unit, in place of sigma, is such that the scene's own gain gives the force range of
//           ipc/scene/density/docking_gain.hpp.
// Subtract  all bodies but the one in the hand, ipc/scene/density/subtracted_map.hpp; before the Laplacian is taken.
//           The unit stays that of the whole map, so what is left feels as strong as before.
// Error     of a level: the largest |F_level - F_atoms| over seeded poses, with a margin. It is an estimate
//           of a bound, not a proof of one; error_audit.hpp goes on measuring while the loop runs.
// Thread    made off the servo thread, in up to seconds; never changes afterwards.
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
    Duration cost{0};      // of a sum, measured
    double error_n = 0.0;  // not rising with the level; 0 of all atoms
};

struct ForceMap {
    DensityMap map;
    std::uint32_t options = 0;
    // With subtraction: the body that was left in (an id), and ModelBodies::others of what was taken out.
    std::uint32_t active_id = 0;
    std::uint64_t others = 0;
    std::vector<std::vector<LevelMetrics>> metrics;  // by structure and level
};

// On what a sample of poses showed.
inline constexpr double kErrorMargin = 1.25;
inline constexpr std::uint32_t kForceMapOptions = kDockingSubtraction | kDockingLaplacian;
// The contours of finer maps are felt at this resolution: theirs are too narrow to be found (README.md).
inline constexpr double kContourResolutionM = 20e-10;

// newtons_per_gradient: of the force in the world, by the weighted gradient in sigma per model metre.
std::shared_ptr<const ForceMap> make_force_map(const DockingParts& parts, double newtons_per_gradient,
                                               std::uint32_t options, const ModelBodies& bodies);

}  // namespace tact
