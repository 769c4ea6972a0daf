#include "deploy/tact/run_options.hpp"

#include <algorithm>
#include <cstdio>

#include "deploy/tact/installed_config.hpp"
#include "deploy/tact/probe.hpp"
#include "ipc/base/error.hpp"

namespace tact::launch {
namespace {

struct Passed {
    const char* name;
    const char* type;
    const char* help;
};

// The controller checks the values; here only their names are known, so that there is one place to say what
// is right.
constexpr Passed kController[] = {
    {"--rate", "HZ", "servo rate"},
    {"--law", "elastic|sensitus|fixed", "law of the governor"},
    {"--goal", "HZ", "force rate that the governor holds"},
    {"--picture-goal", "FPS", "frames a second below which the surface gets coarser; 0: none"},
    {"--level", "PATH=VALUE", "fixed level of a path, e.g. docking.force=1; the law becomes fixed"},
    {"--start-offset-a", "A", "move the first structure this far from the place its file gives it"},
    {"--start-rotation-deg", "DEG", "turn the first structure by this angle at the start"},
    {"--seed", "N", "random seed of the start direction and axis, and of the emulated hand"},
    {"--copies", "N", "so many bodies of the first structure; the others stand about the map"},
    {"--poses", "FILE.json", "start with the bodies where the report of an earlier run has them"},
    {"--config", "FILE.toml",
     "configuration of the controller, TOML; default: etc/tact/tact.toml of the installation, if any"},
    {"--core", "N", "processor core of the servo thread"},
    {"--priority", "P", "real-time priority of the servo thread"},
    {"--force-scale", "X", "gain of the shown force"},
    {"--hand", "passive|wander|stroke|drill|surgeon|suction-tube", "motion of the emulated hand"},
    {"--hand2", "passive|wander|stroke|drill|surgeon|suction-tube",
     "motion of an emulated second hand; suction-tube: beside a surgeon"},
    {"--hand-at-mm", "X,Y", "position in mm at which an emulated surgeon works"},
    {"--pedal", "button|line|always",
     "switch of the burr: button of the stylus, line of a foot pedal, or always on"},
    {"--burr-mm", "MM", "diameter of the burr"},
    {"--burr-shape", "sphere|cylinder|cone", "shape of the burr"},
    {"--burr-rpm", "RPM", "speed of the burr"},
    {"--tool-radius-mm", "MM", "radius of the ball that touches a surface; 0: a point"},
    {"--stiffness", "N/M", "stiffness of a surface"},
    {"--friction", "MU", "friction coefficient of a surface"},
    {"--mode", "off-brute|off-tree|chr",
     "how the surface is searched for contacts; chr: fine around the tool"},
};

constexpr Passed kVisual[] = {
    {"--fps-max", "FPS", "highest rate of drawing"},
    {"--ui-scale", "X", "letters and panels so many times as large as the display asks for"},
    {"--particles", "N", "keep this many particles over bone, to measure what they cost"},
    {"--stereo", "off|anaglyph|side-by-side|top-bottom|two-windows|quad-buffer", "stereo mode of the window"},
    {"--window-state", "FILE.toml",
     "begin with what was set in the window, TOML, and write it at the end; it need not exist"},
    {"--stage", "FILE.toml", "where screen, eyes and workspace are, TOML; see gui/stereo/README.md"},
    {"--stage-screenshot", "FILE.png", "the stereo picture at the end"},
};

struct PassedFlag {
    const char* name;
    const char* help;
};
constexpr PassedFlag kVisualFlags[] = {
    {"--traces", "begin with the traces of every servo cycle in place of the plots"},
    {"--swap-eyes", "swap the pictures of the two eyes"},
    {"--test-picture", "begin with the stereo test picture: are eyes, scale and tool where they should be?"},
};

// Is the hand an emulated one that nobody has said anything about? A configuration that was typed says something; the
// installed one where it names a device.
bool hand_is_free(const RunOptions& options) {
    if (options.has_controller_option("--hand") || options.has_controller_option("--config")) return false;
    const auto config = installed_config();
    return config.empty() || read_device_request(config).driver.starts_with("sim");
}

}  // namespace

bool RunOptions::has_controller_option(const std::string& name) const {
    return std::find(controller.begin(), controller.end(), name) != controller.end();
}

void RunOptions::add_for_scene(const std::vector<std::string>& words) {
    if (!typed) typed = controller;
    controller.insert(controller.end(), words.begin(), words.end());
}

void RunOptions::forget_scene() {
    if (typed) controller = *typed;
    typed.reset();
}

void let_the_hand_stroke(RunOptions& options) {
    if (hand_is_free(options)) options.add_for_scene({"--hand", "stroke"});
}

void let_the_hands_drill(RunOptions& options) {
    if (!hand_is_free(options)) return;
    options.add_for_scene({"--hand", "surgeon"});
    if (!options.has_controller_option("--hand2")) options.add_for_scene({"--hand2", "suction-tube"});
}

void RunOptions::settle() {
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
        throw StartupError("reading the options",
                           "--screenshot needs the visual process, and --no-gui leaves it out",
                           "leave one of the two away; --headless draws without a screen");
    if (!json.empty()) json = std::filesystem::absolute(json);
    if (!flight.empty()) flight = std::filesystem::absolute(flight);
    if (!record.empty()) record = std::filesystem::absolute(record);
    if (!record.empty() && std::filesystem::exists(record))
        throw StartupError("recording to " + record.string(), "the file is there already",
                           "name another one, or remove it");
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
    app.add_option("--seconds", options.seconds,
                   "end by itself after this time; default: when the window is closed")
        ->type_name("S")
        ->check(CLI::Range(0.0, 1e7));
    app.add_flag("--headless", options.headless, "draw without a screen, on an X server of its own (Xvfb)");
    app.add_flag_callback(
        "--no-gui", [&options] { options.gui = false; }, "run the controller alone, without a window");
    app.add_option("--screenshot", options.screenshot, "picture of the window at the end")
        ->type_name("FILE.png");
    app.add_option("--json", options.json, "write the measurements of the run as JSON")
        ->type_name("FILE.json");
    app.add_option("--out", options.out, "folder for run.json, run.csv (ten rows a second) and run.png")
        ->type_name("DIR");
    app.add_option("--save", options.save,
                   "new folder for the placed structures, their matrices and a table, at the end of the run")
        ->type_name("DIR");
    app.add_option("--record", options.record,
                   "new file for every cycle of the run; see tact record, tact replay")
        ->type_name("FILE.h5");
    app.add_option("--flight", options.flight,
                   "folder for the last 30 s, saved at an overrun, a fault or the window's key M")
        ->type_name("DIR");
    app.add_option("--session", options.session, "name under which the processes find each other")
        ->type_name("NAME")
        ->capture_default_str();
    app.add_flag("--quiet", options.quiet, "print no table of rates");

    auto* const controller = app.add_option_group("Controller", "options that go on to tact-rt");
    for (const Passed& p : kController) {
        controller
            ->add_option_function<std::vector<std::string>>(
                p.name,
                [&options, name = std::string(p.name)](const std::vector<std::string>& values) {
                    for (const auto& v : values) {
                        options.controller.push_back(name);
                        options.controller.push_back(v);
                    }
                },
                p.help)
            ->type_name(p.type)
            ->expected(1)
            ->multi_option_policy(std::string(p.name) == "--level" ? CLI::MultiOptionPolicy::TakeAll
                                                                   : CLI::MultiOptionPolicy::Throw);
    }
    controller->add_flag_callback(
        "--free-run", [&options] { options.controller.emplace_back("--free-run"); },
        "as many force updates as the processor gives, in place of --rate");

    auto* const visual = app.add_option_group("Window", "options that go on to tact-gui");
    visual->add_option("--size", options.size, "size of the window in pixels")
        ->type_name("WxH")
        ->each([&options](const std::string&) { options.size_given = true; })
        ->capture_default_str();
    for (const PassedFlag& p : kVisualFlags)
        visual->add_flag_callback(
            p.name, [&options, name = p.name] { options.visual.emplace_back(name); }, p.help);
    for (const Passed& p : kVisual)
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
