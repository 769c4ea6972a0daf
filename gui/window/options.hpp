// The command line of tact-gui.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gui/docking/contour_option.hpp"
#include "gui/render/looks.hpp"
#include "gui/stereo/stage_file.hpp"
#include "gui/window/window_state.hpp"

namespace tact {

struct GuiOptions {
    std::string scene;  // empty: the controller's
    std::string session = "default";
    std::string
        window_state_file;     // settings of the window: read at the start, written at the end; empty: none
    WindowState window_state;  // as it was read
    std::string
        scene_switch;        // the launcher's folder, where it takes requests for another scene; empty: none
    std::string screenshot;  // empty: none
    std::string report;      // of drilling, JSON, at the end; empty: none
    std::string frames;      // what frames took, JSON, at the end; empty: none
    double every_s = 0.0;    // between pictures of a series beside the screenshot; 0: none
    double seconds = 0.0;    // 0: until closed
    double zoom = 1.0;       // of the home view
    int width_px = 1280, height_px = 720;
    float ui_scale = 1.0F;  // of letters and panels
    bool traces = false;    // in the place of the plots, at the start
    bool hidden = false;
    bool plain = false;
    StageSettings stage;     // of a stereo picture
    std::string stage_file;  // that it was read from, and that a calibration is written to
    bool calibrate = false, test_picture = false;  // at the start
    std::string stage_screenshot;                  // PNG of the stereo picture at the end; empty: none
    MoleculeLook look;                             // of all bodies at the start
    std::vector<ContourOption> contours;           // empty: the scene's own
    bool depth_cue = true;
    bool near_burr = false;        // once it is in bone
    std::uint32_t particles = 0;   // that there always are over bone
    bool bench_particles = false;  // instead of a window
    double fps_max = -1.0;         // 0: no limit; below: 60 where the display does not pace
};

// Prints help and errors itself. Returns false where the program is to end with `exit_code`.
bool parse_gui_options(int argc, const char* const* argv, GuiOptions& options, int& exit_code);

}  // namespace tact
