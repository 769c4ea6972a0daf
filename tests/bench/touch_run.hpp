// Steps a surface model along a path and measures forces, times and the progress of the proxy.
//
// Method   runs whole steps of the servo's model, without a servo. The path runs `passes` times. If `paced` is set, the
//          first pass runs at the rate of a loop, in a thread configured like the servo thread. best_us is the minimum
//          time of a step over all passes.
// stands   the proxy is stuck: it has not settled, and the step did not bring it closer to the tool
// Fails by StartupError if tact-prep fails
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ipc/scene/mesh/surface_mesh.hpp"
#include "rt/force/surface/surface_model.hpp"
#include "tests/bench/percentiles.hpp"

namespace tact::launch {

struct TouchStep {
    Vec3 force_n = Vec3::Zero();
    double us = 0.0;                      // in the first pass
    double best_us = 1e300;               // minimum over all passes
    bool settled = true, stands = false;  // stands: stuck, see above
    bool adaptive = false;                // the step used the adaptive surface
};

inline constexpr std::uint64_t kJammedRow = 5;  // consecutive stuck cycles that count as a jam
inline constexpr std::size_t kSlowUpdateEvery =
    4;  // steps per slow update: 250 updates per second, as in the slow-update thread

// Bakes a scene without a preview; tact-prep gets these arguments before -o. Returns its JSON output.
nlohmann::json bake_to_measure(const std::vector<std::string>& arguments, const std::filesystem::path& scene);

// world_per_model: scale factor; 1: the size in the file. forest: for mode chr; its slow update runs after every fourth
// step and is not included in the times. The force has faded in before the path begins. paced: true: the first pass is
// paced (loop_thread.hpp); false: all passes run without pauses.
std::vector<TouchStep> touch_along(const SurfaceMesh& surface, const std::vector<Vec3>& path_model_m,
                                   const SurfaceSettings& settings, int passes, double world_per_model = 1.0,
                                   const VertexForest* forest = nullptr, bool paced = false);

Percentiles times_us(const std::vector<TouchStep>& steps);       // of the first pass
Percentiles best_times_us(const std::vector<TouchStep>& steps);  // of the minimum over all passes
std::uint64_t jammed_cycles(const std::vector<TouchStep>& steps);
std::uint64_t unsettled_cycles(const std::vector<TouchStep>& steps);

}  // namespace tact::launch
