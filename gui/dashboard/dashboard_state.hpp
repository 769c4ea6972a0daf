// Data of the dashboard: the state that the panels of every system show, filled by the window, and the user's
// requests.
//
// Thread   frame thread, inside an ImGui frame.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "gui/dashboard/counter_rate.hpp"
#include "gui/dashboard/knob_changes.hpp"
#include "gui/dashboard/lateness_window.hpp"
#include "gui/dashboard/plot_series.hpp"
#include "gui/dashboard/scene_toggles.hpp"
#include "gui/dashboard/theme.hpp"
#include "gui/dashboard/timeline.hpp"
#include "gui/dashboard/traces.hpp"
#include "ipc/topics/command.hpp"
#include "ipc/topics/device.hpp"
#include "ipc/topics/frames.hpp"
#include "ipc/topics/head.hpp"
#include "ipc/topics/health.hpp"
#include "ipc/topics/levels.hpp"
#include "ipc/topics/load.hpp"

namespace tact {

// A request of the user; the application turns it into a command to the controller.
struct Request {
    CommandKind kind = CommandKind::none;
    double value = 0.0;
    std::string text;
    std::uint32_t body = 0;  // id
    double second = 0.0;     // second value, if the command has one
};

struct SceneState {
    bool loaded = false;
    std::string status;  // "loading ...", or why no scene is loaded
    std::string title, file;
    std::uint32_t vertices_max = 0;
    double mesh_error_m = 0.0;
    std::string warning;         // for example: the controller runs another scene
    bool patient = false;        // it is known how the scene lies in the patient
    float patient_axes[3][3]{};  // the patient's left, back and head, in the scene's axes
};

// The mouse as a hand, or a SpaceMouse or gamepad.
struct MouseHint {
    static constexpr int kMouse = -1;
    bool may = false;            // it may lead a tool
    bool near = false;           // the pointer is over one
    bool holds = false;          // it leads one
    bool by_key = false;         // without a button
    int device = kMouse;         // that leads it: kMouse, or the number in kInputNames
    bool gone = false;           // that device is unplugged: the target stays
    std::string waits;           // for a device that is chosen as hand: what to do; "": nothing
    bool waits_in_vain = false;  // the device is missing
    bool drives = false;         // the second button of the stylus is pressed
    bool bone = false;           // which runs a burr
    bool silent = false;         // the controller received nothing for a while
    bool taken = false;          // at least once
    bool label = false;          // the first tool is shown there, below its ring
    float label_x = 0.0F, label_y = 0.0F;
};

// A structure was added to the scene that is shown, or taken back: undo and redo reach beyond the gestures.
struct AddedStructure {
    bool can_take_back = false, can_add_again = false;
    bool take_back_wanted = false, add_again_wanted = false;  // emptied by the window
};

struct EventLine {
    std::int64_t taken_at_ns = 0;
    std::uint16_t code = 0;
    std::uint64_t count = 1;  // in a row
    std::string text;         // of the newest one
    Grade grade = Grade::unknown;
};

struct History {
    PlotSeries rate_hz, lateness_p50_s, lateness_p99_s, lateness_max_s, cycle_cost_s;
    PlotSeries frame_s, busy_s;
    std::array<PlotSeries, kPathsMax> level;
    KnobChanges knobs;
    double now_s = 0.0;
    std::int64_t first_ns = 0;  // monotonic clock at now_s = 0
    [[nodiscard]] double at_s(std::int64_t ns) const { return 1e-9 * static_cast<double>(ns - first_ns); }
};

struct DashboardState {
    bool attached = false;
    bool watching = false;  // an instructor's window: it changes nothing
    ReplayState replay;
    PastState past;
    // What the user asks for reaches a running controller.
    [[nodiscard]] bool commands() const { return attached && !watching && !replay.shown; }
    std::string link_text;
    std::string session;
    bool have_health = false, have_levels = false;
    HealthTopic health{};
    LevelsTopic levels{};
    bool have_devices = false, have_tracker = false;
    DevicesTopic devices{};
    TrackerTopic tracker{};
    std::uint32_t recorders = 0, flights = 0;           // recorders of this run
    bool own_recording = false;                         // one of them was started here
    bool record_wanted = false;                         // the user starts it, or ends it
    std::array<CounterRate, kDeviceHands> device_rate;  // samples per second
    CounterRate tracker_rate;
    LatenessWindow lateness;
    LoadTopic load{};
    FrameMetrics frames{};  // updated twice a second
    std::uint64_t refused_records = 0;
    std::string command_text;  // result of the last command
    Grade command_grade = Grade::unknown;
    SceneState scene;
    History history;
    TracesState traces;
    std::deque<EventLine> events;  // newest first
    std::uint64_t events_missed = 0;
    std::int64_t now_ns = 0;
    // The 3D view's overlay.
    double a_per_px = 0.0;
    float eye_axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // scene x, y, z in the eye's axes
    double force_n = 0.0;
    bool second_hand = false, second_at_wall = false;
    double second_force_n = 0.0;
    double arrow_a_per_n = 0.0;
    MouseHint mouse;
    AddedStructure added;
    std::string renderer;
    std::string stage;          // of a stereo display: mode and head tracking; empty: none
    std::string stage_refused;  // why there is none although it was asked for, and what to do
    bool head_lost = false;
    // The user's choices.
    SceneToggles toggles;
    int span_choice = 0;      // of the plots
    int strip = 0;            // 0: plots, 1: traces
    int lateness_choice = 0;  // a minute, the whole run, over time
    int tab = 0;              // of the scene card
    int events_choice = 0;    // all, warnings and faults, faults
    // Emptied by the application.
    std::vector<Request> requests;
};

inline constexpr std::array<double, 5> kSpans_s{60.0, 600.0, 3600.0, 6.0 * 3600.0, 24.0 * 3600.0};

}  // namespace tact
