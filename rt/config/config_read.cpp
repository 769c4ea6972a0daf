// Reads and checks the configuration. Collects all errors; a starting controller throws the first one.
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <utility>

#include "rt/config/config.hpp"
#include "rt/config/config_parts.hpp"

namespace tact {

namespace {

std::string at(const std::string& path, const toml::source_region& where) {
    return path + ":" + std::to_string(where.begin.line);
}

constexpr const char* kSections =
    "[servo], [device], [device2], [arm], [tracker], [lines], [shape], [surface], [drilling], [safety] or "
    "[governor]";

// Key names in files and recordings made before 2026-11-25.
constexpr std::pair<std::string_view, std::string_view> kFormerKeys[] = {
    {"drilling.sucker_diameter_mm", "drilling.suction_tube_diameter_mm"},
    {"governor.picture_goal_hz", "governor.display_goal_hz"},  // former name
    {"lines.look_us", "lines.sample_us"},
};

std::string current_key(const std::string& name) {
    for (const auto& [former, current] : kFormerKeys)
        if (name == former) return std::string(current);
    return name;
}

void read_section(const std::string& section, const toml::table& table, const std::string& path,
                  const std::vector<ConfigKey>& keys, ConfigErrors& errors) {
    const bool known = std::any_of(keys.begin(), keys.end(),
                                   [&](const ConfigKey& k) { return k.name.rfind(section + ".", 0) == 0; });
    if (!known && table.empty())
        errors.emplace_back(at(path, table.source()), "[" + section + "]", "there is no such section",
                            std::string("remove it; the sections are ") + kSections);
    for (const auto& [leaf, value] : table) {
        const std::string name = current_key(section + "." + std::string(leaf.str()));
        const std::string where = at(path, value.source());
        const auto key =
            std::find_if(keys.begin(), keys.end(), [&](const ConfigKey& k) { return k.name == name; });
        if (key == keys.end()) {
            errors.emplace_back(where, name, "there is no such key",
                                "remove it, or did you mean " + nearest(keys, name) + "?");
            continue;
        }
        collect(errors, [&, &node = value] { set_key(*key, node, where); });
    }
}

// The line number in "path:12"; 0: none.
int line_of(const ConfigError& e) {
    const auto colon = e.where.rfind(':');
    return colon == std::string::npos ? 0 : std::atoi(e.where.c_str() + colon + 1);
}

// Returns the errors in file order.
ConfigErrors read_all(const std::string& path, RtConfig& config) {
    constexpr const char* kReadable = "give the path of a readable file to --config, or leave it out";
    std::error_code error;
    if (std::filesystem::is_directory(path, error))  // the library would read it as an empty file
        return {{"reading the configuration " + path, "", "this is a folder", kReadable}};
    toml::table file;
    try {
        file = toml::parse_file(path);
    } catch (const toml::parse_error& e) {
        const bool missing = e.source().begin.line == 0;
        return {
            {"reading the configuration " + (missing ? path : at(path, e.source())), "",
             std::string(e.description()),
             missing ? kReadable : "fix this line; deploy/tact.toml (/etc/tact/tact.toml) shows the form"}};
    }
    ConfigErrors errors;
    const std::vector<ConfigKey> keys = keys_of(config);
    for (const auto& [name, node] : file) {
        const std::string section(name.str());
        const toml::table* table = node.as_table();
        if (table == nullptr) {
            errors.emplace_back(at(path, node.source()), section, "this key belongs to no section",
                                std::string("put it under ") + kSections);
        } else if (section == "arm") {
            read_arm_section(*table, path, config.arm, errors);
        } else {
            read_section(section, *table, path, keys, errors);
        }
    }
    std::stable_sort(errors.begin(), errors.end(),
                     [](const ConfigError& a, const ConfigError& b) { return line_of(a) < line_of(b); });
    return errors;
}

void check_pedals(const RtConfig& config, const std::string& where, ConfigErrors& errors) {
    for (const auto& [key, pedal, line] :
         {std::tuple("drilling.pedal", &config.drilling.pedal, &config.lines.burr_pedal),
          std::tuple("drilling.suction", &config.drilling.suction, &config.lines.suction_pedal)}) {
        const bool wired = config.lines.driver == "sim" || (config.lines.driver != "none" && !line->empty());
        if (*pedal == "line" && !wired)
            errors.emplace_back(where, key, "no input line is configured for this pedal",
                                "set lines.driver, and lines.burr_pedal or lines.suction_pedal");
    }
}

void check_igtl_names(const RtConfig& config, const std::string& where, ConfigErrors& errors) {
    if (config.tracker.driver != "openigtlink") return;
    const std::vector<std::string> names = igtl_names(config.tracker.devices);
    if (static_cast<std::int64_t>(names.size()) != config.tracker.sensors)
        errors.emplace_back(where, "tracker.devices",
                            std::to_string(names.size()) + " names for " +
                                std::to_string(config.tracker.sensors) + " sensors (tracker.sensors)",
                            "name every sensor as the server does, with commas between the names; tact probe "
                            "--config FILE lists what the server sends");
    for (const std::string& name : names)
        if (name.size() > kIgtlNameMax || std::count(names.begin(), names.end(), name) > 1)
            errors.emplace_back(
                where, "tracker.devices", "the name \"" + name + "\" is too long or given twice",
                "a name of OpenIGTLink has at most " + std::to_string(kIgtlNameMax) + " letters");
}

// A pointer leads an emulated hand only: a person holds a real arm, and no window may move it.
void check_mouse(const RtConfig& config, const std::string& where, ConfigErrors& errors) {
    const auto refuse = [&](const char* key, const std::string& driver, const std::string& device) {
        errors.emplace_back(where, key,
                            "the " + device + " cannot lead the hand of driver \"" + driver + "\"",
                            "use driver \"sim\", or remove the " + device +
                                ": with a real arm, the hand is the person's own");
    };
    const std::string &first = config.device.driver, &second = config.device2.driver;
    if (is_led_hand(config.device.hand) && first != "sim") refuse("device.hand", first, config.device.hand);
    if (is_led_hand(config.device2.hand) && second != "sim" && second != "none")
        refuse("device2.hand", second, config.device2.hand);
    if (config.device.mouse && first != "sim" && second != "sim") refuse("device.mouse", first, "mouse");
}

// Checks all values, whether from file or command line.
ConfigErrors check_all(const RtConfig& config, const std::string& where) {
    ConfigErrors errors;
    RtConfig copy = config;
    for (const ConfigKey& key : keys_of(copy)) {
        const std::string bad = complaint(key);
        if (!bad.empty()) errors.emplace_back(where, key.name, bad, "choose a value inside the range");
    }
    if (config.tracker.head_sensor >= config.tracker.sensors) {
        errors.emplace_back(
            where, "tracker.head_sensor",
            "the tracker has no sensor " + std::to_string(config.tracker.head_sensor),
            "choose 0 to " + std::to_string(config.tracker.sensors - 1) + ", or raise tracker.sensors");
    }
    const double model_us_most = kModelShareMost * config.servo.period_us;
    if (!config.servo.free_running && config.servo.model_us_max > model_us_most) {
        errors.emplace_back(where, "servo.model_us_max",
                            number_text(config.servo.model_us_max) +
                                " us leave no time for the rest of the cycle in a period of " +
                                number_text(config.servo.period_us) + " us",
                            "choose at most " + number_text(model_us_most) + ", or 0 to follow the period");
    }
    check_pedals(config, where, errors);
    check_igtl_names(config, where, errors);
    check_mouse(config, where, errors);
    const auto drivers = device_drivers();
    const bool real = std::any_of(drivers.begin(), drivers.end(), [&](const DeviceEntry& d) {
        return config.device.driver == d.name && !d.emulated;
    });
    const bool arms_told_apart = !config.device.serial.empty() && !config.device2.serial.empty() &&
                                 config.device.serial != config.device2.serial;
    if (config.device.driver == "openhaptics" && config.device2.driver == "openhaptics") {
        // Its library has one scheduler for a process, and knows arms by name instead of serial.
        errors.emplace_back(where, "device2.driver", "driver \"openhaptics\" drives one arm, not two",
                            "use another driver for one of the hands");
    } else if (config.device2.driver == config.device.driver && real && !arms_told_apart) {
        errors.emplace_back(where, "device2.serial", "two devices of one driver need different serials",
                            "set device.serial and device2.serial to the serials of the two devices");
    }
    const double norm = Quat(config.tracker.quat_screen_tracker_xyzw.data()).norm();
    if (!(std::abs(norm - 1.0) < 0.01)) {
        errors.emplace_back(where, "tracker.quat_screen_tracker_xyzw",
                            "the quaternion has length " + number_text(norm) + " instead of 1",
                            "give x, y, z, w of a unit quaternion; no rotation is 0, 0, 0, 1");
    }
    return errors;
}

}  // namespace

void read_config(const std::string& path, RtConfig& config) {
    const ConfigErrors errors = read_all(path, config);
    if (!errors.empty()) throw ConfigError(errors.front());
}

void check_config(const RtConfig& config, const std::string& where) {
    const ConfigErrors errors = check_all(config, where);
    if (!errors.empty()) throw ConfigError(errors.front());
}

ConfigErrors config_errors(const std::string& path, RtConfig& config) {
    ConfigErrors errors = read_all(path, config);
    const std::size_t read = errors.size();
    for (ConfigError& e : check_all(config, path)) {
        const auto end = errors.begin() + static_cast<std::ptrdiff_t>(read);
        if (std::none_of(errors.begin(), end, [&](const ConfigError& r) { return r.key == e.key; }))
            errors.push_back(std::move(e));
    }
    return errors;
}

std::vector<std::pair<std::string, ConfigValue>> config_values(const RtConfig& config) {
    RtConfig copy = config;
    std::vector<std::pair<std::string, ConfigValue>> values;
    for (const ConfigKey& key : keys_of(copy)) {
        ConfigValue value;
        if (const auto* d = std::get_if<double*>(&key.target)) value = **d;
        if (const auto* i = std::get_if<std::int64_t*>(&key.target)) value = **i;
        if (const auto* b = std::get_if<bool*>(&key.target)) value = **b;
        if (const auto* s = std::get_if<std::string*>(&key.target)) value = **s;
        if (const auto* many = std::get_if<std::span<double>>(&key.target))
            value = std::vector<double>(many->begin(), many->end());
        values.emplace_back(key.name, std::move(value));
    }
    return values;
}

}  // namespace tact
