// What an operator set in the window, from one run to the next: `--window-state FILE.toml`. Nothing of it is felt; force begins as
// safe as without it.
//
// Everywhere  size of the window, which plots, what is shown
// Of a scene  how it is drawn and from where it is seen: for the scene of that checksum, others begin as they are
// Fails       by StartupError that names the key, its range and the file
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "gui/dashboard/scene_toggles.hpp"
#include "ipc/base/pose.hpp"

namespace tact {

struct WindowState {
    static constexpr int kSpans = 5, kLateness = 3;
    int width_px = 1280, height_px = 720;
    bool traces = false;           // in the place of the plots
    int span_choice = 0;           // of the plots, as the dashboard numbers them
    int lateness_choice = 0;       // likewise
    SceneToggles toggles;          // style, molecule and colouring are the scene's
    std::uint64_t scene = 0;       // its checksum; 0: none was shown
    Vec3 target_a = Vec3::Zero();  // of the camera, in the frame of the scene
    Quat q_eye_scene = Quat::Identity();
    double distance_a = 0.0;  // 0: as the scene begins
};

[[nodiscard]] WindowState read_window_state_text(std::string_view text, const std::string& name);
// Where there is no file: as a window begins without one.
[[nodiscard]] WindowState read_window_state_file(const std::filesystem::path& path);
// Read again it is the same.
[[nodiscard]] std::string window_state_text(const WindowState& settings);
// Whole, or as it was.
void write_window_state_file(const std::filesystem::path& path, const WindowState& settings);

}  // namespace tact
