#include "gui/stage/stage_file.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <span>
#include <variant>

#include "ipc/base/error.hpp"

namespace tact {
namespace {

constexpr std::uintmax_t kBytesMost = 1U << 20;

struct StageKey {
    const char* name;
    std::variant<std::span<double>, bool*, std::string*, std::vector<double>*> target;
    double low = 0.0, high = 0.0;
};

struct Reader {
    std::string file;

    [[noreturn]] void fail(const std::string& where, const std::string& why) const {
        throw StartupError("reading " + file, where + why,
                           "gui/stage/README.md shows the keys and their form");
    }
    double number(const toml::node& node, const StageKey& key) const {
        const auto value = node.value<double>();
        if (!value || !(*value >= key.low && *value <= key.high))
            fail(key.name, ": a number from " + std::to_string(key.low) + " to " + std::to_string(key.high) +
                               " is wanted");
        return *value;
    }
    void set(const StageKey& key, const toml::node& node) const {
        if (bool* const* const flag = std::get_if<bool*>(&key.target)) {
            const auto value = node.value_exact<bool>();
            if (!value) fail(key.name, ": true or false is wanted");
            **flag = *value;
        } else if (std::string* const* const text = std::get_if<std::string*>(&key.target)) {
            const auto value = node.value_exact<std::string>();
            if (!value) fail(key.name, ": a text is wanted");
            **text = *value;
        } else if (std::vector<double>* const* const list = std::get_if<std::vector<double>*>(&key.target)) {
            const toml::array* const array = node.as_array();
            if (array == nullptr || array->size() > 2)
                fail(key.name, ": a list of up to two numbers is wanted");
            (*list)->clear();
            for (const toml::node& each : *array) (*list)->push_back(number(each, key));
        } else {
            const std::span<double> numbers = std::get<std::span<double>>(key.target);
            const toml::array* const array = node.as_array();
            if (numbers.size() == 1 && array == nullptr) {
                numbers[0] = number(node, key);
                return;
            }
            if (array == nullptr || array->size() != numbers.size())
                fail(key.name, ": a list of " + std::to_string(numbers.size()) + " numbers is wanted");
            for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = number((*array)[i], key);
        }
    }
    void read(const toml::table& table, const std::string& prefix, std::span<const StageKey> keys) const {
        for (const auto& [name, node] : table) {
            const std::string full = prefix + std::string(name.str());
            if (const toml::table* const inner = node.as_table(); inner != nullptr && prefix.empty()) {
                read(*inner, full + ".", keys);
                continue;
            }
            const auto key =
                std::find_if(keys.begin(), keys.end(), [&](const StageKey& k) { return full == k.name; });
            if (key == keys.end()) fail(full, ": there is no such key");
            set(*key, node);
        }
    }
};

}  // namespace

bool read_stereo_mode(const std::string& text, StereoMode& mode) {
    const auto* const found = std::find(std::begin(kStereoModes), std::end(kStereoModes), text);
    if (found == std::end(kStereoModes)) return false;
    mode = static_cast<StereoMode>(found - std::begin(kStereoModes));
    return true;
}

StageSettings read_stage_text(std::string_view text, const std::string& name) {
    const Reader reader{"'" + name + "'"};
    toml::table table;
    try {
        table = toml::parse(text);
    } catch (const toml::parse_error& e) {
        reader.fail("line " + std::to_string(e.source().begin.line) + ": ", std::string(e.description()));
    }
    StageSettings s;
    const auto place = [](Vec3& v) { return std::span<double>(v.data(), 3); };
    std::string mode = "off", scene = "orbit";
    std::vector<double> monitors, size{1280.0, 720.0}, quat{0.0, 0.0, 0.0, 1.0};
    double latency_ms = 1e3 * s.latency_s;
    const StageKey keys[] = {
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
    reader.read(table, "", keys);
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
        reader.fail("workspace.quat_screen_world_xyzw: ", "its length is not 1");
    s.T_screen_world.q = q.normalized();
    s.screen_measured = table.contains("screen");
    if (!s.screen.possible())
        reader.fail(
            "screen: ",
            "its corners are no rectangle of 1 cm to 100 m an edge: the two edges at lower_left_m have "
            "to be upright on each other");
    return s;
}

StageSettings read_stage_file(const std::filesystem::path& path) {
    const std::string name = path.string();
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(path, error);
    if (error || bytes > kBytesMost)
        throw StartupError("reading '" + name + "'", error ? error.message() : "it is larger than a megabyte",
                           "give a file of the form that gui/stage/README.md shows");
    std::ifstream in(path);
    const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    return read_stage_text(text, name);
}

}  // namespace tact
