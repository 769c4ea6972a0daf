// The configuration of tact-rt: one TOML file, read into one struct whose defaults are the documentation.
//
// Units    as the keys say; converted to SI once, in settings_from().
// Fails by StartupError naming file, line, key, what is wrong and the fix: unknown keys, wrong types and
//          impossible values are errors. deploy/tact.toml shows every key, held to it by a test.
// Thread   start-up only
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "hal/lines_registry.hpp"
#include "hal/registry.hpp"
#include "hal/tracker_registry.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/fifo.hpp"
#include "rt/servo/servo.hpp"
#include "rt/threads/head_feed.hpp"

namespace tact {

// Of the period: the default deadline of the model's step, and the largest one that leaves time for the rest of a cycle.
inline constexpr double kModelShare = 0.75, kModelShareMost = 0.9;

struct RtConfig {
    struct Servo {
        double period_us = 1000.0;
        bool free_running = false;
        double spin_us =
            100.0;  // of the sleep before a cycle, spent spinning; hides the wake-up of the kernel
        std::int64_t core = -1;  // -1: the last isolated core, or with FIFO the last core; -2: not pinned
        std::int64_t priority = kServoPriority;  // FIFO; 0: ordinary scheduling
        double model_us_max = 0.0;               // deadline of the model's step; 0: kModelShare of the period
        bool lock_memory = true;
    } servo;
    struct Device {
        std::string driver = "sim";
        std::string hand = "passive";  // of the emulated device
        std::int64_t hand_seed = 1;
        std::array<double, 2> hand_at_mm{0.0, 0.0};  // x, y: where an emulated surgeon works
        double watchdog_us = 10000.0;
        std::string process_log;                     // of sim-process: file for its changes of state
        std::string serial;                          // of a real device; empty: the only one
        std::int64_t pump_priority = kPumpPriority;  // FIFO, of the thread on its bus; 0: ordinary
        std::string firmware;    // of falcon: its owner's file; empty: it has to run already
        std::string hd_library;  // of openhaptics: libHD.so; empty: searched
        std::string hd_device;   // of openhaptics: name of the arm; empty: the default one
    } device;
    struct Device2 {
        std::string driver =
            "none";  // of the second hand: the suction tube where bone is drilled, else a pointer
        std::string serial;
        std::string hand = "same";  // of an emulated one: as device.hand, or another
        std::int64_t hand_seed = 2;
    } device2;
    struct Tracker {
        std::string driver = "none";
        std::string interface = "can0";
        std::string format = "classic";  // or "fd"
        std::int64_t sensors = 1;        // on the bus
        std::int64_t head_sensor = 0;    // which of them is on the glasses
        double rate_hz = 240.0;          // of each
        double latency_ms = 4.0;         // from the motion to the frame
        double reach_m = 1.6;
        // Registration: the tracker's origin and axes in the frame of the screen.
        std::array<double, 3> position_screen_m{0.0, 0.0, 0.0};
        std::array<double, 4> quat_screen_tracker_xyzw{0.0, 0.0, 0.0, 1.0};
    } tracker;
    struct Lines {
        std::string driver = "none";
        std::string chip = "cp2112_gpio";  // label, name or path
        // A line each: number or name, '!' before it where low is active; "": not fitted.
        std::string emergency_stop_a, emergency_stop_b, dead_man, amplifier;
        std::string burr_pedal, suction_pedal;  // of tools; they stop nothing
        std::string enable, watchdog, lamp;
        std::string bias = "none";  // of the inputs, where the chip has one: "up", "down"
        bool edges = false;         // the chip has interrupts
        double look_us = 1000.0;    // between two looks; a slow adapter takes longer
        double release_ms = 30.0;
        double discrepancy_ms = 20.0;
        double follow_ms = 100.0;
        double age_us_max = 20000.0;
    } lines;
    ArmParameterSet arm =
        arm_parameter_set("premium-1.5");  // of real devices; [arm] is read by config_arm.cpp
    struct Shape {
        double force_scale = 1.0;
        double damping_n_s_m = 0.0;
    } shape;
    struct Surface {
        std::string mode = "off-tree";  // or "off-brute", "chr"
    } surface;
    struct Drilling {
        double burr_diameter_mm = 6.0;
        std::string burr_shape = "sphere";      // or "cylinder", "cone"
        double burr_length_mm = 8.0;            // of the head of those
        double shaft_diameter_mm = 2.4;         // 0: no shaft
        double burr_rpm = 60000.0;              // while the pedal is pressed
        std::string pedal = "button";           // the stylus's second button; or "line", "always"
        double irrigation_ml_min = 20.0;        // of water on the burr
        std::string irrigation = "pedal";       // with the burr; or "always"
        double suction_tube_diameter_mm = 2.0;  // of the tube in the second hand
        std::string suction = "button";         // the second hand's second button; or "line", "always"
        double suction_l_min = 20.0;
        double rate_per_s = 40.0;  // of erosion, at 60 000 rpm
        double vibration = 0.0;    // of the running burr, over the elastic force
    } drilling;
    struct Safety {
        double force_n_max = 3.3;
        double torque_n_m_max = 0.2;
        double force_slew_n_s = 500.0;
        double torque_slew_n_m_s = 30.0;
        double ramp_in_ms = 500.0;
        double ramp_out_ms = 50.0;
        double wall_margin_mm = 5.0;
        double wall_stiffness_n_m = 500.0;
        double hand_damping_n_s_m = 3.0;
        double heat_tau_s = 60.0;
        bool passivity = false;
        double passivity_energy_j = 0.0;
        double sample_age_us_max = 3500.0;
        double late_us_max = 5000.0;
        std::int64_t overruns_max = 5;
        std::string timing_latches = "real";  // "real": on real devices only; "always"; "never"
        double supervisor_us_max = 5000.0;    // of the servo's silence; with safety lines
        double gui_silent_ms = 500.0;
        std::string on_gui_silent = "continue";  // or "ramp"
    } safety;
    struct Govern {
        std::string law = "elastic";
        double goal_hz = 0.0;           // 0: the servo's rate; free running: 1000
        double display_goal_hz = 30.0;  // frames a second; 0: none
        double gain = 0.5;              // of the law "sensitus", as its tolerance
        double tolerance = 0.02;
        double interval_ms = 100.0;
    } governor;
};

// One thing that is wrong with a configuration. The text is "where: key: what", and the fix.
class ConfigError : public StartupError {
public:
    ConfigError(std::string where_, std::string key_, std::string what_, std::string fix_)
        : StartupError(where_ + (key_.empty() ? "" : ": " + key_), what_, fix_),
          where(std::move(where_)),
          key(std::move(key_)),
          problem(std::move(what_)),
          fix(std::move(fix_)) {}
    std::string where;  // file and line, or what was read
    std::string key;    // "servo.core"; empty: of the file as a whole
    std::string problem, fix;
};
using ConfigErrors = std::vector<ConfigError>;

// Overwrites what the file names. Throws the first error of the file.
void read_config(const std::string& path, RtConfig& config);
// All errors of the file: what cannot be read, key by key, then what check_config() finds. config has the rest.
[[nodiscard]] ConfigErrors config_errors(const std::string& path, RtConfig& config);
// Every key but those of [arm], with its value.
using ConfigValue = std::variant<double, std::int64_t, bool, std::string, std::vector<double>>;
[[nodiscard]] std::vector<std::pair<std::string, ConfigValue>> config_values(const RtConfig& config);
// Ranges of everything, whatever it came from; `where` heads the message.
void check_config(const RtConfig& config, const std::string& where);

// emulated: nobody's hand is on any of the devices.
[[nodiscard]] ServoSettings settings_from(const RtConfig& config, bool emulated);
[[nodiscard]] DeviceSettings device_settings_from(const RtConfig& config);
// Of the second hand: the same figures of the arm, another driver, serial and seed.
[[nodiscard]] DeviceSettings device2_settings_from(const RtConfig& config);
[[nodiscard]] LinesSettings lines_settings_from(const RtConfig& config);
[[nodiscard]] TrackerSettings tracker_settings_from(const RtConfig& config);
[[nodiscard]] HeadSettings head_settings_from(const RtConfig& config);
[[nodiscard]] Duration duration_us(double us);
// Whether the loop leaves its core to others between two cycles. Not where it was asked to spin all the time.
[[nodiscard]] bool sleeps(const RtConfig::Servo& servo);
// What is spent spinning: of a fast loop at most two fifths of its period, or it would hardly ever sleep, and a thread
// under FIFO that does not sleep for a second is ended by the kernel.
[[nodiscard]] Duration spin_tail(const RtConfig::Servo& servo);

}  // namespace tact
