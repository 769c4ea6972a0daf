// Force of the density on a body at a pose, for any knob setting.
//
// Knob      from 0, the smallest level of the structure, to 1, all atoms; adjacent levels are blended linearly. Each level is
//           summed in a map of its own smoothness (ipc/scene/density/level_maps.hpp).
// Work      with kept sums, large levels recompute only the budget's work fraction of their points
//           (partial_sums.hpp); the possible error of older sums is part of the published error.
// Frames    pose in model; wrench in world, at the body's centre of mass.
// Runs on   servo thread; a view that owns nothing, created per use. No allocation.
// Fails by  out_of_range: a pose that is not finite gives zero force. out_of_time: the wrench is that of a
//           smaller level, or of older sums.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ipc/base/rt.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "rt/force/docking/force_map.hpp"
#include "rt/force/docking/partial_sums.hpp"
#include "rt/force/docking/point_set.hpp"
#include "rt/force/force_model.hpp"

namespace tact {

// One for even and one for odd levels, so that the two blended levels have one each.
using KeptSums = std::array<PartialSums, 2>;

struct LevelBlend {
    const std::vector<DensityMap>& maps;
    const std::vector<PointSet>& levels;       // ascending sizes; the last is all atoms
    const std::vector<LevelMetrics>& metrics;  // of each level, in its map
    double error_scale;                        // factor on the errors in metrics
    double energy_j_per_sigma;
    double newtons_per_gradient;  // world force (N) per gradient (sigma per model metre)

    // Number of points of the larger level summed at a fidelity.
    [[nodiscard]] std::uint32_t items(float fidelity) const noexcept TACT_RT;
    // Predicted cost and error.
    [[nodiscard]] PathLoad predict(float fidelity) const noexcept TACT_RT;
    // kept: sums of earlier steps; null: sums all points, whatever the work fraction.
    [[nodiscard]] StepResult evaluate(const Pose& T_model_body, const Budget& budget,
                                      KeptSums* kept = nullptr) const noexcept TACT_RT;
    // Knob setting before the first measurement: the first level of 200 vectors or more.
    [[nodiscard]] float start_fidelity() const noexcept TACT_RT;

    struct Plan {  // levels to sum for a fidelity: (1 - blend) * lower + blend * upper
        std::size_t lower, upper;
        double blend;
    };
    [[nodiscard]] Plan plan(float fidelity) const noexcept TACT_RT;
    // The map in which a level is summed.
    [[nodiscard]] const DensityMap& map_of(std::size_t level) const noexcept TACT_RT {
        return maps[metrics[level].map];
    }

private:
    [[nodiscard]] double error_n(std::size_t level) const noexcept;
    // Sums one level at a pose.
    [[nodiscard]] PartialSums::Result sum_level(std::size_t level, const Pose& T_model_body,
                                                const Budget& budget, KeptSums* kept) const noexcept;
    [[nodiscard]] Wrench wrench(const DensitySums& sums) const noexcept;
};

}  // namespace tact
