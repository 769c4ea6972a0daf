#include "gui/window/options.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <map>

#include "ipc/base/error.hpp"
#include "ipc/base/whole_numbers.hpp"
#include "ipc/manual/manual.hpp"
#include "ipc/version/version.hpp"

namespace tact {

bool parse_gui_options(int argc, const char* const* argv, GuiOptions& options, int& exit_code) {
    CLI::App app(
        "tact-gui: shows what the hand is touching. Starts without the controller and waits for it.");
    app.footer(
        "Exit codes: 0 the window was closed or the time was over; 1 error; 2 wrong usage, or an unusable "
        "file of settings.");
    app.set_version_flag("--version", program_version("tact-gui"));
    std::string size;
    app.add_option("scene", options.scene, "baked scene; by default the one that the controller runs");
    app.add_option("--session", options.session, "name of the session that the controller runs in")
        ->type_name("NAME")
        ->capture_default_str();
    app.add_option("--scene-switch", options.scene_switch,
                   "folder in which the launcher takes the request for another scene; tact gives it")
        ->check(CLI::ExistingDirectory);
    app.add_option("--seconds", options.seconds, "end after this many seconds; 0: when closed")
        ->check(CLI::Range(0.0, 1e7));
    app.add_option("--screenshot", options.screenshot, "write a PNG of the last picture at the end")
        ->type_name("FILE.png");
    app.add_option("--report", options.report,
                   "write a report of what was drilled as JSON at the end, where the scene is of bone")
        ->type_name("FILE.json");
    app.add_option("--frames", options.frames,
                   "write the times of frames and their passes as JSON at the end")
        ->type_name("FILE.json");
    app.add_option(
           "--picture-every", options.every_s,
           "with --screenshot NAME.png: also NAME-01.png and so on, of the view alone, so many seconds apart")
        ->check(CLI::Range(0.1, 1e5));
    app.add_option("--zoom", options.zoom, "factor by which the view is nearer at the start")
        ->check(CLI::Range(0.1, 20.0));
    app.add_option("--window-state", options.window_state_file,
                   "TOML file of what was set in the window: begin as it says, and write it at the end; it "
                   "need not exist")
        ->type_name("FILE.toml");
    CLI::Option* const size_option =
        app.add_option("--size", size, "size of the window in pixels, as 1280x720");
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
                   "letters and panels so many times as large as the display's size and density ask for")
        ->check(CLI::Range(0.5, 4.0));
    app.add_flag("--traces", options.traces,
                 "begin with the traces of every servo cycle in place of the plots");
    app.add_flag("--hidden", options.hidden, "draw without showing a window");
    app.add_flag("--plain", options.plain, "cheapest drawing: no gradient, solid surface");
    app.add_option(
           "--fps-max", options.fps_max,
           "at most this many pictures a second; 0: as many as can be; default: the display's rate, or 60")
        ->check(CLI::Range(0.0, 1e5));
    app.add_option("--molecule", options.look.style, "bodies as trace, tube, sticks or spheres")
        ->transform(CLI::CheckedTransformer(
            std::map<std::string, MoleculeStyle>{{"trace", MoleculeStyle::trace},
                                                 {"tube", MoleculeStyle::tube},
                                                 {"sticks", MoleculeStyle::sticks},
                                                 {"spheres", MoleculeStyle::spheres}}));
    app.add_option("--colour", options.look.colouring, "bodies by chain, element or body")
        ->transform(CLI::CheckedTransformer(std::map<std::string, Colouring>{
            {"chain", Colouring::chain}, {"element", Colouring::element}, {"body", Colouring::body}}));
    app.add_option(
           "--contour",
           "a surface as LEVEL[:RRGGBB][:OPACITY][:STYLE], up to four times: the level in the map's unit, "
           "with s in sigma, with % of the map's volume; styles glass, solid, wire")
        ->expected(1)
        ->take_all()  // repeated, as what follows may be the scene
        ->type_name("CONTOUR")
        ->each(
            [&options](const std::string& text) { options.contours.push_back(read_contour_option(text)); });
    app.add_flag("!--no-depth-cue", options.depth_cue, "do not fade what lies far behind");
    app.add_flag("--near-burr", options.near_burr,
                 "close view of the burr once it is in bone, as key F does");
    app.add_option("--particles", options.particles,
                   "keep this many particles over bone, to measure what they cost")
        ->check(CLI::Range(0, 100000));
    app.add_flag("--bench-particles", options.bench_particles,
                 "measure what moving particles costs, print it as JSON and end; opens no window");
    std::string stereo;
    bool swap_eyes = false;
    app.add_option("--stage", options.stage_file,
                   "TOML file of the stereo picture: screen, eyes, monitors (gui/stereo/README.md)")
        ->type_name("FILE.toml");
    app.add_option("--stereo", stereo, "stereo mode of the window")
        ->check(CLI::IsMember(std::vector<std::string>(std::begin(kStereoModes), std::end(kStereoModes))));
    app.add_flag("--calibrate", options.calibrate,
                 "begin with the calibration of the screen, as key K does; it is saved to --stage FILE");
    app.add_flag("--test-picture", options.test_picture,
                 "begin with the picture that tells whether screen, eyes and tool are where they should be");
    app.add_flag("--swap-eyes", swap_eyes, "swap the pictures of the two eyes");
    app.add_option("--stage-screenshot", options.stage_screenshot,
                   "write a PNG of the stereo picture at the end; of two windows two: NAME-left, NAME-right")
        ->type_name("FILE.png");
    if (const auto answered = manual::answer(app, "tact-gui", argc, argv)) {
        exit_code = *answered;
        return false;
    }
    try {
        app.parse(argc, argv);
        // A calibration may make the file.
        if (!options.stage_file.empty() &&
            !(options.calibrate && !std::filesystem::exists(options.stage_file)))
            options.stage = read_stage_file(options.stage_file);
        if (!options.window_state_file.empty()) {
            options.window_state = read_window_state_file(options.window_state_file);
            options.traces = options.traces || options.window_state.traces;
            if (size_option->count() == 0) {
                options.width_px = options.window_state.width_px;
                options.height_px = options.window_state.height_px;
            }
        }
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
