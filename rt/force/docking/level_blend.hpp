// The density's force on a body at a place, at any setting of the knob.
//
// Knob      from 0, the smallest level of the structure, to 1, all atoms; neighbours are blended linearly.
// Share     where sums of steps before are kept, big levels sum only the budget's share of their points anew
//           (partial_sums.hpp); what that may be off by is part of the error.
// Frames    the place in model, the wrench in world, at the body's centre of mass.
// Runs on   servo thread, made anew where it is needed: it is a view, and owns nothing. No allocation.
// Fails by  out_of_range: a pose that is not finite gives no force. out_of_time: the wrench is that of a
//           smaller level.
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

// By whether a level is an even or an odd one, so that the two that are blended have one each.
using KeptSums = std::array<PartialSums, 2>;

struct LevelBlend {
    const DensityMap& map;
    const std::vector<PointSet>& levels;       // sizes rising; the last is all atoms
    const std::vector<LevelMetrics>& metrics;  // of each level, in this map
    double error_scale;                        // times the error of the figures
    double energy_j_per_sigma;
    double newtons_per_gradient;  // of the force in the world, by the gradient in sigma per model metre

    // Points of the bigger level that a fidelity sums.
    [[nodiscard]] std::uint32_t items(float fidelity) const noexcept TACT_RT;
    // Cost and error before anything is computed.
    [[nodiscard]] PathLoad predict(float fidelity) const noexcept TACT_RT;
    // kept: of the steps before; null: all of it is summed, whatever the share.
    [[nodiscard]] StepResult evaluate(const Pose& T_model_body, const Budget& budget,
                                      KeptSums* kept = nullptr) const noexcept TACT_RT;
    // Where the knob stands before the first measurement: the first level of 200 vectors or more.
    [[nodiscard]] float start_fidelity() const noexcept TACT_RT;

private:
    struct Plan {  // levels to be summed for a fidelity: (1 - blend) * lower + blend * upper
        std::size_t lower, upper;
        double blend;
    };

    [[nodiscard]] Plan plan(float fidelity) const noexcept;
    [[nodiscard]] double error_n(std::size_t level) const noexcept;
    // One level at a place.
    [[nodiscard]] PartialSums::Result sum_level(std::size_t level, const Pose& T_model_body,
                                                const Budget& budget, KeptSums* kept) const noexcept;
    [[nodiscard]] Wrench wrench(const DensitySums& sums) const noexcept;
};

}  // namespace tact
