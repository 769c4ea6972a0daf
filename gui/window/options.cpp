#include "gui/window/options.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <map>

#include "gui/base/toml_keys.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/state_folder.hpp"
#include "ipc/base/whole_numbers.hpp"
#include "ipc/manual/manual.hpp"
#include "ipc/version/version.hpp"

namespace tact {

namespace {
constexpr const char* kKeysFix =
    "tact-gui --keys lists all actions with their keys, in the form of this file";

// Contours are checked here, so that a session never fails later.
void open_session(const std::string& file, GuiOptions& options) {
    options.session_opened = read_session(file);
    options.session_file = file;
    for (const std::string& contour : options.session_opened->contours)
        static_cast<void>(read_contour_option(contour));
    if (options.session_opened->window.empty()) return;
    options.window_state = read_window_state_text(options.session_opened->window, file);
    options.traces = options.traces || options.window_state.traces;
}
}  // namespace

bool parse_gui_options(int argc, const char* const* argv, GuiOptions& options, int& exit_code) {
    CLI::App app(
        "tact-gui: displays the scene and the state of the controller. Waits for a controller to start.");
    app.footer(
        "Exit codes: 0 window closed or time over; 1 error; 2 wrong usage, or an invalid "
        "settings file.");
    app.set_version_flag("--version", program_version("tact-gui"));
    std::string size;
    app.add_option("scene", options.scene, "Baked scene; default: the scene of the controller");
    app.add_option("--session", options.session, "Session name of the controller")
        ->type_name("NAME")
        ->capture_default_str();
    app.add_option("--scene-switch", options.scene_switch,
                   "Folder for requests to run another scene; set by tact")
        ->check(CLI::ExistingDirectory);
    app.add_flag("--start-page", options.start_page,
                 "Show demos and recent scenes, for tact without arguments; needs --scene-switch")
        ->needs("--scene-switch");
    app.add_option("--seconds", options.seconds, "Run time (s); 0: until the window is closed")
        ->check(CLI::Range(0.0, 1e7));
    app.add_option("--screenshot", options.screenshot, "Write a PNG of the last frame at the end")
        ->type_name("FILE.png");
    app.add_flag("--watch", options.watch,
                 "Instructor's window beside that of the run: changes nothing, may disarm and mark places");
    app.add_option("--training", options.training.plan, "Training task of a drilling scene (TOML)")
        ->type_name("FILE.toml");
    app.add_option("--trainee", options.training.trainee, "Name of the trainee, for the report")
        ->type_name("NAME");
    app.add_option("--training-folder", options.training.folder,
                   "Folder of training reports; default: in $XDG_STATE_HOME/tact")
        ->type_name("DIR");
    app.add_flag("--mute", options.mute, "No sound, whatever the window's settings say");
    app.add_option("--report", options.report, "Write a report of a drilling scene as JSON at the end")
        ->type_name("FILE.json");
    app.add_option("--frames", options.frames,
                   "Write the times of frames and their passes as JSON at the end")
        ->type_name("FILE.json");
    app.add_option("--texts", options.texts,
                   "Keep this file up to date with the texts on the window and where they are (JSON), for "
                   "scripts that "
                   "operate it by its labels")
        ->type_name("FILE.json");
    app.add_option("--picture-every", options.every_s,
                   "Interval (s) of a series NAME-01.png, ... of the 3D view; needs --screenshot NAME.png")
        ->check(CLI::Range(0.1, 1e5));
    app.add_option("--zoom", options.zoom, "Zoom factor of the initial view")->check(CLI::Range(0.1, 20.0));
    app.add_option("--window-state", options.window_state_file,
                   "TOML file of the window's settings: read at the start if it exists, written at "
                   "the end")
        ->type_name("FILE.toml");
    std::string session_file;
    app.add_option("--open-session", session_file,
                   "Session that continues: contours, snapshots and view; set by tact")
        ->type_name("FILE.tact-session")
        ->check(CLI::ExistingFile);
    bool list_keys = false;
    std::string key_file;
    app.add_option(
           "--key-file", key_file,
           "TOML file of the person's own keys; default: keys.toml in $XDG_CONFIG_HOME/tact, if it exists")
        ->type_name("FILE.toml")
        ->check(CLI::ExistingFile);
    app.add_flag("--keys", list_keys, "List the keys in the form of that file and end");
    CLI::Option* const size_option =
        app.add_option("--size", size, "Window size (pixels), for example 1280x720");
    size_option->check(CLI::Validator(
        [&options](std::string& text) -> std::string {
            const auto px = numbers_between(text, "x");
            if (!px || (*px)[0] < 320 || (*px)[1] < 240 || (*px)[0] > 16384 || (*px)[1] > 16384)
                return "--size: '" + text + "' is not WIDTHxHEIGHT between 320x240 and 16384x16384";
            options.width_px = static_cast<int>((*px)[0]);
            options.height_px = static_cast<int>((*px)[1]);
            return {};
        },
        "WxH"));
    app.add_option("--ui-scale", options.ui_scale,
                   "Scale factor of text and panels, on top of the automatic scale")
        ->check(CLI::Range(0.5, 4.0));
    app.add_flag("--traces", options.traces,
                 "Start with the traces of every servo cycle instead of the plots");
    app.add_flag("--hidden", options.hidden, "Draw without showing a window");
    app.add_flag("--plain", options.plain, "Cheapest rendering: no gradient, solid surface");
    app.add_option("--fps-max", options.fps_max,
                   "Maximum frame rate (1/s); 0: unlimited; default: the display's rate, or 60")
        ->check(CLI::Range(0.0, 1e5));
    app.add_option("--molecule", options.look.style,
                   "Style of bodies: cartoon, trace, tube, sticks, spheres or surface")
        ->transform(CLI::CheckedTransformer(
            std::map<std::string, MoleculeStyle>{{"trace", MoleculeStyle::trace},
                                                 {"tube", MoleculeStyle::tube},
                                                 {"sticks", MoleculeStyle::sticks},
                                                 {"spheres", MoleculeStyle::spheres},
                                                 {"cartoon", MoleculeStyle::cartoon},
                                                 {"surface", MoleculeStyle::surface}}));
    app.add_option("--colour", options.look.colouring,
                   "Colour of bodies: by chain, element, body, or the fit of their residues to the map")
        ->transform(CLI::CheckedTransformer(std::map<std::string, Colouring>{{"chain", Colouring::chain},
                                                                             {"element", Colouring::element},
                                                                             {"body", Colouring::body},
                                                                             {"fit", Colouring::fit}}));
    app.add_option(
           "--contour",
           "Isosurface as LEVEL[:RRGGBB][:OPACITY][:STYLE], up to four times; level in the map's unit, "
           "with s in sigma, with % of the map's volume; styles glass, solid, wire")
        ->expected(1)
        ->take_all()  // repeated, because the next argument may be the scene
        ->type_name("CONTOUR")
        ->each(
            [&options](const std::string& text) { options.contours.push_back(read_contour_option(text)); });
    app.add_flag("!--no-depth-cue", options.depth_cue, "Do not fade distant content");
    app.add_flag("--near-burr", options.near_burr, "Close view of the burr once it is in bone");
    app.add_option("--particles", options.particles,
                   "Constant number of particles over bone, to measure their cost")
        ->check(CLI::Range(0, 100000));
    app.add_flag("--bench-particles", options.bench_particles,
                 "Measure the cost of moving particles, print it as JSON and end; opens no window");
    std::string stereo;
    bool swap_eyes = false;
    app.add_option("--stage", options.stage_file,
                   "TOML file of the stereo display: screen, eyes, monitors (gui/stereo/README.md)")
        ->type_name("FILE.toml");
    app.add_option("--stereo", stereo, "Stereo mode of the window")
        ->check(CLI::IsMember(std::vector<std::string>(std::begin(kStereoModes), std::end(kStereoModes))));
    app.add_flag("--calibrate", options.calibrate,
                 "Start with the calibration of the screen; it is saved to --stage FILE");
    app.add_flag("--test-picture", options.test_picture,
                 "Start with the test picture, which checks the poses of screen, eyes and tool");
    app.add_flag("--swap-eyes", swap_eyes, "Swap the images of the two eyes");
    app.add_option("--stage-screenshot", options.stage_screenshot,
                   "Write a PNG of the stereo display at the end; with two windows NAME-left and NAME-right")
        ->type_name("FILE.png");
    if (const auto answered = manual::answer(app, "tact-gui", argc, argv)) {
        exit_code = *answered;
        return false;
    }
    try {
        app.parse(argc, argv);
        std::filesystem::path own_keys = key_file;
        if (const auto folder = config_folder(); key_file.empty() && !folder.empty())
            own_keys = folder / "keys.toml";
        std::error_code unreadable;
        if (!key_file.empty() || std::filesystem::exists(own_keys, unreadable))
            options.keys = KeyTable::read(read_typed_file(own_keys, kKeysFix), own_keys.string());
        if (list_keys) {
            std::fputs(options.keys.text().c_str(), stdout);
            exit_code = 0;
            return false;
        }
        // A calibration may create the file.
        if (!options.stage_file.empty() &&
            !(options.calibrate && !std::filesystem::exists(options.stage_file)))
            options.stage = read_stage_file(options.stage_file);
        if (!options.training.plan.empty()) static_cast<void>(read_training_plan(options.training.plan));
        if (!options.window_state_file.empty()) {
            options.window_state = read_window_state_file(options.window_state_file);
            options.traces = options.traces || options.window_state.traces;
            if (size_option->count() == 0) {
                options.width_px = options.window_state.width_px;
                options.height_px = options.window_state.height_px;
            }
        }
        if (!session_file.empty()) open_session(session_file, options);
        if (!stereo.empty()) static_cast<void>(read_stereo_mode(stereo, options.stage.mode));
        if (swap_eyes) options.stage.eyes.swapped = !options.stage.eyes.swapped;
    } catch (const CLI::ParseError& e) {
        exit_code = app.exit(e) == 0 ? 0 : 2;
        return false;
    } catch (const StartupError& e) {
        std::fprintf(stderr, "tact-gui: %s\n", e.what());
        exit_code = 2;
        return false;
    }
    return true;
}

}  // namespace tact
