// Steps a surface model along a path, for measurements: forces, times, and progress of the proxy.
//
// Method   whole steps of the servo's model, without a servo. A path is gone along `passes` times. The first pass is
//          timed as a loop would see it, paced in a thread like the servo's where asked for; best_us is the
//          least time of a step in all passes.
// Stands   a proxy that is not where it should be and came no nearer
// Fails by StartupError: tact-prep does not bake.
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
    double us = 0.0;         // in the first pass
    double best_us = 1e300;  // least of all passes
    bool settled = true, stands = false;
    bool adaptive = false;  // the step used the adaptive surface
};

inline constexpr std::uint64_t kJammedRow = 5;  // so many consecutive cycles without progress are a jam
inline constexpr std::size_t kSlowUpdateEvery =
    4;  // steps: 250 updates per second, as the slow-update thread makes

// Bakes a scene with tact-prep and these arguments before -o, without a preview; returns its JSON output.
nlohmann::json bake_to_measure(const std::vector<std::string>& words, const std::filesystem::path& scene);

// world_per_model: 1 is as large as in its file. forest: for mode chr, whose slow update runs between every
// fourth step and the next, and not counted. The force has faded in when the path begins. paced: the first pass, see
// loop_thread.hpp; else steps follow each other at once.
std::vector<TouchStep> touch_along(const SurfaceMesh& surface, const std::vector<Vec3>& path_model_m,
                                   const SurfaceSettings& settings, int passes, double world_per_model = 1.0,
                                   const VertexForest* forest = nullptr, bool paced = false);

Percentiles times_us(const std::vector<TouchStep>& steps);       // of the first pass
Percentiles best_times_us(const std::vector<TouchStep>& steps);  // of the best of all passes
std::uint64_t jammed_cycles(const std::vector<TouchStep>& steps);
std::uint64_t unsettled_cycles(const std::vector<TouchStep>& steps);

}  // namespace tact::launch
