// The command line of tact-gui.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gui/docking/contour_option.hpp"
#include "gui/drilling/training/training.hpp"
#include "gui/render/looks.hpp"
#include "gui/stereo/stage_file.hpp"
#include "gui/system/keys.hpp"
#include "gui/window/window_state.hpp"
#include "ipc/scene/session/session_file.hpp"

namespace tact {

struct GuiOptions {
    std::string scene;  // empty: the controller's
    std::string session = "default";
    std::string
        window_state_file;     // settings of the window: read at the start, written at the end; empty: none
    WindowState window_state;  // as read, or that of the session
    std::optional<Session> session_opened;  // continues in this window
    std::string session_file;               // of it
    KeyTable keys;                          // with the person's own
    std::string scene_switch;  // the launcher's folder for requests of another scene; empty: none
    std::string screenshot;    // empty: none
    std::string report;        // drilling report, JSON, at the end; empty: none
    std::string texts;         // the texts on the window, JSON, while it runs; empty: none
    std::string frames;        // frame times, JSON, at the end; empty: none
    double every_s = 0.0;      // interval of a screenshot series; 0: none
    double seconds = 0.0;      // 0: until closed
    double zoom = 1.0;         // of the home view
    int width_px = 1280, height_px = 720;
    float ui_scale = 1.0F;  // of text and panels
    bool traces = false;    // in place of the plots, at the start
    bool hidden = false;
    bool plain = false;
    bool start_page = false;                       // demos and recent scenes instead of a scene
    StageSettings stage;                           // of the stereo display
    std::string stage_file;                        // its file, which a calibration writes
    bool calibrate = false, test_picture = false;  // at the start
    std::string stage_screenshot;                  // PNG of the stereo display at the end; empty: none
    MoleculeLook look;                             // of all bodies at the start
    std::vector<ContourOption> contours;           // empty: the scene's own
    bool depth_cue = true;
    bool mute = false;             // no sound
    bool watch = false;            // an instructor's window
    TrainingOptions training;      // of a drilling scene
    bool near_burr = false;        // close view once it is in bone
    std::uint32_t particles = 0;   // constant number over bone
    bool bench_particles = false;  // instead of a window
    double fps_max = -1.0;         // 0: no limit; below: 60 unless the display paces
};

// Prints help and errors itself. Returns false if the program must end with `exit_code`.
bool parse_gui_options(int argc, const char* const* argv, GuiOptions& options, int& exit_code);

}  // namespace tact
