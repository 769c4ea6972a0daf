// The command line of the controller, and what follows from it and from the configuration.
//
// Thread  start-up. Also of a replay, which starts the models as the recorded controller did.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rt/config/config.hpp"
#include "rt/force/surface/surface_model.hpp"

namespace CLI {
class App;
}

namespace tact {

struct StartOptions {
    std::string scene, session = "default", config, check_config;
    double seconds = 0.0;
    bool arm = false, arm_with_gui = false, check = false, json = false;
    double start_offset_a = 0.0, start_rotation_deg = 0.0;
    std::uint64_t seed = 1;
    std::uint32_t copies = 1;
    std::string poses;
    std::vector<std::string> levels;
    double tool_radius_mm = 0.0;
    SurfaceSettings surface;
};

// The command line goes on top of the file, so it is parsed into these and applied after it.
struct StartOverrides {
    std::optional<double> rate_hz, goal_hz, display_goal_hz, force_scale;
    std::optional<std::string> law, hand, hand2, surface_mode, pedal, burr_shape;
    std::optional<double> burr_mm, burr_rpm;
    std::vector<double> hand_at_mm;
    std::optional<int> core, priority;
    bool free_run = false;
};

void describe(CLI::App& app, StartOptions& options, StartOverrides& overrides);
// Throws StartupError for a file or value that cannot be.
[[nodiscard]] RtConfig configure(const StartOptions& options, const StartOverrides& overrides);

}  // namespace tact
