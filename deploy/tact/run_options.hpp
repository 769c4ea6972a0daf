// Options that all runs share, and options that are passed on to the controller or the visual process.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ipc/base/clock.hpp"

namespace tact::launch {

struct RunOptions {
    double seconds = 0.0;  // 0: no limit
    bool headless = false;
    bool gui = true;
    std::filesystem::path screenshot;  // PNG of the last frame
    std::filesystem::path json;
    std::filesystem::path out;     // folder for run.json, run.csv and run.png
    std::filesystem::path save;    // folder for the placed structures
    std::filesystem::path record;  // every cycle of the run, HDF5
    std::filesystem::path keep;    // what the run changes in its scene; empty: a new file in the state folder
    std::filesystem::path flight;  // folder for recordings of the last seconds, saved at an event
    bool no_flight = false;        // a window has a flight recorder otherwise
    bool flight_typed = false;     // its folder was chosen
    std::string session = "default";
    std::string size = "1280x800";   // of the window
    bool size_given = false;         // given on the command line
    std::filesystem::path programs;  // folder of tact-rt and tact-gui; empty: that of tact
    bool quiet = false;              // no table of rates
    bool disarmed = false;           // a person arms the first scene too
    // Time from SIGTERM to SIGKILL; the window may be writing the screenshot.
    Duration grace = std::chrono::seconds(10);
    std::vector<std::string> controller;  // options of tact-rt, in order
    std::vector<std::string> visual;      // options of tact-gui
    // Controller options as typed, if options were added for the first scene only.
    std::optional<std::vector<std::string>> typed;

    [[nodiscard]] bool has_controller_option(const std::string& name) const;
    // Value of a controller option as typed; empty: not given.
    [[nodiscard]] std::string controller_value(const std::string& name) const;
    void drop_controller_option(const std::string& name);  // with its value
    void set_controller_value(const std::string& name,
                              const std::string& value);  // of an option that is given
    // Adds controller options for this scene only; forget_scene() restores the typed ones.
    void add_for_scene(const std::vector<std::string>& words);
    void forget_scene();
    // Fills in the paths implied by --out and makes paths absolute; throws StartupError for options that exclude each
    // other.
    void settle();
};

// True if the hand is emulated and no motion was chosen. A typed configuration is a choice; the installed one only if
// it names a device.
[[nodiscard]] bool hand_is_free(const RunOptions& options);

// True if a person at the window may lead the emulated hand by the mouse although no option says so: no hand and no configuration was typed,
// and the installed configuration, if any, names no real device.
[[nodiscard]] bool mouse_may_lead(const RunOptions& options);

// Passed on to tact-rt, tact-gui or tact-prep, which checks the value.
struct PassedOption {
    const char *name, *type, *help;
    bool file = false;  // of tact-prep: the scene depends on the content of the file; may be given repeatedly
};

void add_run_options(CLI::App& app, RunOptions& options);

}  // namespace tact::launch
