// Moves one structure to the nearest local optimum of its fit to the map.
//
// Method   steepest ascent over translation and rotation together. The step length is the root mean square
//          displacement of the atoms, so rotation and translation count alike. The curvature along the way
//          corrects the uphill direction (BFGS); otherwise long narrow ridges would take hundreds of steps
// Local    no step moves the atoms by more than half a voxel, so the search climbs the nearest maximum
// Stops    when the next step would be below stop_m and stop_rad, after iterations_max, or on cancellation
// Result   never has a lower score than the start
// Repeats  exactly, for the same input on the same processor
// Thread   slow (milliseconds to a second); never on the servo thread
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "ipc/base/units.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"

namespace tact {

enum class RefineGoal : std::uint8_t {
    mean_density,      // mass-weighted over atoms: the energy of the docking force
    correlation_zero,  // of the simulated map (fit_metrics.hpp), on points that move with the structure
    correlation_mean,
};

// Points of a structure with the values that the map should have there, up to a factor and an offset.
struct CorrelationPoints {
    std::vector<Vec3> at_m;  // body frame
    std::vector<double> value;
};

struct RefineSettings {
    RefineGoal goal = RefineGoal::mean_density;
    double resolution_m = 0.0;                  // for the correlations, > 0
    const CorrelationPoints* points = nullptr;  // for the correlations; null: the simulated map
    double background_sigma = 0.0;  // for correlation_zero: map value of density 0, in sigma of the map
    double step_m_max = 0.0;        // 0: half of the smallest voxel edge
    double stop_m = 0.01 * kAngstromM;
    double stop_rad = 0.01 * kDegreeRad;
    std::uint32_t iterations_max = 500;
};

enum class RefineEnd : std::uint8_t {
    converged,
    iterations,  // iterations_max was reached
    cancelled,
    no_density,  // the map is flat at the structure; the structure was not moved
};

struct RefineResult {
    Pose T_model_body;
    double score_start = 0.0, score = 0.0;  // sigma, or a correlation
    std::uint32_t iterations = 0;
    RefineEnd end = RefineEnd::no_density;
};

// Called before every iteration; false cancels, and refine() returns the best pose so far.
using RefineProgress = std::function<bool(std::uint32_t iteration, double score)>;

// Throws StartupError for a correlation without a resolution, or an invalid start pose.
RefineResult refine(const DensityMap& map, const Structure& structure, const Pose& start,
                    const RefineSettings& settings = {}, const RefineProgress& progress = {});

}  // namespace tact
