#include "gui/window/window_state.hpp"

#include <array>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "gui/base/toml_keys.hpp"
#include "ipc/base/whole_file.hpp"

namespace tact {
namespace {

constexpr const char* kFix = "gui/README.md lists the keys; or remove the file: a new one is written";
constexpr std::array<const char*, 3> kStyles{"glass", "solid", "wire"};
constexpr std::array<const char*, 6> kMolecules{"trace", "tube", "sticks", "spheres", "cartoon", "surface"};
constexpr std::array<const char*, 4> kColourings{"chain", "element", "body", "fit"};
constexpr std::array<const char*, WindowState::kSpans> kSpanNames{"1 min", "10 min", "1 h", "6 h", "24 h"};
constexpr std::array<const char*, WindowState::kLateness> kLatenessNames{"last minute", "whole run",
                                                                         "over time"};
constexpr std::array<const char*, kInputDevices> kInputKeys{"spacemouse", "gamepad"};
constexpr double kFarA = 1e13, kNoOrigin = 2.0 * kFarA;

struct Flag {
    const char* name;
    bool SceneToggles::*value;
};
constexpr Flag kFlags[] = {{"show.surface", &SceneToggles::surface},
                           {"show.backbone", &SceneToggles::backbone},
                           {"show.codebook", &SceneToggles::codebook},
                           {"show.graph", &SceneToggles::graph},
                           {"show.force", &SceneToggles::force},
                           {"show.box", &SceneToggles::box},
                           {"show.depth_cue", &SceneToggles::depth_cue},
                           {"show.frame_times", &SceneToggles::frame_times},
                           {"show.detail", &SceneToggles::detail},
                           {"show.sound", &SceneToggles::sound},
                           {"show.microscope", &SceneToggles::microscope},
                           {"show.shading", &SceneToggles::shading},
                           {"show.white_background", &SceneToggles::white_ground}};

std::string line(const char* key, const std::string& value) {
    return std::string(key) + " = " + value + "\n";
}
std::string quoted(const char* text) { return "\"" + std::string(text) + "\""; }
std::string number(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", value);
    const std::string out = text;
    return out.find_first_of(".en") == std::string::npos ? out + ".0" : out;
}
template <std::size_t N>
const char* name_of(const std::array<const char*, N>& names, int choice) {
    return names[choice >= 0 && static_cast<std::size_t>(choice) < N ? static_cast<std::size_t>(choice) : 0];
}

}  // namespace

WindowState read_window_state_text(std::string_view text, const std::string& name) {
    const TomlKeys reader(name, kFix);
    WindowState s;
    std::array<double, 2> size{1280.0, 720.0};
    std::array<double, 4> quat{0.0, 0.0, 0.0, 1.0};
    std::string checksum;
    Vec3 origin_a = Vec3::Constant(kNoOrigin);
    std::vector<TomlKey> keys{
        {"size_px", std::span<double>(size), 240.0, 16384.0},
        {"traces", &s.traces},
        {"span", TomlChoice{&s.span_choice, kSpanNames}},
        {"lateness", TomlChoice{&s.lateness_choice, kLatenessNames}},
        {"scene.checksum", &checksum},
        {"scene.surface", TomlChoice{&s.toggles.style, kStyles}},
        {"scene.molecule", TomlChoice{&s.toggles.molecule, kMolecules}},
        {"scene.colour", TomlChoice{&s.toggles.colouring, kColourings}},
        {"scene.origin_a", std::span<double>(origin_a.data(), 3), -kFarA, kFarA},
        {"scene.target_a", std::span<double>(s.target_a.data(), 3), -kFarA, kFarA},
        {"scene.quat_eye_scene_xyzw", std::span<double>(quat), -1.0, 1.0},
        {"scene.distance_a", std::span<double>(&s.distance_a, 1), 0.0, kFarA},
    };
    for (const Flag& flag : kFlags) keys.push_back({flag.name, &(s.toggles.*flag.value)});
    std::array<std::string, 4 * kInputDevices> input_keys;
    for (std::size_t i = 0; i < kInputDevices; ++i) {
        InputChoice& choice = s.input[i];
        const std::string key = std::string("input.") + kInputKeys[i];
        std::string* const names = &input_keys[4 * i];
        names[0] = key;
        names[1] = key + "_speed";
        names[2] = key + "_dead_zone";
        names[3] = key + "_curve";
        keys.push_back({names[0].c_str(), TomlChoice{&choice.role, kInputRoleNames}});
        keys.push_back({names[1].c_str(), std::span<double>(&choice.speed, 1), InputChoice::kSpeedLeast,
                        InputChoice::kSpeedMost});
        keys.push_back({names[2].c_str(), std::span<double>(&choice.dead_zone, 1),
                        InputChoice::kDeadZoneLeast, InputChoice::kDeadZoneMost});
        keys.push_back({names[3].c_str(), std::span<double>(&choice.curve, 1), InputChoice::kCurveLeast,
                        InputChoice::kCurveMost});
    }
    static_cast<void>(reader.read(text, keys));
    s.width_px = static_cast<int>(size[0]);
    s.height_px = static_cast<int>(size[1]);
    if (origin_a.x() != kNoOrigin) s.origin_model_a = origin_a;
    if (!checksum.empty()) {
        char* end = nullptr;
        s.scene = std::strtoull(checksum.c_str(), &end, 16);
        if (checksum.size() != 16 || checksum.find_first_not_of("0123456789abcdef") != std::string::npos)
            reader.fail("scene.checksum: ", "must be 16 hexadecimal digits");
    }
    const Quat q(quat[3], quat[0], quat[1], quat[2]);
    if (std::abs(q.norm() - 1.0) > 0.01) reader.fail("scene.quat_eye_scene_xyzw: ", "its norm must be 1");
    s.q_eye_scene = q.normalized();
    return s;
}

WindowState read_window_state_file(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::exists(path, error) && !error) return {};
    return read_window_state_text(read_typed_file(path, kFix), path.string());
}

