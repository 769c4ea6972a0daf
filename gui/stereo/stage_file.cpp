#include "gui/stereo/stage_file.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "gui/base/toml_keys.hpp"

namespace tact {
namespace {

constexpr const char* kStageFix = "gui/stereo/README.md lists the keys and their form";

}  // namespace

bool read_stereo_mode(const std::string& text, StereoMode& mode) {
    const auto* const found = std::find(std::begin(kStereoModes), std::end(kStereoModes), text);
    if (found == std::end(kStereoModes)) return false;
    mode = static_cast<StereoMode>(found - std::begin(kStereoModes));
    return true;
}

StageSettings read_stage_text(std::string_view text, const std::string& name) {
    const TomlKeys reader(name, kStageFix);
    StageSettings s;
    const auto place = [](Vec3& v) { return std::span<double>(v.data(), 3); };
    std::string mode = "off", scene = "orbit";
    std::vector<double> monitors, size{1280.0, 720.0}, quat{0.0, 0.0, 0.0, 1.0};
    double latency_ms = 1e3 * s.latency_s;
    const TomlKey keys[] = {
        {"mode", &mode},
        {"monitors", &monitors, 0.0, 63.0},
        {"size_px", std::span<double>(size), 320.0, 16384.0},
        {"place", &scene},
        {"latency_ms", std::span<double>(&latency_ms, 1), 0.0, 200.0},
        {"screen.lower_left_m", place(s.screen.lower_left_m), -100.0, 100.0},
        {"screen.lower_right_m", place(s.screen.lower_right_m), -100.0, 100.0},
        {"screen.upper_left_m", place(s.screen.upper_left_m), -100.0, 100.0},
        {"eyes.apart_m", std::span<double>(&s.eyes.apart_m, 1), 0.0, 0.2},
        {"eyes.swapped", &s.eyes.swapped},
        {"eyes.middle_head_m", place(s.eyes.middle_head_m), -0.5, 0.5},
        {"eyes.rest_screen_m", place(s.rest_screen_m), -10.0, 10.0},
        {"workspace.position_screen_m", place(s.T_screen_world.p_m), -10.0, 10.0},
        {"workspace.quat_screen_world_xyzw", std::span<double>(quat), -1.0, 1.0},
        {"wand.tip_sensor_m", place(s.wand_tip_sensor_m), -1.0, 1.0},
    };
    const std::vector<std::string> there = reader.read(text, keys);
    if (!read_stereo_mode(mode, s.mode)) {
        std::string all;
        for (const char* const each : kStereoModes) all += (all.empty() ? "" : ", ") + std::string(each);
        reader.fail("mode: ", "'" + mode + "' is none of " + all);
    }
    if (scene != "orbit" && scene != "workspace")
        reader.fail("place: ", "'" + scene + "' is neither orbit nor workspace");
    s.in_workspace = scene == "workspace";
    for (const double number : monitors) s.monitors.push_back(static_cast<int>(number));
    s.width_px = static_cast<int>(size[0]);
    s.height_px = static_cast<int>(size[1]);
    s.latency_s = 1e-3 * latency_ms;
    const Quat q(quat[3], quat[0], quat[1], quat[2]);
    if (std::abs(q.norm() - 1.0) > 0.01)
        reader.fail("workspace.quat_screen_world_xyzw: ", "its norm must be 1");
    s.T_screen_world.q = q.normalized();
    s.screen_measured = std::any_of(there.begin(), there.end(),
                                    [](const std::string& key) { return key.starts_with("screen."); });
    if (!s.screen.possible())
        reader.fail(
            "screen: ",
            "its corners do not form a rectangle of 1 cm to 100 m: the two edges at lower_left_m must "
            "be perpendicular");
    return s;
}

StageSettings read_stage_file(const std::filesystem::path& path) {
    return read_stage_text(read_typed_file(path, kStageFix), path.string());
}

}  // namespace tact
