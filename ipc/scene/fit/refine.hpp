// Moves one structure from where it is to the nearest place where it fits the map best.
//
// Method   Steepest ascent over translation and rotation together. Its steps are measured by how far they
//          move the atoms (root mean square), so turning and shifting count alike. The uphill direction is
//          corrected by the curvature seen on the way (BFGS), else long narrow ridges would take hundreds
//          of steps.
// Local    No step moves the atoms by more than half a voxel, so it climbs the hill it stands on.
// Stops    when the next step would be below stop_m and stop_rad, after iterations_max, or when asked.
// Never    returns a pose with a lower score than that of the start.
// Repeats  exactly, for the same input on the same processor.
// Thread   slow (milliseconds to a second); never on the servo thread.
#pragma once

#include <cstdint>
#include <functional>

#include "ipc/base/units.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"

namespace tact {

enum class RefineGoal : std::uint8_t {
    mean_density,      // over atoms, weighted by mass: the energy that the hand feels
    correlation_zero,  // of the simulated map, as in ipc/scene/fit/fit_metrics.hpp, on points that move along
    correlation_mean,
};

struct RefineSettings {
    RefineGoal goal = RefineGoal::mean_density;
    double resolution_m = 0.0;      // for the correlations, > 0
    double background_sigma = 0.0;  // for correlation_zero: map value of density 0, in sigma of the map
    double step_m_max = 0.0;        // 0: half of the smallest voxel edge
    double stop_m = 0.01 * kAngstromM;
    double stop_rad = 0.01 * kDegreeRad;
    std::uint32_t iterations_max = 500;
};

enum class RefineEnd : std::uint8_t {
    converged,
    iterations,  // went uphill to the last one allowed
    cancelled,
    no_density,  // the map is flat where the structure is; nothing was moved
};

struct RefineResult {
    Pose T_model_body;
    double score_start = 0.0, score = 0.0;  // sigma, or a correlation
    std::uint32_t iterations = 0;
    RefineEnd end = RefineEnd::no_density;
};

// Called before every iteration; false cancels, and the best pose so far is returned.
using RefineProgress = std::function<bool(std::uint32_t iteration, double score)>;

// Throws StartupError where a correlation is asked for without a resolution, or the start is no pose.
RefineResult refine(const DensityMap& map, const Structure& structure, const Pose& start,
                    const RefineSettings& settings = {}, const RefineProgress& progress = {});

}  // namespace tact