std::string window_state_text(const WindowState& s) {
    char checksum[20];
    std::snprintf(checksum, sizeof checksum, "%016" PRIx64, s.scene);
    const auto flag = [](bool value) { return value ? "true" : "false"; };
    std::string text = "# Window settings of Tact, read and written by tact run SCENE --window-state FILE.\n";
    text += line("size_px", "[" + std::to_string(s.width_px) + ", " + std::to_string(s.height_px) + "]");
    text += line("traces", flag(s.traces));
    text += line("span", quoted(name_of(kSpanNames, s.span_choice)));
    text += line("lateness", quoted(name_of(kLatenessNames, s.lateness_choice)));
    text += "[show]\n";
    for (const Flag& f : kFlags) text += line(f.name + sizeof "show", flag(s.toggles.*f.value));
    text += "[input]\n";
    for (std::size_t i = 0; i < kInputDevices; ++i) {
        const std::string key = kInputKeys[i];
        text += line(key.c_str(), quoted(name_of(kInputRoleNames, s.input[i].role)));
        text += line((key + "_speed").c_str(), number(s.input[i].speed));
        text += line((key + "_dead_zone").c_str(), number(s.input[i].dead_zone));
        text += line((key + "_curve").c_str(), number(s.input[i].curve));
    }
    if (s.scene == 0) return text;
    text += "[scene]\n" + line("checksum", quoted(checksum));
    text += line("surface", quoted(name_of(kStyles, s.toggles.style)));
    text += line("molecule", quoted(name_of(kMolecules, s.toggles.molecule)));
    text += line("colour", quoted(name_of(kColourings, s.toggles.colouring)));
    const auto list = [](std::span<const double> values) {
        std::string all;
        for (const double v : values) all += (all.empty() ? "" : ", ") + number(v);
        return "[" + all + "]";
    };
    if (s.origin_model_a) text += line("origin_a", list(std::span(s.origin_model_a->data(), 3)));
    text += line("target_a", list(std::span(s.target_a.data(), 3)));
    text += line("quat_eye_scene_xyzw", list(std::span(s.q_eye_scene.coeffs().data(), 4)));
    text += line("distance_a", number(s.distance_a));
    return text;
}

void write_window_state_file(const std::filesystem::path& path, const WindowState& settings) {
    const std::string text = window_state_text(settings);
    static_cast<void>(read_window_state_text(
        text, path.string()));  // a text that cannot be read back must not replace a file
    write_whole_file(path, text);
}

}  // namespace tact
