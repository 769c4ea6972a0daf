// The dashboard: what the panels show (plain data that the application fills) and what a person asked for.
//
// Layout   a column of panels on the left, a strip of plots below, the 3D view in the rest; nothing overlaps.
// Thread   frame thread, inside an ImGui frame.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "gui/panels/browser.hpp"
#include "gui/panels/calibration.hpp"
#include "gui/panels/counter_rate.hpp"
#include "gui/panels/keys.hpp"
#include "gui/panels/knob_changes.hpp"
#include "gui/panels/lateness_window.hpp"
#include "gui/panels/plot_series.hpp"
#include "gui/panels/scene_toggles.hpp"
#include "gui/panels/theme.hpp"
#include "gui/panels/traces.hpp"
#include "ipc/scene/fit/fit_metrics.hpp"
#include "ipc/topics/bodies.hpp"
#include "ipc/topics/command.hpp"
#include "ipc/topics/device.hpp"
#include "ipc/topics/frames.hpp"
#include "ipc/topics/head.hpp"
#include "ipc/topics/health.hpp"
#include "ipc/topics/levels.hpp"
#include "ipc/topics/load.hpp"

namespace tact {

// What a person clicked; the application turns it into a command of the controller.
struct Request {
    CommandKind kind = CommandKind::none;
    double value = 0.0;
    std::string text;
    std::uint32_t body = 0;  // id
    double second = 0.0;     // another number, where a command has one
};

// What a person asked to be done with the bodies that takes more than one command.
enum class FitAct : std::uint8_t { undo, redo, revert, accept, copy, refine, snapshot, restore, save };
struct FitRequest {
    FitAct act = FitAct::undo;
    std::uint32_t body = 0;  // id: copy, refine, revert
    std::string text;        // name of a snapshot
};

struct BodyState {
    std::uint32_t id = 0;
    std::string name;
    std::size_t atoms = 0;
    bool in_hand = false, fixed = false, hidden = false;
    ImU32 colour = colour::kText;
};

struct FittingState {
    std::vector<BodyState> bodies;
    std::uint32_t options = 0;  // DockingOption, as felt now
    bool building = false;      // the controller prepares another density
    bool refining = false, saving = false;
    bool can_undo = false, can_redo = false;
    std::size_t gestures = 0;  // that can be undone
    std::vector<std::string> snapshots;
    std::string said;  // what the last act did
    Grade said_grade = Grade::unknown;
};

struct SceneState {
    bool loaded = false;
    std::string status;  // "loading ...", or why there is none
    std::string title, file;
    double contour = 0.0, contour_sigma = 0.0, map_sigma = 0.0, resolution_m = 0.0;
    std::uint32_t vertices_max = 0;
    double mesh_error_m = 0.0;
    std::size_t bodies = 0, atoms = 0;
    std::array<std::uint32_t, 3> voxels{};                           // of a map, or of bone
    double voxel_m = 0.0;                                            // edge, of bone
    std::string warning;                                             // the controller runs another scene, ...
    bool surface = false;                                            // to touch: no map, no bodies
    bool bone = false;                                               // to drill: likewise
    float bone_shown = 1.0F;                                         // share of it that is in graphics memory
    [[nodiscard]] bool placed() const { return !surface && !bone; }  // there are bodies to place and to fit
};

// The surface as it is kept fine around the tool.
struct DetailState {
    bool possible = false;  // the scene has a forest
    bool felt = false;      // the controller keeps one (mode chr); else the window alone
    bool full = false;      // felt: within the radius all is as in the full mesh
    std::string error;
    // As it is; a person's choice is sent where it is felt, and comes back.
    int shape = 0;                          // bell, multiple frustum
    float width = 1.0F, error_far = 0.5F;   // in radii
    bool editing = false, changed = false;  // by a person, for the application to take
    double radius_m = 0.0;                  // model, as all lengths here
    std::uint32_t vertices = 0, triangles = 0, near_triangles = 0;
    double deviation_m = 0.0;
    double turn_s = 0.0, turn_predicted_s = 0.0;
    // Of the colours; 0: nothing is drawn.
    double finest_m = 0.0, coarsest_m = 0.0;
    std::array<ImU32, 32> colours{};  // from the finest to the coarsest
};

// What the metrics of a fit mean: ipc/scene/fit/fit_metrics.hpp.
struct FitState {
    bool known = false;
    std::string status;  // "computing", or why there is none
    FitMetrics all;      // of all bodies together
    std::size_t bodies = 0;
    std::uint32_t body_id = 0;  // of the one in the hand; 0: none
    FitMetrics body;
    double resolution_m = 0.0;
    bool resolution_assumed = false;
    bool pose_known = false;
    double from_file_m = 0.0, from_file_rad = 0.0;
};

// A tool that drills or sucks, in the hand's space.
struct ToolDescription {
    bool there = false;
    int shape = 0;  // ball, cylinder, cone
    double diameter_m = 0.0, length_m = 0.0;
    double rpm = 0.0;  // 0: it stands
    bool water = false, suction = false;
    double depth = 0.0;  // of its radius, in bone
};

struct DrillingState {
    struct Structure {
        std::string name;
        ImU32 colour = colour::kText;
        double burr_m = 0.0, closing_m_s = 0.0;  // below zero: in it
        double suction_tube_m = 1e9;
    };
    bool known = false, labelled = false;
    ToolDescription burr, suction_tube;
    double removed_m3 = 0.0, force_n = 0.0, drilling_s = 0.0, excess_s = 0.0;
    std::uint64_t strokes = 0, injuries = 0;
    double stroke_m = 0.0, stroke_m_s = 0.0;
    std::vector<Structure> structures;  // to keep away from, the nearest first
};

struct ContourRow {
    // What a person chose.
    double level = 0.0;  // in the map's unit
    float colour[3] = {1.0F, 1.0F, 1.0F};
    float opacity = 1.0F;
    int style = 0;  // as the view, glass, solid, wire
    bool shown = true;
    // What it means and how far it is.
    double sigma = 0.0, fraction_inside = 0.0;
    bool final = true;
    std::string error;
};

struct ContourRowState {
    static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
    std::vector<ContourRow> row;
    std::size_t rows_max = 1;
    std::vector<std::uint64_t> histogram;  // voxels, bins of equal width from least to greatest
    double least = 0.0, greatest = 0.0;    // of the map, in its unit
    bool changed = false, add = false;     // what a person did; for the application to take
    std::size_t dragged = kNone, removed = kNone;
};

struct EventLine {
    std::int64_t taken_at_ns = 0;
    std::uint16_t code = 0;
    std::uint64_t count = 1;  // how often in a row
    std::string text;         // of the newest of them
    Grade grade = Grade::unknown;
};

struct History {
    PlotSeries rate_hz, lateness_p50_s, lateness_p99_s, lateness_max_s, cycle_cost_s;
    PlotSeries frame_s, busy_s;
    std::array<PlotSeries, kPathsMax> level;
    KnobChanges knobs;
    double now_s = 0.0;
    std::int64_t first_ns = 0;  // the monotonic clock where now_s is 0
    [[nodiscard]] double at_s(std::int64_t ns) const { return 1e-9 * static_cast<double>(ns - first_ns); }
};

struct DashboardState {
    bool attached = false;
    std::string link_text;
    std::string session;
    bool have_health = false, have_levels = false;
    HealthTopic health{};
    LevelsTopic levels{};
    bool have_devices = false, have_tracker = false;
    DevicesTopic devices{};
    TrackerTopic tracker{};
    std::uint32_t recorders = 0, flights = 0;           // that record this run
    std::array<CounterRate, kDeviceHands> device_rate;  // samples a second
    CounterRate tracker_rate;
    LatenessWindow lateness;
    LoadTopic load{};
    FrameMetrics frames{};  // twice a second
    std::uint64_t refused_records = 0;
    std::string command_text;  // what became of the last command
    Grade command_grade = Grade::unknown;
    SceneState scene;
    FitState fit;
    FittingState fitting;
    ContourRowState contours;
    DetailState detail;
    DrillingState drilling;
    CalibrationCardState calibration;
    BrowserState browser;
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
    std::string renderer;
    std::string
        stage;  // of a stereo picture: how it is shown and what becomes of the head; empty: there is none
    bool head_lost = false;
    // What a person chose.
    SceneToggles toggles;
    int span_choice = 0;      // of the plots
    int strip = 0;            // 0: plots, 1: traces
    int lateness_choice = 0;  // a minute, the whole run, over time
    KeySituation situation;   // of the keys; its sheet is what a person opened
    int tab = 0;              // of the scene card
    // Emptied by the application.
    std::vector<Request> requests;
    std::vector<FitRequest> fit_requests;
    std::vector<std::pair<std::uint32_t, bool>> hide_requests;  // id, hidden
};

struct PixelRect {
    float x = 0, y = 0, width = 1, height = 1;  // y from above
};
// Where everything lies in a window of this size. The cards' ground is for the application to paint (one
// clear per card): ImGui fills areas through its font texture, which costs several milliseconds where the
// processor draws.
struct Layout {
    PixelRect view, health, middle, scene, plots, events;

    [[nodiscard]] std::array<PixelRect, 5> cards() const { return {health, middle, scene, plots, events}; }
};
// The card between the controller's and the scene's: of a fit, of drilling, or none, and its place goes to the scene.
// While a screen is calibrated, its card takes the whole column.
enum class MiddleCard : std::uint8_t { none, fit, drilling, calibration };
[[nodiscard]] MiddleCard middle_card(const DashboardState& state);
// traces: the strip below is as high as they need.
[[nodiscard]] Layout layout_for(const Theme& theme, float width_px, float height_px, MiddleCard middle,
                                bool traces = false);

// Draws everything but the 3D view and the cards' ground.
void draw_dashboard(const Theme& theme, DashboardState& state, float width_px, float height_px);

inline constexpr std::array<double, 5> kSpans_s{60.0, 600.0, 3600.0, 6.0 * 3600.0, 24.0 * 3600.0};

}  // namespace tact
