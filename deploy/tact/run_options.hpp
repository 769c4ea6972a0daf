// The options that all runs share, and those that go on to the controller or the visual process as they are.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ipc/base/clock.hpp"

namespace tact::launch {

struct RunOptions {
    double seconds = 0.0;  // 0: until asked to end
    bool headless = false;
    bool gui = true;
    std::filesystem::path screenshot;  // PNG of the last frame
    std::filesystem::path json;
    std::filesystem::path out;     // folder for run.json, run.csv and run.png
    std::filesystem::path save;    // folder for the placed structures
    std::filesystem::path record;  // every cycle of the run, HDF5
    std::filesystem::path flight;  // folder for its last seconds, when something happens
    std::string session = "default";
    std::string size = "1280x800";   // of the window
    bool size_given = false;         // by a person
    std::filesystem::path programs;  // folder of tact-rt and tact-gui; empty: beside tact
    bool quiet = false;              // no table
    // From the request to end to SIGKILL; the window may be writing the picture.
    Duration grace = std::chrono::seconds(10);
    std::vector<std::string> controller;  // options of tact-rt, in order
    std::vector<std::string> visual;      // options of tact-gui
    // Of the controller as a person typed them, where some were added that suit the first scene alone.
    std::optional<std::vector<std::string>> typed;

    [[nodiscard]] bool has_controller_option(const std::string& name) const;
    // Options of the controller that only this scene is meant with, and back to what was typed.
    void add_for_scene(const std::vector<std::string>& words);
    void forget_scene();
    // Fills in what --out implies and makes paths absolute; throws StartupError for options that do not go
    // together.
    void settle();
};

// Is the hand an emulated one for which no motion was chosen? A configuration that was typed chooses, the installed one where
// it names a device.
[[nodiscard]] bool hand_is_free(const RunOptions& options);

// Passed on to tact-rt, tact-gui or tact-prep, which check the value.
struct PassedOption {
    const char *name, *type, *help;
};

void add_run_options(CLI::App& app, RunOptions& options);

}  // namespace tact::launch
