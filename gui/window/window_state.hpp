// Settings of the window from one run to the next: `--window-state FILE.toml`. They do not affect the force, which
//             starts
// as safe as without the file.
//
// Everywhere  size of the window, choice of plots, visible content
// Input       what SpaceMouse and gamepad do, and how they respond
// Of a scene  style and view: only for the scene of that checksum; others start with their defaults
// Fails       by StartupError with the key, its range and the file
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "gui/dashboard/input_choice.hpp"
#include "gui/dashboard/scene_toggles.hpp"
#include "ipc/base/pose.hpp"

namespace tact {

struct WindowState {
    static constexpr int kSpans = 5, kLateness = 3;
    int width_px = 1280, height_px = 720;
    bool traces = false;      // in place of the plots
    int span_choice = 0;      // of the plots, numbered as in the dashboard
    int lateness_choice = 0;  // likewise
    SceneToggles toggles;     // style, molecule and colouring are the scene's
    std::array<InputChoice, kInputDevices> input = kInputDefaults;  // SpaceMouse, gamepad
    std::uint64_t scene = 0;                                        // its checksum; 0: none was shown
    std::optional<Vec3>
        origin_model_a;  // of the frame of the scene, which another content moves; none: as it is now
    Vec3 target_a = Vec3::Zero();  // of the camera, in the frame of the scene
    Quat q_eye_scene = Quat::Identity();
    double distance_a = 0.0;  // 0: the scene's default view
};

[[nodiscard]] WindowState read_window_state_text(std::string_view text, const std::string& name);
// Without a file: the defaults.
[[nodiscard]] WindowState read_window_state_file(const std::filesystem::path& path);
// Reading it gives the same settings.
[[nodiscard]] std::string window_state_text(const WindowState& settings);
// Written completely or not at all.
void write_window_state_file(const std::filesystem::path& path, const WindowState& settings);

}  // namespace tact
