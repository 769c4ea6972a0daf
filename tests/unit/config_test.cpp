// The configuration: its documentation is correct, and every error names file, line, key and fix.
#include "rt/config/config.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "ipc/base/error.hpp"
#include "tests/support/says.hpp"
#include "tests/unit/config_file.hpp"

namespace tact::config_test {
namespace {

using test::error_of;
using test::TempFile;

TEST(Config, the_documented_file_has_the_defaults_and_every_key) {
    RtConfig config;
    config.servo.period_us = 1.0;  // a key missing in the file would keep this value
    config.governor.law = "x";
    config.device.fd_gravity = true;
    config.safety.force_n_max = 0.0;
    read_config("deploy/tact.toml", config);
    const RtConfig defaults;
    EXPECT_EQ(config.servo.period_us, defaults.servo.period_us);
    EXPECT_EQ(config.servo.free_running, defaults.servo.free_running);
    EXPECT_EQ(config.servo.spin_us, defaults.servo.spin_us);
    EXPECT_EQ(config.servo.core, defaults.servo.core);
    EXPECT_EQ(config.servo.priority, defaults.servo.priority);
    EXPECT_EQ(config.servo.model_us_max, defaults.servo.model_us_max);
    EXPECT_EQ(config.servo.lock_memory, defaults.servo.lock_memory);
    EXPECT_EQ(config.device.driver, defaults.device.driver);
    EXPECT_EQ(config.device.hand, defaults.device.hand);
    EXPECT_EQ(config.device.mouse, defaults.device.mouse);
    EXPECT_EQ(config.device.hand_seed, defaults.device.hand_seed);
    EXPECT_EQ(config.device.hand_at_mm, defaults.device.hand_at_mm);
    EXPECT_EQ(config.device.watchdog_us, defaults.device.watchdog_us);
    EXPECT_EQ(config.device.process_log, defaults.device.process_log);
    EXPECT_EQ(config.device.serial, defaults.device.serial);
    EXPECT_EQ(config.device.pump_priority, defaults.device.pump_priority);
    EXPECT_EQ(config.device.firmware, defaults.device.firmware);
    EXPECT_FALSE(config.device.fd_gravity);  // every force passes the output chain
    EXPECT_FALSE(defaults.device.fd_gravity);
    EXPECT_EQ(config.device2.driver, defaults.device2.driver);
    EXPECT_EQ(config.device2.serial, defaults.device2.serial);
    EXPECT_EQ(config.device2.hand, defaults.device2.hand);
    EXPECT_EQ(config.device2.hand_seed, defaults.device2.hand_seed);
    EXPECT_EQ(config.safety.hand_damping_n_s_m, defaults.safety.hand_damping_n_s_m);
    EXPECT_EQ(config.tracker.driver, defaults.tracker.driver);
    EXPECT_EQ(config.tracker.interface, defaults.tracker.interface);
    EXPECT_EQ(config.tracker.host, defaults.tracker.host);
    EXPECT_EQ(config.tracker.port, defaults.tracker.port);
    EXPECT_EQ(config.tracker.devices, defaults.tracker.devices);
    EXPECT_EQ(config.tracker.format, defaults.tracker.format);
    EXPECT_EQ(config.tracker.sensors, defaults.tracker.sensors);
    EXPECT_EQ(config.tracker.head_sensor, defaults.tracker.head_sensor);
    EXPECT_EQ(config.tracker.rate_hz, defaults.tracker.rate_hz);
    EXPECT_EQ(config.tracker.latency_ms, defaults.tracker.latency_ms);
    EXPECT_EQ(config.tracker.reach_m, defaults.tracker.reach_m);
    EXPECT_EQ(config.tracker.position_screen_m, defaults.tracker.position_screen_m);
    EXPECT_EQ(config.tracker.quat_screen_tracker_xyzw, defaults.tracker.quat_screen_tracker_xyzw);
    EXPECT_EQ(config.lines.driver, defaults.lines.driver);
    EXPECT_EQ(config.lines.chip, defaults.lines.chip);
    EXPECT_EQ(config.lines.emergency_stop_a, defaults.lines.emergency_stop_a);
    EXPECT_EQ(config.lines.emergency_stop_b, defaults.lines.emergency_stop_b);
    EXPECT_EQ(config.lines.dead_man, defaults.lines.dead_man);
    EXPECT_EQ(config.lines.amplifier, defaults.lines.amplifier);
    EXPECT_EQ(config.lines.burr_pedal, defaults.lines.burr_pedal);
    EXPECT_EQ(config.lines.suction_pedal, defaults.lines.suction_pedal);
    EXPECT_EQ(config.lines.enable, defaults.lines.enable);
    EXPECT_EQ(config.lines.watchdog, defaults.lines.watchdog);
    EXPECT_EQ(config.lines.lamp, defaults.lines.lamp);
    EXPECT_EQ(config.lines.bias, defaults.lines.bias);
    EXPECT_EQ(config.lines.edges, defaults.lines.edges);
    EXPECT_EQ(config.lines.sample_us, defaults.lines.sample_us);
    EXPECT_EQ(config.lines.release_ms, defaults.lines.release_ms);
    EXPECT_EQ(config.lines.discrepancy_ms, defaults.lines.discrepancy_ms);
    EXPECT_EQ(config.lines.follow_ms, defaults.lines.follow_ms);
    EXPECT_EQ(config.lines.age_us_max, defaults.lines.age_us_max);
    EXPECT_EQ(config.shape.force_scale, defaults.shape.force_scale);
    EXPECT_EQ(config.shape.damping_n_s_m, defaults.shape.damping_n_s_m);
    EXPECT_EQ(config.drilling.burr_diameter_mm, defaults.drilling.burr_diameter_mm);
    EXPECT_EQ(config.drilling.burr_shape, defaults.drilling.burr_shape);
    EXPECT_EQ(config.drilling.burr_rpm, defaults.drilling.burr_rpm);
    EXPECT_EQ(config.drilling.pedal, defaults.drilling.pedal);
    EXPECT_EQ(config.drilling.irrigation_ml_min, defaults.drilling.irrigation_ml_min);
    EXPECT_EQ(config.drilling.irrigation, defaults.drilling.irrigation);
    EXPECT_EQ(config.drilling.suction_tube_diameter_mm, defaults.drilling.suction_tube_diameter_mm);
    EXPECT_EQ(config.drilling.suction, defaults.drilling.suction);
    EXPECT_EQ(config.drilling.suction_l_min, defaults.drilling.suction_l_min);
    EXPECT_EQ(config.safety.force_n_max, defaults.safety.force_n_max);
    EXPECT_EQ(config.safety.torque_n_m_max, defaults.safety.torque_n_m_max);
    EXPECT_EQ(config.safety.force_slew_n_s, defaults.safety.force_slew_n_s);
    EXPECT_EQ(config.safety.torque_slew_n_m_s, defaults.safety.torque_slew_n_m_s);
    EXPECT_EQ(config.safety.ramp_in_ms, defaults.safety.ramp_in_ms);
    EXPECT_EQ(config.safety.ramp_out_ms, defaults.safety.ramp_out_ms);
    EXPECT_EQ(config.safety.wall_margin_mm, defaults.safety.wall_margin_mm);
    EXPECT_EQ(config.safety.wall_stiffness_n_m, defaults.safety.wall_stiffness_n_m);
    EXPECT_EQ(config.safety.heat_tau_s, defaults.safety.heat_tau_s);
    EXPECT_EQ(config.safety.passivity, defaults.safety.passivity);
    EXPECT_EQ(config.safety.passivity_energy_j, defaults.safety.passivity_energy_j);
    EXPECT_EQ(config.safety.sample_age_us_max, defaults.safety.sample_age_us_max);
    EXPECT_EQ(config.safety.late_us_max, defaults.safety.late_us_max);
    EXPECT_EQ(config.safety.overruns_max, defaults.safety.overruns_max);
    EXPECT_EQ(config.safety.timing_latches, defaults.safety.timing_latches);
    EXPECT_EQ(config.safety.supervisor_us_max, defaults.safety.supervisor_us_max);
    EXPECT_EQ(config.safety.gui_silent_ms, defaults.safety.gui_silent_ms);
    EXPECT_EQ(config.safety.on_gui_silent, defaults.safety.on_gui_silent);
    EXPECT_EQ(config.governor.law, defaults.governor.law);
    EXPECT_EQ(config.governor.goal_hz, defaults.governor.goal_hz);
    EXPECT_EQ(config.governor.gain, defaults.governor.gain);
    EXPECT_EQ(config.governor.tolerance, defaults.governor.tolerance);
    EXPECT_EQ(config.governor.interval_ms, defaults.governor.interval_ms);

    // Every key of config.cpp has a line in the documentation.
    std::ifstream code("rt/config/config.cpp"), doc("deploy/tact.toml");
    ASSERT_TRUE(code && doc);
    std::stringstream code_text, doc_text;
    code_text << code.rdbuf();
    doc_text << doc.rdbuf();
    const std::string source = code_text.str();
    int keys = 0;
    for (std::size_t row = source.find("{\"servo."); row != std::string::npos;
         row = source.find("{\"", row + 1)) {
        const std::size_t dot = source.find('.', row), quote = source.find('"', row + 2);
        if (dot > quote ||
            (source.compare(quote, 6, "\", &c.") != 0 && source.compare(quote, 5, "\", c.") != 0))
            continue;  // not a row of the table of keys
        const std::string key = source.substr(dot + 1, quote - dot - 1);
        EXPECT_NE(doc_text.str().find("\n" + key + " ="), std::string::npos) << key;
        ++keys;
    }
    EXPECT_GE(keys, 63);
}

TEST(Config, an_unknown_key_is_refused_with_line_and_a_suggestion) {
    const std::string error = error_of("[servo]\nperiod_us = 500\nspin_tail_us = 3\n");
    EXPECT_TRUE(says(error, {".toml:3", "servo.spin_tail_us", "no such key", "fix:", "servo.spin_us"}))
        << error;
}

TEST(Config, keys_and_names_of_older_files_are_read) {
    const TempFile file(
        "[device2]\nhand = \"sucker\"\n[drilling]\nsucker_diameter_mm = 3\n[governor]\npicture_goal_hz = "  // former names
        "20\n[lines]\nlook_us = 2000\n");
    RtConfig config;
    read_config(file.path(), config);
    EXPECT_EQ(config.device2.hand, "suction-tube");
    EXPECT_EQ(config.drilling.suction_tube_diameter_mm, 3.0);
    EXPECT_EQ(config.governor.display_goal_hz, 20.0);
    EXPECT_EQ(config.lines.sample_us, 2000.0);
}

TEST(Config, an_impossible_value_is_refused_with_its_range) {
    EXPECT_TRUE(
        says(error_of("[servo]\n\nperiod_us = -5\n"), {".toml:3", "servo.period_us", "-5", "50 to 100000"}));
    EXPECT_TRUE(says(error_of("[governor]\ngain = nan\n"), {".toml:2", "governor.gain"}));
    EXPECT_TRUE(
        says(error_of("[safety]\non_gui_silent = \"sing\"\n"), {".toml:2", "sing", "continue", "ramp"}));
}

TEST(Config, a_wrong_type_is_refused) {
    EXPECT_TRUE(says(error_of("[servo]\npriority = 80.5\n"), {".toml:2", "servo.priority", "whole number"}));
    EXPECT_TRUE(says(error_of("[servo]\nfree_running = 1\n"), {".toml:2", "true or false"}));
    EXPECT_TRUE(says(error_of("[device]\ndriver = 3\n"), {".toml:2", "text"}));
    EXPECT_TRUE(says(error_of("[safety]\nforce_n_max = [1, 2]\n"), {".toml:2", "number"}));
}

TEST(Config, lists_are_checked_for_length_numbers_and_range_and_rotations_for_unit_length) {
    EXPECT_EQ(error_of("[tracker]\nposition_screen_m = [0.1, -1, 0.25]\n"), "");
    EXPECT_TRUE(
        says(error_of("[tracker]\nposition_screen_m = [0.1, 0.2]\n"), {".toml:2", "a list of 3 numbers"}));
    EXPECT_TRUE(says(error_of("[tracker]\nposition_screen_m = 0.1\n"), {".toml:2", "a list of 3 numbers"}));
    EXPECT_TRUE(says(error_of("[tracker]\nposition_screen_m = [0, 0, \"x\"]\n"), {"a list of 3 numbers"}));
    EXPECT_TRUE(says(error_of("[tracker]\nposition_screen_m = [0, 0, 11]\n"), {"11", "-10 to 10"}));
    EXPECT_TRUE(says(error_of("[tracker]\ndriver = \"magic\"\n"), {"magic", "none", "sim", "can"}));
    const auto refused = [](const RtConfig& c) {
        try {
            check_config(c, "here");
        } catch (const StartupError& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    RtConfig c;
    EXPECT_EQ(refused(c), "");
    c.tracker.quat_screen_tracker_xyzw = {0.5, 0.5, 0.5, 0.4};
    EXPECT_TRUE(says(refused(c), {"quat_screen_tracker_xyzw", "unit quaternion"}));
    c = {};
    c.tracker.head_sensor = 1;
    EXPECT_TRUE(says(refused(c), {"head_sensor", "no sensor 1", "tracker.sensors"}));
    c.tracker.sensors = 2;
    EXPECT_EQ(refused(c), "");
}

TEST(Config, all_errors_are_collected_in_the_order_of_the_file_and_each_key_once) {
    const TempFile file(
        "[tracker]\nhead_sensor = 3\n[servo]\ncore = 5000\nperiod_uss = 3\n[device]\ndriver = \"magic\"\n"
        "[arm]\nwrist = 3\nlength = 2\n[sevro]\n[device2]\nserial = 5\nhand = \"sim\"\n");
    RtConfig config;
    std::string keys;
    for (const ConfigError& e : config_errors(file.path(), config)) {
        keys += e.key + " ";
        EXPECT_NE(e.fix, "") << e.key;
        const std::string text = e.where + ": " + e.key + ": " + e.problem;
        EXPECT_TRUE(says(e.what(), {text.c_str(), e.fix.c_str()})) << e.what();
    }
    EXPECT_EQ(keys,
              "servo.core servo.period_uss device.driver arm.wrist arm.length [sevro] device2.serial "
              "device2.hand tracker.head_sensor ");
    EXPECT_TRUE(says(error_of("[device]\ndriver = \"magic\"\n"), {".toml:2", "magic", "sim", "phantom-usb"}));
    EXPECT_TRUE(says(error_of("[servo]\nperiod_us = 500\n[sevro]\n"), {".toml:3", "no such section"}));
    RtConfig fine;
    EXPECT_TRUE(config_errors("deploy/tact.toml", fine).empty());
}

TEST(Config, every_key_of_the_documented_file_is_among_the_values) {
    const RtConfig defaults;
    const auto values = config_values(defaults);
    EXPECT_GE(values.size(), 90U);
    const auto value = [&](const std::string& name) {
        for (const auto& [key, v] : values)
            if (key == name) return v;
        return ConfigValue("none");
    };
    EXPECT_EQ(value("servo.core"), ConfigValue(std::int64_t{-1}));
    EXPECT_EQ(value("device.driver"), ConfigValue("sim"));
    EXPECT_EQ(value("servo.lock_memory"), ConfigValue(true));
    EXPECT_EQ(value("servo.period_us"), ConfigValue(1000.0));
    EXPECT_EQ(value("device.hand_at_mm"), ConfigValue(std::vector<double>{0.0, 0.0}));
}

TEST(Config, a_key_outside_a_section_is_refused) {
    EXPECT_TRUE(says(error_of("period_us = 1000\n"), {".toml:1", "no section"}));
}

TEST(Config, broken_toml_and_a_missing_file_are_refused_with_a_message) {
    EXPECT_TRUE(says(error_of("[servo\n"), {".toml:1", "fix:"}));
    EXPECT_TRUE(says(error_of("[servo]\nperiod_us = = 3\n"), {".toml:2"}));
    RtConfig config;
    EXPECT_THROW(read_config("/nowhere/tact.toml", config), StartupError);
}

TEST(Config, values_of_the_file_reach_the_servo_in_si_units) {
    const TempFile file("[servo]\nperiod_us = 250\n[safety]\nwall_margin_mm = 2\nramp_in_ms = 20\n");
    RtConfig config;
    read_config(file.path(), config);
    const ServoSettings s = settings_from(config, true);
    EXPECT_EQ(s.period, std::chrono::microseconds(250));
    EXPECT_DOUBLE_EQ(s.chain.wall_margin_m, 0.002);
    EXPECT_DOUBLE_EQ(s.chain.ramp_in_s, 0.02);
    EXPECT_DOUBLE_EQ(s.governor.goal_hz, 4000.0);
    EXPECT_FALSE(s.watchdogs.timing_latches);  // emulated
}

TEST(Config, only_for_emulated_devices_the_device_watchdog_may_not_latch) {
    RtConfig config;
    for (const char* const word : {"real", "always", "never"}) {
        config.safety.timing_latches = word;
        EXPECT_TRUE(settings_from(config, false).watchdogs.device_watchdog_latches) << word;
        EXPECT_EQ(settings_from(config, true).watchdogs.device_watchdog_latches,
                  config.safety.timing_latches == "always")
            << word;
    }
}

TEST(Config, a_foot_pedal_needs_an_input_line) {
    RtConfig config;
    config.drilling.pedal = "line";
    const auto refused = [&config](const char* key) {
        try {
            check_config(config, "here");
        } catch (const StartupError& e) {
            return std::string(e.what()).find(key) != std::string::npos;
        }
        return false;
    };
    EXPECT_TRUE(refused("drilling.pedal"));
    config.lines.driver = "gpio";
    config.lines.dead_man = "1";
    EXPECT_TRUE(refused("drilling.pedal"));
    config.lines.burr_pedal = "2";
    check_config(config, "here");
    config.drilling.suction = "line";
    EXPECT_TRUE(refused("drilling.suction"));
    config.lines.suction_pedal = "3";
    check_config(config, "here");
    EXPECT_EQ(lines_settings_from(config).gpio.burr_pedal, "2");
    EXPECT_EQ(lines_settings_from(config).gpio.suction_pedal, "3");
}

TEST(Config, the_deadline_of_the_model_follows_the_period) {
    RtConfig config;
    for (const double period_us : {2000.0, 1000.0, 500.0, 125.0}) {
        config.servo.period_us = period_us;
        EXPECT_EQ(settings_from(config, true).model_max, duration_us(0.7 * period_us));
    }
    config.servo.model_us_max = 40.0;
    EXPECT_EQ(settings_from(config, true).model_max, duration_us(40.0));
    config.servo.model_us_max = 0.0;
    config.servo.free_running = true;  // no period: the goal replaces it
    config.governor.goal_hz = 4000.0;
    EXPECT_EQ(settings_from(config, true).model_max, duration_us(175.0));
}

TEST(Config, a_deadline_that_leaves_no_time_for_the_rest_of_the_cycle_is_refused) {
    const auto problems = [](const char* text) {
        const TempFile file(text);
        RtConfig config;
        std::string all;
        for (const ConfigError& e : config_errors(file.path(), config)) all += e.what();
        return all;
    };
    EXPECT_TRUE(says(problems("[servo]\nperiod_us = 500\nmodel_us_max = 600\n"),
                     {"servo.model_us_max", "600 us", "500 us", "at most 450", "0"}));
    EXPECT_EQ(problems("[servo]\nperiod_us = 500\nmodel_us_max = 450\n"), "");
    EXPECT_EQ(problems("[servo]\nfree_running = true\nmodel_us_max = 5000\n"), "");
}

TEST(Config, a_loop_is_expected_to_have_its_period_and_a_freely_running_one_that_of_its_goal) {
    RtConfig config;
    config.servo.period_us = 250.0;
    config.governor.goal_hz = 500.0;
    EXPECT_DOUBLE_EQ(expected_period_s(config), 250e-6);
    config.servo.free_running = true;
    EXPECT_DOUBLE_EQ(expected_period_s(config), 2e-3);
}

TEST(Config, a_fast_loop_keeps_time_to_sleep) {
    RtConfig::Servo servo;
    const auto spun_of = [&servo](double wait_us) { return servo_clock(servo).spin(duration_us(wait_us)); };
    EXPECT_EQ(spun_of(1000.0), duration_us(100.0));
    EXPECT_TRUE(sleeps(servo));
    servo.period_us = 125.0;
    EXPECT_EQ(spun_of(125.0), duration_us(62.5));
    EXPECT_TRUE(sleeps(servo));
    servo.spin_us = 125.0;  // all of it, as requested
    EXPECT_EQ(spun_of(125.0), duration_us(125.0));
    EXPECT_FALSE(sleeps(servo));
    servo.spin_us = 10.0;
    servo.free_running = true;
    EXPECT_FALSE(sleeps(servo));
}

}  // namespace
}  // namespace tact::config_test
