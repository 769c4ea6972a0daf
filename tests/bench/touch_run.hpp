// Steps a surface model along a path, for measurements: forces, times, and progress of the proxy.
//
// Method   whole steps of the servo's model, on one core and without a servo. The path is repeated `passes`
//          times, and the minimum time of each position counts, which excludes other users of the machine.
// Stands   the proxy is not settled and came no nearer to its goal
// Fails by StartupError: tact-prep fails.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ipc/scene/mesh/surface_mesh.hpp"
#include "rt/force/surface/surface_model.hpp"

namespace tact::launch {

struct TouchStep {
    Vec3 force_n = Vec3::Zero();
    double us = 1e300;
    bool settled = true, stands = false;
    bool adaptive = false;  // the step used the adaptive surface
};

inline constexpr std::uint64_t kJammedRow = 5;  // so many consecutive cycles without progress are a jam
inline constexpr std::size_t kSlowUpdateEvery =
    4;  // steps: 250 updates per second, as the slow-update thread makes

// Bakes a scene with tact-prep and these arguments before -o, without a preview; returns its JSON output.
nlohmann::json bake_to_measure(const std::vector<std::string>& words, const std::filesystem::path& scene);

// world_per_model: 1 is true size. forest: for mode chr; its slow update runs after every fourth step and is not
// timed. The force has faded in when the path begins.
std::vector<TouchStep> touch_along(const SurfaceMesh& surface, const std::vector<Vec3>& path_model_m,
                                   const SurfaceSettings& settings, int passes, double world_per_model = 1.0,
                                   const VertexForest* forest = nullptr);

double percentile_us(const std::vector<TouchStep>& steps, double share);
std::uint64_t jammed_cycles(const std::vector<TouchStep>& steps);
std::uint64_t unsettled_cycles(const std::vector<TouchStep>& steps);

}  // namespace tact::launch
