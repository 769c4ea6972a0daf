// The command line of the controller, and the settings from command line and configuration.
//
// Thread  start-up. A replay uses it too, to start the models as the recorded controller did.
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
    std::string flexible = "off";
    std::string poses;
    std::string resume, resume_identity;
    std::vector<std::string> levels;
    double tool_radius_mm = 0.0;
    SurfaceSettings surface;
};

// Values of the command line, which override those of the configuration file.
struct StartOverrides {
    std::optional<double> rate_hz, goal_hz, display_goal_hz, force_scale;
    std::optional<std::string> law, hand, hand2, surface_mode, pedal, burr_shape, burr_grit;
    std::optional<double> burr_mm, burr_rpm;
    std::vector<double> hand_at_mm;
    std::optional<int> core, priority;
    bool free_run = false, mouse = false;
};

void describe(CLI::App& app, StartOptions& options, StartOverrides& overrides);
// Throws StartupError for an invalid file or value.
[[nodiscard]] RtConfig configure(const StartOptions& options, const StartOverrides& overrides);

}  // namespace tact
