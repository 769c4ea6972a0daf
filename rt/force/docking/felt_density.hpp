// A density that the hand feels, and what each level of each structure costs and errs in it.
//
// Options   which of kOptionSubtraction and kOptionLaplacian went into the density; kFeltOptions are those
//           that can be made.
// Error     of a level: the largest |F_level - F_atoms| over seeded poses, with a margin. It is an estimate
// of
//           a bound, not a proof of one; error_audit.hpp goes on measuring while the loop runs.
// Thread    made off the servo thread, in up to seconds; never changes afterwards.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "ipc/assets/density_map.hpp"
#include "ipc/base/clock.hpp"
#include "rt/force/docking/docking_parts.hpp"
#include "rt/force/force_model.hpp"

namespace tact {

struct LevelFigures {
    Duration cost{0};      // of a sum, measured
    double error_n = 0.0;  // not rising with the level; 0 of all atoms
};

struct FeltDensity {
    DensityMap map;
    std::uint32_t options = 0;
    // With subtraction: the body that was left in (an id), and ModelBodies::others of what was taken out.
    std::uint32_t active_id = 0;
    std::uint64_t others = 0;
    std::vector<std::vector<LevelFigures>> figures;  // by structure and level
};

inline constexpr std::uint32_t kFeltOptions = 0;

// newtons_per_gradient: of the force in the world, by the weighted gradient in sigma per model metre.
std::shared_ptr<const FeltDensity> make_felt_density(const DockingParts& parts, double newtons_per_gradient,
                                                     std::uint32_t options, const ModelBodies& bodies);

}  // namespace tact
