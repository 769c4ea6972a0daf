// Settings of the stereo display: mode, screen pose, eyes, and placement of the scene, from a TOML file edited by
// hand. README.md lists the keys; all are optional.
//
// Fails by StartupError with the key, its range and the file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "gui/render/screen.hpp"

namespace tact {

enum class StereoMode : std::uint8_t { off, anaglyph, side_by_side, top_bottom, two_windows, quad_buffer };
inline constexpr const char* kStereoModes[] = {"off",        "anaglyph",    "side-by-side",
                                               "top-bottom", "two-windows", "quad-buffer"};
[[nodiscard]] inline const char* stereo_mode_text(StereoMode mode) {
    return kStereoModes[static_cast<std::size_t>(mode)];
}
// Returns false for an unknown mode.
[[nodiscard]] bool read_stereo_mode(const std::string& text, StereoMode& mode);

struct StageSettings {
    StereoMode mode = StereoMode::off;
    std::vector<int> monitors;  // empty: inside the dashboard window if the mode allows
    int width_px = 1280, height_px = 720;
    bool in_workspace = false;
    double latency_s = 0.02;
    ScreenPlace screen = ScreenPlace::of_size(0.53, 0.30);  // a 24 inch monitor
    bool screen_measured = false;
    EyesOfHead eyes;
    Vec3 rest_screen_m = Vec3(0.0, 0.0, 0.6);
    Pose T_screen_world{Vec3(0.0, 0.0, 0.1), Quat::Identity()};
    Vec3 wand_tip_sensor_m = Vec3::Zero();  // of the pointer used in calibration

    // Uses separate windows.
    [[nodiscard]] bool own_windows() const {
        return mode == StereoMode::two_windows || mode == StereoMode::quad_buffer ||
               (mode != StereoMode::off && !monitors.empty());
    }
};

[[nodiscard]] StageSettings read_stage_text(std::string_view text, const std::string& name);
[[nodiscard]] StageSettings read_stage_file(const std::filesystem::path& path);

// All keys, with the remarks as comments in front; reading it gives the same stage, to the nanometre.
[[nodiscard]] std::string stage_text(const StageSettings& settings,
                                     std::span<const std::string> remarks = {});
// The file says what the settings say, to the digits that stage_text() writes. Throws StartupError if it cannot be read.
[[nodiscard]] bool is_in_stage_file(const StageSettings& settings, const std::filesystem::path& path);
// Written completely or not at all; an existing file is kept beside it under the returned name (empty: none existed).
// The new file is read back before it replaces the old one. Throws StartupError.
std::filesystem::path write_stage_file(const std::filesystem::path& path, const StageSettings& settings,
                                       std::span<const std::string> remarks = {});

}  // namespace tact
