// The configuration of tact-rt: one TOML file, read into one struct that also defines the defaults.
//
// Units    named in the keys; converted to SI once, in settings_from().
// Fails by StartupError with file, line, key, problem and fix. Unknown keys, wrong types and impossible values
//          are errors. deploy/tact.toml shows every key; a test checks this.
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
#include "ipc/base/servo_clock.hpp"
#include "rt/servo/servo.hpp"
#include "rt/threads/head_feed.hpp"

namespace tact {

// Fractions of the period: default deadline of the model's step, and largest one that leaves time for the rest of a cycle.
inline constexpr double kModelShare = 0.7, kModelShareMost = 0.9;

struct RtConfig {
    struct Servo {
        double period_us = 1000.0;
        bool free_running = false;
        double spin_us = 100.0;  // busy-waiting before a cycle; hides the kernel's wake-up latency
        std::int64_t core = -1;  // -1: the last isolated core, or with FIFO the last core; -2: not pinned
        std::int64_t priority = kServoPriority;  // FIFO; 0: ordinary scheduling
        double model_us_max = 0.0;               // deadline of the model's step; 0: kModelShare of the period
        bool lock_memory = true;
    } servo;
    struct Device {
        std::string driver = "sim";
        std::string hand = "passive";  // emulated devices: script of the hand
        bool mouse = false;  // emulated devices: a pointer in the window may take the hand from its script
        std::int64_t hand_seed = 1;
        std::array<double, 2> hand_at_mm{0.0, 0.0};  // x, y of an emulated surgeon's working point
        double watchdog_us = 10000.0;
        std::string process_log;                     // sim-process: file that records its state changes
        std::string serial;                          // real devices; empty: the only one
        std::int64_t pump_priority = kPumpPriority;  // FIFO priority of the bus thread; 0: ordinary
        std::string firmware;        // falcon: firmware file of its owner; empty: firmware already runs
        std::string hd_library;      // openhaptics: path of libHD.so; empty: search for it
        std::string hd_device;       // openhaptics: name of the arm; empty: the default one
        std::string fd_library;      // forcedimension: path of libdrd.so; empty: search for it
        bool fd_initialize = false;  // forcedimension: an uninitialized arm moves by itself at the start
        bool fd_gravity = false;     // forcedimension: the library holds the weight of the arm
        std::int64_t inverse_port = 10001;  // inverse3: WebSocket port of the Inverse Service on this machine
    } device;
    struct Device2 {  // of the second hand: the suction tube in drilling scenes, else a pointer
        std::string driver = "none";
        std::string serial;
        std::string hand = "same";  // emulated devices: "same" as device.hand, or a script
        std::int64_t hand_seed = 2;
    } device2;
    struct Tracker {
        std::string driver = "none";
        std::string interface = "can0";
        std::string host = "127.0.0.1";  // of an OpenIGTLink server
        std::int64_t port = kIgtlPort;
        std::string devices;             // its names of the sensors, with commas between them
        std::string format = "classic";  // or "fd"
        std::int64_t sensors = 1;        // on the bus
        std::int64_t head_sensor = 0;    // index of the sensor on the glasses
        double rate_hz = 240.0;          // of each sensor
        double latency_ms = 4.0;         // from motion to CAN frame
        double reach_m = 1.6;
        // Registration: the tracker's origin and axes in the frame of the screen.
        std::array<double, 3> position_screen_m{0.0, 0.0, 0.0};
        std::array<double, 4> quat_screen_tracker_xyzw{0.0, 0.0, 0.0, 1.0};
    } tracker;
    struct Lines {
        std::string driver = "none";
        std::string chip = "cp2112_gpio";  // label, name or path
        // One line each: number or name, with a leading '!' if active low; "": not fitted.
        std::string emergency_stop_a, emergency_stop_b, dead_man, amplifier;
        std::string burr_pedal, suction_pedal;  // tool pedals; without a safety function
        std::string enable, watchdog, lamp;
        std::string bias = "none";  // input bias, if the chip supports one: "up", "down"
        bool edges = false;         // the chip has interrupts
        double sample_us = 1000.0;  // sampling period; a slow adapter takes longer
        double release_ms = 30.0;
        double discrepancy_ms = 20.0;
        double follow_ms = 100.0;
        double age_us_max = 20000.0;
    } lines;
    ArmParameterSet arm = arm_parameter_set("premium-1.5");  // real devices; config_arm.cpp reads [arm]
    struct Shape {
        double force_scale = 1.0;
        double damping_n_s_m = 0.0;
    } shape;
    struct Surface {
        std::string mode = "off-tree";  // or "off-brute", "chr"
    } surface;
    struct Drilling {
        double burr_diameter_mm = 6.0;
        std::string burr_shape = "sphere";  // or "cylinder", "cone"
        std::string burr_grit = "cutting";  // or "diamond"
        double burr_length_mm = 8.0;        // head length of a cylinder or cone
        double shaft_diameter_mm = 2.4;     // 0: no shaft
        double burr_rpm = 60000.0;          // while the pedal is pressed
        std::string pedal = "button";       // second button of the stylus; or "line", "always"
        double irrigation_ml_min = 20.0;    // water flow onto the burr
        std::string irrigation = "pedal";   // while the burr runs; or "always"
        double suction_tube_diameter_mm = 2.0;
        std::string suction = "button";  // second button of the second stylus; or "line", "always"
        double suction_l_min = 20.0;
        double rate_per_s = 40.0;  // erosion rate at 60 000 rpm
        double diamond_share =
            0.3;                 // a diamond burr's erosion rate and vibration over those of a cutting one
        double vibration = 0.0;  // amplitude while the burr runs, as a fraction of the elastic force
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
        double hand_turn_damping_n_m_s_rad = 0.003;
        double heat_tau_s = 60.0;
        bool passivity = false;
        double passivity_energy_j = 0.0;
        double sample_age_us_max = 3500.0;
        double late_us_max = 5000.0;
        std::int64_t overruns_max = 5;
        std::string timing_latches = "real";  // "real": on real devices only; "always"; "never"
        double supervisor_us_max = 5000.0;    // longest gap between servo heartbeats; with safety inputs
        double gui_silent_ms = 500.0;
        std::string on_gui_silent = "continue";  // or "ramp"
    } safety;
    struct Govern {
        std::string law = "elastic";
        double goal_hz = 0.0;           // 0: the servo's rate; free running: 1000
        double display_goal_hz = 30.0;  // frames per second; 0: none
        double force_level_min = 0.0;   // the law never lowers the haptic level below it
        double gain = 0.5;              // of the law "sensitus"
        double tolerance = 0.02;        // of the law "sensitus"
        double interval_ms = 100.0;
    } governor;
};

// One problem of a configuration. The text is "where: key: problem", followed by the fix.
class ConfigError : public StartupError {
public:
    ConfigError(std::string where_, std::string key_, std::string what_, std::string fix_)
        : StartupError(where_ + (key_.empty() ? "" : ": " + key_), what_, fix_),
          where(std::move(where_)),
          key(std::move(key_)),
          problem(std::move(what_)),
          fix(std::move(fix_)) {}
    std::string where;  // file and line, or another source
    std::string key;    // "servo.core"; empty: the whole file
    std::string problem, fix;
};
using ConfigErrors = std::vector<ConfigError>;

// Overwrites the keys that the file sets. Throws the first error of the file.
void read_config(const std::string& path, RtConfig& config);
// Returns all errors of the file: first those of reading, key by key, then those of check_config(). Sets the valid
// keys in config.
[[nodiscard]] ConfigErrors config_errors(const std::string& path, RtConfig& config);
// Every key except those of [arm], with its value.
using ConfigValue = std::variant<double, std::int64_t, bool, std::string, std::vector<double>>;
[[nodiscard]] std::vector<std::pair<std::string, ConfigValue>> config_values(const RtConfig& config);
// Checks the ranges of all values, whether from file or command line; `where` starts the message.
void check_config(const RtConfig& config, const std::string& where);

// emulated: no device is real, so no person holds one.
[[nodiscard]] ServoSettings settings_from(const RtConfig& config, bool emulated);
[[nodiscard]] DeviceSettings device_settings_from(const RtConfig& config);
// Second hand: same arm parameters; its own driver, serial and seed.
[[nodiscard]] DeviceSettings device2_settings_from(const RtConfig& config);
// The hands that a pointer in the window may lead: emulated ones, by a script with the name of a LeadDevice or by device.mouse.
[[nodiscard]] std::array<bool, 2> mouse_hands(const RtConfig& config);
// The device that each hand's script names; the mouse for other scripts.
[[nodiscard]] std::array<LeadDevice, 2> lead_devices(const RtConfig& config);
[[nodiscard]] LinesSettings lines_settings_from(const RtConfig& config);
[[nodiscard]] TrackerSettings tracker_settings_from(const RtConfig& config);
[[nodiscard]] HeadSettings head_settings_from(const RtConfig& config);
[[nodiscard]] Duration duration_us(double us);
// True if a person chose a spin of the whole period.
[[nodiscard]] bool spins_whole_period(const RtConfig::Servo& servo);
// True if the loop yields its core between two cycles; false if it is free running or spins the whole period.
[[nodiscard]] bool sleeps(const RtConfig::Servo& servo);
// Of a freely running loop, that of its goal, if it has one.
[[nodiscard]] double expected_period_s(const RtConfig& config);
// Spins servo.spin_us before a cycle: if the loop sleeps, at most ServoClock::kSpinShare of a wait.
[[nodiscard]] ServoClock servo_clock(const RtConfig::Servo& servo);

}  // namespace tact
