#include "rt/config/config.hpp"

#include <toml++/toml.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <sstream>
#include <variant>
#include <vector>

#include "ipc/base/error.hpp"
#include "rt/config/config_parts.hpp"
#include "rt/force/drilling/burr_shapes.hpp"

namespace tact {

namespace {

std::vector<std::string> tracker_names() {
    std::vector<std::string> names;
    for (const TrackerEntry& t : tracker_drivers()) names.emplace_back(t.name);
    return names;
}

std::vector<std::string> lines_names() {
    std::vector<std::string> names;
    for (const LinesEntry& l : lines_drivers()) names.emplace_back(l.name);
    return names;
}

constexpr const char* kAsDevice = "same";

std::vector<std::string> sim_hand_names(const char* besides = nullptr) {
    std::vector<std::string> names(kSimHandNames.begin(), kSimHandNames.end());
    if (besides != nullptr) names.emplace_back(besides);
    return names;
}

std::vector<std::string> device_names(const char* besides = nullptr) {
    std::vector<std::string> names;
    if (besides != nullptr) names.emplace_back(besides);
    for (const DeviceEntry& d : device_drivers()) names.emplace_back(d.name);
    return names;
}

}  // namespace

std::vector<ConfigKey> keys_of(RtConfig& c) {
    return {
        {"servo.period_us", &c.servo.period_us, 50, 100000, {}},
        {"servo.free_running", &c.servo.free_running, 0, 0, {}},
        {"servo.spin_us", &c.servo.spin_us, 0, 100000, {}},
        {"servo.core", &c.servo.core, -2, 4095, {}},
        {"servo.priority", &c.servo.priority, 0, 94, {}},
        {"servo.model_us_max", &c.servo.model_us_max, 0, 100000, {}},
        {"servo.lock_memory", &c.servo.lock_memory, 0, 0, {}},
        {"device.driver", &c.device.driver, 0, 0, device_names()},
        {"device.hand", &c.device.hand, 0, 0, sim_hand_names()},
        {"device.mouse", &c.device.mouse, 0, 0, {}},
        {"device.hand_at_mm", c.device.hand_at_mm, -100, 100, {}},
        {"device.hand_seed", &c.device.hand_seed, 0, 9e15, {}},
        {"device.watchdog_us", &c.device.watchdog_us, 1000, 1e7, {}},
        {"device.process_log", &c.device.process_log, 0, 0, {}},
        {"device.serial", &c.device.serial, 0, 0, {}},
        {"device.pump_priority", &c.device.pump_priority, 0, 94, {}},
        {"device.firmware", &c.device.firmware, 0, 0, {}},
        {"device.hd_library", &c.device.hd_library, 0, 0, {}},
        {"device.hd_device", &c.device.hd_device, 0, 0, {}},
        {"device.fd_library", &c.device.fd_library, 0, 0, {}},
        {"device.fd_initialize", &c.device.fd_initialize, 0, 0, {}},
        {"device.fd_gravity", &c.device.fd_gravity, 0, 0, {}},
        {"device.inverse_port", &c.device.inverse_port, 1, 65535, {}},
        {"device2.driver", &c.device2.driver, 0, 0, device_names("none")},
        {"device2.serial", &c.device2.serial, 0, 0, {}},
        {"device2.hand", &c.device2.hand, 0, 0, sim_hand_names(kAsDevice)},
        {"device2.hand_seed", &c.device2.hand_seed, 0, 9e15, {}},
        {"tracker.driver", &c.tracker.driver, 0, 0, tracker_names()},
        {"tracker.interface", &c.tracker.interface, 0, 0, {}},
        {"tracker.host", &c.tracker.host, 0, 0, {}},
        {"tracker.port", &c.tracker.port, 1, 65535, {}},
        {"tracker.devices", &c.tracker.devices, 0, 0, {}},
        {"tracker.format", &c.tracker.format, 0, 0, {"classic", "fd"}},
        {"tracker.sensors", &c.tracker.sensors, 1, kTrackerSensorsMax, {}},
        {"tracker.head_sensor", &c.tracker.head_sensor, 0, kTrackerSensorsMax - 1, {}},
        {"tracker.rate_hz", &c.tracker.rate_hz, 10, 2000, {}},
        {"tracker.latency_ms", &c.tracker.latency_ms, 0, 100, {}},
        {"tracker.reach_m", &c.tracker.reach_m, 0.1, 3, {}},
        {"tracker.position_screen_m", c.tracker.position_screen_m, -10, 10, {}},
        {"tracker.quat_screen_tracker_xyzw", c.tracker.quat_screen_tracker_xyzw, -1, 1, {}},
        {"lines.driver", &c.lines.driver, 0, 0, lines_names()},
        {"lines.chip", &c.lines.chip, 0, 0, {}},
        {"lines.emergency_stop_a", &c.lines.emergency_stop_a, 0, 0, {}},
        {"lines.emergency_stop_b", &c.lines.emergency_stop_b, 0, 0, {}},
        {"lines.dead_man", &c.lines.dead_man, 0, 0, {}},
        {"lines.amplifier", &c.lines.amplifier, 0, 0, {}},
        {"lines.burr_pedal", &c.lines.burr_pedal, 0, 0, {}},
        {"lines.suction_pedal", &c.lines.suction_pedal, 0, 0, {}},
        {"lines.enable", &c.lines.enable, 0, 0, {}},
        {"lines.watchdog", &c.lines.watchdog, 0, 0, {}},
        {"lines.lamp", &c.lines.lamp, 0, 0, {}},
        {"lines.bias", &c.lines.bias, 0, 0, {"none", "up", "down"}},
        {"lines.edges", &c.lines.edges, 0, 0, {}},
        {"lines.sample_us", &c.lines.sample_us, 100, 10000, {}},
        {"lines.release_ms", &c.lines.release_ms, 20, 50, {}},
        {"lines.discrepancy_ms", &c.lines.discrepancy_ms, 1, 500, {}},
        {"lines.follow_ms", &c.lines.follow_ms, 1, 5000, {}},
        {"lines.age_us_max", &c.lines.age_us_max, 1000, 1e7, {}},
        {"shape.force_scale", &c.shape.force_scale, 0, 1e6, {}},
        {"shape.damping_n_s_m", &c.shape.damping_n_s_m, 0, 100, {}},
        {"surface.mode", &c.surface.mode, 0, 0, {"off-brute", "off-tree", "chr"}},
        {"drilling.burr_diameter_mm", &c.drilling.burr_diameter_mm, 0.2, 40, {}},
        {"drilling.burr_shape",
         &c.drilling.burr_shape,
         0,
         0,
         {kBurrShapeNames.begin(), kBurrShapeNames.end()}},
        {"drilling.burr_grit", &c.drilling.burr_grit, 0, 0, {kBurrGritNames.begin(), kBurrGritNames.end()}},
        {"drilling.burr_length_mm", &c.drilling.burr_length_mm, 1, 40, {}},
        {"drilling.shaft_diameter_mm", &c.drilling.shaft_diameter_mm, 0, 20, {}},
        {"drilling.burr_rpm", &c.drilling.burr_rpm, 0, 200000, {}},
        {"drilling.pedal", &c.drilling.pedal, 0, 0, {"button", "line", "always"}},
        {"drilling.irrigation_ml_min", &c.drilling.irrigation_ml_min, 0, 1000, {}},
        {"drilling.irrigation", &c.drilling.irrigation, 0, 0, {"pedal", "always"}},
        {"drilling.suction_tube_diameter_mm", &c.drilling.suction_tube_diameter_mm, 0.8, 10, {}},
        {"drilling.suction", &c.drilling.suction, 0, 0, {"button", "line", "always"}},
        {"drilling.suction_l_min", &c.drilling.suction_l_min, 0, 200, {}},
        {"drilling.rate_per_s", &c.drilling.rate_per_s, 0, 1e4, {}},
        {"drilling.diamond_share", &c.drilling.diamond_share, 0, 1, {}},
        {"drilling.vibration", &c.drilling.vibration, 0, 0.5, {}},
        {"safety.force_n_max", &c.safety.force_n_max, 0, 100, {}},
        {"safety.torque_n_m_max", &c.safety.torque_n_m_max, 0, 10, {}},
        {"safety.force_slew_n_s", &c.safety.force_slew_n_s, 1, 1e6, {}},
        {"safety.torque_slew_n_m_s", &c.safety.torque_slew_n_m_s, 0.01, 1e5, {}},
        {"safety.ramp_in_ms", &c.safety.ramp_in_ms, 10, 10000, {}},
        {"safety.ramp_out_ms", &c.safety.ramp_out_ms, 1, 80, {}},
        {"safety.wall_margin_mm", &c.safety.wall_margin_mm, 0, 1000, {}},
        {"safety.wall_stiffness_n_m", &c.safety.wall_stiffness_n_m, 0, 5000, {}},
        {"safety.hand_damping_n_s_m", &c.safety.hand_damping_n_s_m, 0.01, 100, {}},
        {"safety.hand_turn_damping_n_m_s_rad", &c.safety.hand_turn_damping_n_m_s_rad, 1e-5, 1, {}},
        {"safety.heat_tau_s", &c.safety.heat_tau_s, 0, 3600, {}},
        {"safety.passivity", &c.safety.passivity, 0, 0, {}},
        {"safety.passivity_energy_j", &c.safety.passivity_energy_j, 0, 100, {}},
        {"safety.sample_age_us_max", &c.safety.sample_age_us_max, 100, 1e6, {}},
        {"safety.late_us_max", &c.safety.late_us_max, 100, 1e6, {}},
        {"safety.overruns_max", &c.safety.overruns_max, 1, 1000, {}},
        {"safety.timing_latches", &c.safety.timing_latches, 0, 0, {"real", "always", "never"}},
        {"safety.supervisor_us_max", &c.safety.supervisor_us_max, 1000, 1e7, {}},
        {"safety.gui_silent_ms", &c.safety.gui_silent_ms, 50, 60000, {}},
        {"safety.on_gui_silent", &c.safety.on_gui_silent, 0, 0, {"continue", "ramp"}},
        {"governor.law", &c.governor.law, 0, 0, {kLawNames.begin(), kLawNames.end()}},
        {"governor.goal_hz", &c.governor.goal_hz, 0, 1e7, {}},
        {"governor.display_goal_hz", &c.governor.display_goal_hz, 0, 1000, {}},
        {"governor.force_level_min", &c.governor.force_level_min, 0, 1, {}},
        {"governor.gain", &c.governor.gain, 1e-3, 1, {}},
        {"governor.tolerance", &c.governor.tolerance, 0, 0.5, {}},
        {"governor.interval_ms", &c.governor.interval_ms, 10, 10000, {}},
    };
}

std::string complaint(const ConfigKey& key) {
    const auto range = [&](double v, const std::string& text) {
        if (std::isfinite(v) && v >= key.low && v <= key.high) return std::string();
        return text + " is outside " + number_text(key.low) + " to " + number_text(key.high);
    };
    if (const auto* d = std::get_if<double*>(&key.target)) return range(**d, number_text(**d));
    if (const auto* i = std::get_if<std::int64_t*>(&key.target)) {
        return range(static_cast<double>(**i), std::to_string(**i));
    }
    if (const auto* many = std::get_if<std::span<double>>(&key.target)) {
        for (const double d : *many) {
            std::string bad = range(d, number_text(d));
            if (!bad.empty()) return bad;
        }
        return {};
    }
    if (const auto* s = std::get_if<std::string*>(&key.target)) {
        if (key.words.empty()) return {};
        std::string known;
        for (const std::string& w : key.words) {
            if (w == **s) return {};
            known += (known.empty() ? "\"" : ", \"") + w + "\"";
        }
        return "\"" + **s + "\" is not one of " + known;
    }
    return {};
}

std::string nearest(const std::vector<ConfigKey>& keys, const std::string& name) {
    std::string best;
    std::size_t best_score = 0;
    for (const ConfigKey& k : keys) {
        const std::size_t shorter = std::min(k.name.size(), name.size());
        std::size_t front = 0, back = 0;
        while (front < shorter && k.name[front] == name[front]) ++front;
        while (back < shorter && k.name[k.name.size() - 1 - back] == name[name.size() - 1 - back]) ++back;
        if (front + back > best_score) {
            best_score = front + back;
            best = k.name;
        }
    }
    return best;
}

void set_key(const ConfigKey& key, const toml::node& node, const std::string& where) {
    const auto wrong = [&](const char* wanted) {
        throw ConfigError(where, key.name, std::string("this is not ") + wanted,
                          "see deploy/tact.toml (/etc/tact/tact.toml) for the key and its default");
    };
    if (const auto* d = std::get_if<double*>(&key.target)) {
        if (!node.is_number()) wrong("a number");
        **d = node.value<double>().value_or(std::numeric_limits<double>::quiet_NaN());
    } else if (const auto* i = std::get_if<std::int64_t*>(&key.target)) {
        if (!node.is_integer()) wrong("a whole number");
        **i = node.value<std::int64_t>().value_or(0);
    } else if (const auto* b = std::get_if<bool*>(&key.target)) {
        if (!node.is_boolean()) wrong("true or false");
        **b = node.value<bool>().value_or(false);
    } else if (const auto* s = std::get_if<std::string*>(&key.target)) {
        if (!node.is_string()) wrong("text in quotes");
        **s = node.value<std::string>().value_or("");
        if (key.name.ends_with(".hand")) **s = current_hand_name(**s);
    } else if (const auto* many = std::get_if<std::span<double>>(&key.target)) {
        const toml::array* const list = node.as_array();
        const std::string wanted = "a list of " + std::to_string(many->size()) + " numbers";
        if (list == nullptr || list->size() != many->size()) wrong(wanted.c_str());
        for (std::size_t n = 0; n < many->size(); ++n) {
            if (!list->get(n)->is_number()) wrong(wanted.c_str());
            (*many)[n] = list->get(n)->value<double>().value_or(std::numeric_limits<double>::quiet_NaN());
        }
    }
    const std::string bad = complaint(key);
    if (!bad.empty()) {
        throw ConfigError(where, key.name, bad,
                          "see deploy/tact.toml (/etc/tact/tact.toml) for the key and its default");
    }
}

Duration duration_us(double us) { return Duration(std::llround(us * 1e3)); }

bool spins_whole_period(const RtConfig::Servo& servo) {
    return !servo.free_running && servo.spin_us >= servo.period_us;
}

bool sleeps(const RtConfig::Servo& servo) { return !servo.free_running && !spins_whole_period(servo); }

double expected_period_s(const RtConfig& c) {
    return c.servo.free_running && c.governor.goal_hz > 0.0 ? 1.0 / c.governor.goal_hz
                                                            : 1e-6 * c.servo.period_us;
}

ServoClock servo_clock(const RtConfig::Servo& servo) {
    return ServoClock(duration_us(servo.spin_us), spins_whole_period(servo) ? 1.0 : ServoClock::kSpinShare);
}

ServoSettings settings_from(const RtConfig& c, bool emulated) {
    ServoSettings s;
    s.emulated = emulated;
    s.period = duration_us(c.servo.period_us);
    s.free_running = c.servo.free_running;
    s.force_scale = c.shape.force_scale;
    s.damping_n_s_m = c.shape.damping_n_s_m;
    s.watchdogs.sample_age_max = duration_us(c.safety.sample_age_us_max);
    s.watchdogs.late_max = duration_us(c.safety.late_us_max);
    s.watchdogs.overruns_max = static_cast<std::uint32_t>(c.safety.overruns_max);
    s.watchdogs.timing_latches =
        c.safety.timing_latches == "always" || (c.safety.timing_latches == "real" && !emulated);
    s.watchdogs.device_watchdog_latches = s.watchdogs.timing_latches || !emulated;
    s.chain.force_n_max = c.safety.force_n_max;
    s.chain.torque_n_m_max = c.safety.torque_n_m_max;
    s.chain.force_slew_n_s = c.safety.force_slew_n_s;
    s.chain.torque_slew_n_m_s = c.safety.torque_slew_n_m_s;
    s.chain.ramp_in_s = c.safety.ramp_in_ms * 1e-3;
    s.chain.ramp_out_s = c.safety.ramp_out_ms * 1e-3;
    s.chain.wall_margin_m = c.safety.wall_margin_mm * 1e-3;
    s.chain.wall_stiffness_n_m = c.safety.wall_stiffness_n_m;
    s.hand_damping_n_s_m = c.safety.hand_damping_n_s_m;
    s.hand_turn_damping_n_m_s_rad = c.safety.hand_turn_damping_n_m_s_rad;
    s.chain.heat_tau_s = c.safety.heat_tau_s;
    s.chain.passivity = c.safety.passivity;
    s.chain.translation.energy_start_j = c.safety.passivity_energy_j;
    s.chain.rotation.energy_start_j = c.safety.passivity_energy_j;
    s.governor.law = law_named(c.governor.law).value_or(kDefaultLaw);
    const double rate_hz = s.free_running ? 1000.0 : 1e6 / c.servo.period_us;
    s.governor.goal_hz = c.governor.goal_hz > 0.0 ? c.governor.goal_hz : rate_hz;
    const double cycle_us = s.free_running ? 1e6 / s.governor.goal_hz : c.servo.period_us;
    s.model_max = duration_us(c.servo.model_us_max > 0.0 ? c.servo.model_us_max : kModelShare * cycle_us);
    s.governor.display_goal_hz = c.governor.display_goal_hz;
    s.governor.force_level_min = c.governor.force_level_min;
    s.governor.gain = c.governor.gain;
    s.governor.tolerance = c.governor.tolerance;
    s.governor_interval = duration_us(c.governor.interval_ms * 1e3);
    s.lines_age_max = duration_us(c.lines.age_us_max);
    s.gui_silent = duration_us(c.safety.gui_silent_ms * 1e3);
    s.gui_silent_ramps = c.safety.on_gui_silent == "ramp";
    return s;
}

DeviceSettings device_settings_from(const RtConfig& c) {
    DeviceSettings d;
    d.driver = c.device.driver;
    d.sim.hand.script = c.device.hand;
    d.sim.hand.seed = static_cast<std::uint64_t>(c.device.hand_seed);
    d.sim.hand.at_m = 1e-3 * Vec3(c.device.hand_at_mm[0], c.device.hand_at_mm[1], 0.0);
    d.process_log = c.device.process_log;
    d.firmware = c.device.firmware;
    d.hd_library = c.device.hd_library;
    d.hd_device = c.device.hd_device;
    d.fd_library = c.device.fd_library;
    d.fd_initialize = c.device.fd_initialize;
    d.fd_gravity = c.device.fd_gravity;
    d.inverse_port = static_cast<std::uint16_t>(c.device.inverse_port);
    d.arm = c.arm;
    d.serial = c.device.serial;
    d.pump_priority = static_cast<int>(c.device.pump_priority);
    // The device reports old samples before the loop's watchdog trips, because it can name the cause.
    d.state_hold = duration_us(c.safety.sample_age_us_max * (3000.0 / 3500.0));
    d.sim.watchdog = duration_us(c.device.watchdog_us);
    return d;
}

DeviceSettings device2_settings_from(const RtConfig& c) {
    DeviceSettings d = device_settings_from(c);
    d.driver = c.device2.driver;
    d.serial = c.device2.serial;
    if (c.device2.hand != kAsDevice) d.sim.hand.script = c.device2.hand;
    d.sim.hand.seed = static_cast<std::uint64_t>(c.device2.hand_seed);
    if (!d.process_log.empty()) d.process_log += ".2";
    return d;
}

std::array<bool, 2> mouse_hands(const RtConfig& c) {
    const std::string& second = c.device2.hand == kAsDevice ? c.device.hand : c.device2.hand;
    return {c.device.driver == "sim" && (c.device.mouse || is_led_hand(c.device.hand)),
            c.device2.driver == "sim" && (c.device.mouse || is_led_hand(second))};
}

std::array<LeadDevice, 2> lead_devices(const RtConfig& c) {
    const auto named = [](const std::string& script) {
        const auto at = std::find(kLeadDeviceNames.begin(), kLeadDeviceNames.end(), script);
        return at == kLeadDeviceNames.end() ? LeadDevice::mouse
                                            : static_cast<LeadDevice>(at - kLeadDeviceNames.begin());
    };
    return {named(c.device.hand), named(c.device2.hand == kAsDevice ? c.device.hand : c.device2.hand)};
}

TrackerSettings tracker_settings_from(const RtConfig& c) {
    TrackerSettings t;
    t.driver = c.tracker.driver;
    t.interface = c.tracker.interface;
    t.sim.can.fix.format = c.tracker.format == "fd" ? CanFormat::fd : CanFormat::classic;
    t.sim.can.fix.sensors = static_cast<unsigned>(c.tracker.sensors);
    t.sim.can.fix.reach_m = c.tracker.reach_m;
    t.sim.can.rate_hz = c.tracker.rate_hz;
    t.sim.can.latency = duration_us(c.tracker.latency_ms * 1e3);
    t.host = c.tracker.host;
    t.port = static_cast<int>(c.tracker.port);
    t.igtl.names = igtl_names(c.tracker.devices);
    t.igtl.reach_m = c.tracker.reach_m;
    t.igtl.rate_hz = c.tracker.rate_hz;
    t.igtl.latency = t.sim.can.latency;
    return t;
}

HeadSettings head_settings_from(const RtConfig& c) {
    HeadSettings h;
    h.sensor = static_cast<unsigned>(c.tracker.head_sensor);
    h.T_screen_tracker.p_m = Vec3(c.tracker.position_screen_m.data());
    h.T_screen_tracker.q = Quat(c.tracker.quat_screen_tracker_xyzw.data()).normalized();
    return h;
}

std::string number_text(double v) {
    std::ostringstream out;
    out << v;
    return out.str();
}

}  // namespace tact
