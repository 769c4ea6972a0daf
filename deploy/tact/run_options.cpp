#include "deploy/tact/run_options.hpp"

#include <algorithm>
#include <cstdio>

#include "deploy/tact/installed_config.hpp"
#include "deploy/tact/probe.hpp"
#include "deploy/tact/systems.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/state_folder.hpp"

namespace tact::launch {
namespace {

// Only the names of the options are known here; the controller alone checks their values.
constexpr PassedOption kController[] = {
    {"--rate", "HZ", "Servo rate (Hz)"},
    {"--law", "elastic|sensitus|fixed", "Law of the governor, which trades accuracy for rate"},
    {"--goal", "HZ", "Force rate that the governor holds (Hz)"},
    {"--display-goal", "FPS",
     "Frame rate below which the governor draws a coarser surface (frames/s); 0: none"},
    {"--level", "PATH=VALUE",
     "Fixed level of one path, from 0 to 1, such as docking.force=1; sets the law to fixed"},
    {"--seed", "N", "Random seed for the start direction and the emulated hand"},
    {"--config", "FILE.toml",
     "Configuration of the controller (TOML); default: etc/tact/tact.toml of the installation, if any"},
    {"--core", "N", "Processor core of the servo thread"},
    {"--priority", "P", "Real-time priority of the servo thread"},
    {"--force-scale", "X", "Gain of the displayed force"},
    {"--hand", "passive|wander|stroke|drill|surgeon|suction-tube|mouse|spacemouse|gamepad",
     "Motion of the emulated hand; mouse, spacemouse, gamepad: led by that device in the window"},
    {"--hand2", "passive|wander|stroke|drill|surgeon|suction-tube|mouse|spacemouse|gamepad",
     "Motion of a second, emulated hand"},
};

constexpr PassedOption kVisual[] = {
    {"--fps-max", "FPS", "Maximum frame rate (frames/s)"},
    {"--ui-scale", "X", "Size of text and panels relative to the display's default"},
    {"--particles", "N", "Constant number of particles over bone, to measure their cost"},
    {"--frames", "FILE.json", "Times of the window's frames and their passes, as JSON at the end"},
    {"--molecule", "cartoon|trace|tube|sticks|spheres|surface", "Style of bodies in the window"},
    {"--colour", "chain|element|body|fit", "Colour of bodies in the window"},
    {"--stereo", "off|anaglyph|side-by-side|top-bottom|two-windows|quad-buffer", "Stereo mode of the window"},
    {"--window-state", "FILE.toml",
     "Settings of the window (TOML), read at the start if the file exists and written at the end"},
    {"--texts", "FILE.json",
     "Keep this file up to date with the texts on the window, for scripts that operate it by its labels"},
    {"--training", "FILE.toml", "Training task of a drilling scene; see deploy/tact/drilling/README.md"},
    {"--trainee", "NAME", "Name of the trainee, for the report"},
    {"--training-folder", "DIR", "Folder of training reports; default: in $XDG_STATE_HOME/tact"},
    {"--stage", "FILE.toml", "Positions of screen, eyes and workspace (TOML); see gui/stereo/README.md"},
    {"--stage-screenshot", "FILE.png", "Screenshot of the stereo image at the end"},
};

struct PassedFlag {
    const char* name;
    const char* help;
};
constexpr PassedFlag kVisualFlags[] = {
    {"--traces", "Start with traces of every servo cycle instead of the plots"},
    {"--mute", "No sound of the drill"},
    {"--swap-eyes", "Swap the images of the two eyes"},
    {"--test-picture", "Start with the stereo test image, which checks eyes, scale and tool"},
};

void add_controller_option(CLI::App& group, const PassedOption& p, RunOptions& options) {
    group
        .add_option_function<std::vector<std::string>>(
            p.name,
            [&options, name = std::string(p.name)](const std::vector<std::string>& values) {
                for (const auto& v : values) options.controller.insert(options.controller.end(), {name, v});
            },
            p.help)
        ->type_name(p.type)
        ->expected(1)
        ->multi_option_policy(std::string(p.name) == "--level" ? CLI::MultiOptionPolicy::TakeAll
                                                               : CLI::MultiOptionPolicy::Throw);
}

}  // namespace

bool RunOptions::has_controller_option(const std::string& name) const {
    return std::find(controller.begin(), controller.end(), name) != controller.end();
}

std::string RunOptions::controller_value(const std::string& name) const {
    const auto at = std::find(controller.begin(), controller.end(), name);
    return at != controller.end() && at + 1 != controller.end() ? at[1] : std::string();
}

void RunOptions::drop_controller_option(const std::string& name) {
    const auto at = std::find(controller.begin(), controller.end(), name);
    if (at != controller.end() && at + 1 != controller.end()) controller.erase(at, at + 2);
}

void RunOptions::set_controller_value(const std::string& name, const std::string& value) {
    const auto at = std::find(controller.begin(), controller.end(), name);
    if (at != controller.end() && at + 1 != controller.end()) at[1] = value;
}

void RunOptions::add_for_scene(const std::vector<std::string>& words) {
    if (!typed) typed = controller;
    controller.insert(controller.end(), words.begin(), words.end());
}

void RunOptions::forget_scene() {
    if (typed) controller = *typed;
    typed.reset();
}

bool hand_is_free(const RunOptions& options) {
    if (options.has_controller_option("--hand") || options.has_controller_option("--config")) return false;
    const auto config = installed_config();
    return config.empty() || read_device_request(config).driver.starts_with("sim");
}

// A person at the window who chose no hand and has no device.
bool mouse_may_lead(const RunOptions& options) {
    if (!options.gui || options.headless || options.has_controller_option("--mouse")) return false;
    const std::vector<std::string>& typed = options.typed ? *options.typed : options.controller;
    for (const char* const choice : {"--hand", "--hand2", "--config"})
        if (std::find(typed.begin(), typed.end(), choice) != typed.end()) return false;
    const auto config = installed_config();
    if (config.empty()) return true;
    const std::string driver = read_device_request(config).driver;
    return driver.empty() || driver == "sim";
}

void RunOptions::settle() {
    if (mouse_may_lead(*this))
        for (auto* const words : {&controller, typed ? &*typed : nullptr})
            if (words != nullptr) words->emplace_back("--mouse");
    if (const auto config = installed_config(); !config.empty() && !has_controller_option("--config")) {
        if (!quiet) std::fprintf(stderr, "tact: configuration %s\n", config.c_str());
        for (auto* const words : {&controller, typed ? &*typed : nullptr})
            if (words != nullptr) words->insert(words->end(), {"--config", config.string()});
    }
    if (!out.empty()) {
        out = std::filesystem::absolute(out);
        if (json.empty()) json = out / "run.json";
        if (screenshot.empty() && gui) screenshot = out / "run.png";
    }
    if (!gui && !screenshot.empty())
        throw StartupError("reading the options", "--screenshot needs a window, and --no-gui starts none",
                           "remove one of the two; --headless draws without a screen");
    if (!gui && std::find(visual.begin(), visual.end(), "--training") != visual.end())
        throw StartupError("reading the options", "--training needs a window, and --no-gui starts none",
                           "remove one of the two; --headless draws without a screen");
    if (!json.empty()) json = std::filesystem::absolute(json);
    flight_typed = !flight.empty();
    // A person in front of a window can look back.
    if (const auto state = state_folder(); flight.empty() && gui && !headless && !no_flight && !state.empty())
        flight = state / "flight";
    if (!flight.empty()) flight = std::filesystem::absolute(flight);
    if (!record.empty()) record = std::filesystem::absolute(record);
    if (!record.empty() && std::filesystem::exists(record))
        throw StartupError("recording to " + record.string(), "the file exists already",
                           "give another name, or remove the file");
    if (!keep.empty()) keep = std::filesystem::absolute(keep);
    if (!keep.empty() && std::filesystem::exists(keep))
        throw StartupError("keeping drilled bone in " + keep.string(), "the file exists already",
                           "give another name, or continue with it: --resume");
    if (!save.empty()) save = std::filesystem::absolute(save);
    if (!screenshot.empty()) {
        screenshot = std::filesystem::absolute(screenshot);
        std::error_code failed;
        std::filesystem::create_directories(screenshot.parent_path(), failed);
        if (failed)
            throw StartupError("making the folder " + screenshot.parent_path().string(), failed.message(),
                               "give another path to --screenshot");
    }
}

void add_run_options(CLI::App& app, RunOptions& options) {
    app.add_option("--seconds", options.seconds, "Length of the run (s); default: until the window is closed")
        ->type_name("S")
        ->check(CLI::Range(0.0, 1e7));
    app.add_flag("--headless", options.headless, "Draw without a screen, on a private X server (Xvfb)");
    app.add_flag_callback(
        "--no-gui", [&options] { options.gui = false; }, "Run the controller alone, without a window");
    app.add_option("--screenshot", options.screenshot, "Screenshot of the window at the end")
        ->type_name("FILE.png");
    app.add_option("--json", options.json, "Report of the run (JSON)")->type_name("FILE.json");
    app.add_option("--out", options.out, "Folder for run.json, run.csv (ten rows per second) and run.png")
        ->type_name("DIR");
    app.add_option("--save", options.save,
                   "New folder for the placed structures, their matrices and a table, written at the end")
        ->type_name("DIR");
    app.add_option("--record", options.record,
                   "New recording of every servo cycle; see tact record and tact replay")
        ->type_name("FILE.h5");
    app.add_option(
           "--flight", options.flight,
           "Folder for recordings of the last 30 s, saved at an overrun, a fault or the key M in the window; "
           "default with a window: in $XDG_STATE_HOME/tact/flight")
        ->type_name("DIR");
    app.add_flag("--no-flight", options.no_flight, "Do not keep the last 30 s, also with a window")
        ->excludes("--flight");
    app.add_option("--keep", options.keep,
                   "New file for the drilled bone, written while it is drilled; default: in "
                   "$XDG_STATE_HOME/tact/drilled; continue with it by --resume")
        ->type_name("FILE.bone");
    app.add_option("--session", options.session, "Session name shared by the processes of the run")
        ->type_name("NAME")
        ->capture_default_str();
    app.add_flag("--disarmed", options.disarmed,
                 "Do not arm at the start: arm in the window, or with Ctrl+Enter there");
    app.add_flag("--quiet", options.quiet, "Do not print the table of rates");

    auto* const controller =
        app.add_option_group("Controller", "Options for tact-rt; default: the value in the configuration");
    for (const PassedOption& p : kController) add_controller_option(*controller, p, options);
    for (const System& system : systems())
        for (const PassedOption& p : system.controller_options)
            add_controller_option(*controller, p, options);
    controller->add_flag_callback(
        "--free-run", [&options] { options.controller.emplace_back("--free-run"); },
        "Update the force as often as the processor allows, instead of at --rate");

    controller->add_flag_callback(
        "--mouse", [&options] { options.controller.emplace_back("--mouse"); },
        "The mouse in the window may take an emulated hand from its motion, and then leads it; default "
        "without --hand, "
        "--hand2 and --config");

    auto* const visual = app.add_option_group("Window", "Options for tact-gui");
    visual->add_option("--size", options.size, "Size of the window (pixels)")
        ->type_name("WxH")
        ->each([&options](const std::string&) { options.size_given = true; })
        ->capture_default_str();
    for (const PassedFlag& p : kVisualFlags)
        visual->add_flag_callback(
            p.name, [&options, name = p.name] { options.visual.emplace_back(name); }, p.help);
    for (const PassedOption& p : kVisual)
        visual
            ->add_option_function<std::string>(
                p.name,
                [&options, name = p.name](const std::string& v) {
                    options.visual.insert(options.visual.end(), {name, v});
                },
                p.help)
            ->type_name(p.type);
}

}  // namespace tact::launch
