// The visual process in one object; app.hpp describes a frame.
//
// app.cpp      the frame, the controller, panels, the published load
// app_scene    the scene shown, its levels, its bodies
// app_session  saves and continues sessions, also in a scene with more structures
// app_draw     the frame around the 3D view, and both eyes of a stage
// app_view     the 3D view: its resolution, and its full detail at rest
// app_picture  pictures of any size
// app_calibration  the screen of the stage during its calibration
// app_input    mouse and keys
// app_mouse    the mouse as a hand
// app_steer    SpaceMouse and gamepad, as hand or as camera
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gui/dashboard/trace_export.hpp"
#include "gui/input/gamepad.hpp"
#include "gui/input/space_mouse.hpp"
#include "gui/link/command_sender.hpp"
#include "gui/link/controller.hpp"
#include "gui/render/backdrop.hpp"
#include "gui/render/camera.hpp"
#include "gui/render/scene_view.hpp"
#include "gui/render/still_picture.hpp"
#include "gui/render/view_target.hpp"
#include "gui/stereo/calibration_controller.hpp"
#include "gui/stereo/picture_painter.hpp"
#include "gui/stereo/stage.hpp"
#include "gui/window/browser_controller.hpp"
#include "gui/window/frame_clock.hpp"
#include "gui/window/frame_report.hpp"
#include "gui/window/layout.hpp"
#include "gui/window/options.hpp"
#include "gui/window/panel_image.hpp"
#include "gui/window/run_recorder.hpp"
#include "gui/window/scene_extender.hpp"
#include "gui/window/scene_loader.hpp"
#include "gui/window/screenshots.hpp"
#include "gui/window/second_hand.hpp"
#include "gui/window/session_saver.hpp"
#include "gui/window/still_view.hpp"
#include "gui/window/systems.hpp"
#include "gui/window/timeline_sender.hpp"
#include "gui/window/tool_drag.hpp"
#include "gui/window/window.hpp"
namespace tact {

class GuiApp {
public:
    explicit GuiApp(const GuiOptions& options);
    int run();

private:
    // Views drawn before the gain of a lower resolution is measured: after the scene appeared, and from then on.
    static constexpr std::uint32_t kFirstMeasured = 24, kMeasuredEvery = 1024;
    struct ViewDetail {
        std::uint32_t pixels = 0, pixels_max = 0;
        std::uint32_t refined = 0;  // as LoadTopic::refined
    };
    void frame(Instant now, bool take_picture);
    void follow_controller(std::int64_t now_ns);
    void begin_replay();
    void follow_replay();
    void follow_recorder();
    void follow_past();
    void tell(const StatusText& what);
    void start_loading(const std::string& path);
    void follow_scene();
    void use_scene(std::unique_ptr<SceneStart> start);
    void home_view();
    void begin_as_left();
    [[nodiscard]] WindowState window_state() const;
    void keep_window_state() const;
    void follow_session();
    void follow_added_scene();
    void follow_taking_back();
    [[nodiscard]] Session present_session() const;
    [[nodiscard]] SystemContext context();
    [[nodiscard]] SceneSystem& system() { return *systems_[shown_]; }
    void handle_input();
    void perform(KeyAction what, std::size_t place);
    void apply_level();
    void draw_scene(std::int64_t now_ns);
    void draw_ground(const Window::Size& size);
    void begin_view(const ViewFrame& view);
    void draw_window_view(const ViewFrame& view, Instant now);
    void draw_view(const EyeView& eye, const ViewFrame& view);
    void draw_small_view(const EyeView& eye, const ViewFrame& view, double share);
    [[nodiscard]] std::optional<std::uint64_t> view_key(const EyeView& eye, const ViewFrame& view) const;
    [[nodiscard]] double whole_surface_s() const;  // to draw it at full detail, as measured
    [[nodiscard]] bool refining_is_quick() const;
    [[nodiscard]] static bool input_under_way();  // a button of the mouse is held
    [[nodiscard]] bool sorting_is_quick() const;
    void measure_resolution(const EyeView& eye, const ViewFrame& view);
    void save_picture(const ViewFrame& of_window);
    void draw_stage(ViewFrame view, std::int64_t now_ns);
    void open_calibration(bool check_alone);
    void follow_calibration(std::int64_t now_ns);
    void leave_calibration();
    void make_stage(const StageSettings& settings);
    void make_stage_or_mono(const StageSettings& settings);
    void draw_calibration(const ViewFrame& view, std::int64_t now_ns);
    void draw_panels();
    void watch(const Request& request);
    void report_mark();
    void mark_under_pointer();
    void click_view();
    [[nodiscard]] Sight sight_under_pointer() const;
    [[nodiscard]] DragView drag_view() const;
    void follow_tools();
    void take_tool(std::size_t hand, HeldBy by);
    void let_go_of_tool();
    void lead_or_let_go();
    [[nodiscard]] bool lead_by_mouse();
    void publish_mouse();
    void show_handles(ViewFrame& view) const;
    [[nodiscard]] bool may_lead() const { return drag_tools_[0].may || drag_tools_[1].may; }
    void follow_input();
    void adopt_input_roles();
    void steer_view(std::size_t device, const InputSample& sample, double frame_s);
    void steer_tool(std::size_t device, const InputSample& sample, double frame_s);
    [[nodiscard]] bool leads(std::size_t device) const;
    [[nodiscard]] std::size_t hand_for(std::size_t device) const;
    void hint_of_input();
    [[nodiscard]] std::array<InputChoice, kInputDevices> kept_input() const;
    void publish_load();
    void publish_frames();
    [[nodiscard]] double due_s() const;
    [[nodiscard]] static float to_px(const Window::Size& size) {
        return static_cast<float>(size.width_px) / static_cast<float>(std::max(size.width, 1));
    }

    const GuiOptions options_;
    OwnedRegion<GuiRegion> region_;
    Controller controller_;
    CommandSender commands_;
    TimelineSender timeline_{region_->timeline};
    Window window_;
    Theme theme_;
    FrameClock clock_;
    PanelState state_;
    const std::int64_t first_ns_ = to_ns(Monotonic::now());
    double fps_max_ = 60.0;
    Instant frame_at_{};  // this frame
    // OpenGL objects are destroyed before the window: members are destroyed in reverse order.
    PassClock passes_{PassClock::possible(window_.software())};
    Instant frames_published_{};
    std::unique_ptr<Stage> stage_;  // of the stereo display
    std::unique_ptr<PicturePainter> calibration_painter_;
    CalibrationController calibration_{options_.stage_file.empty() ? "stage.toml" : options_.stage_file};
    std::unique_ptr<Programs> programs_;
    PanelImage panel_image_;
    Backdrop backdrop_;           // of the 3D view, or of both eyes
    Backdrop stage_ground_;       // of the window, where the eyes are shown
    Layout layout_{};             // of the newest dashboard; the view keeps to it
    bool panels_due_ = true;      // this frame draws the dashboard
    bool layout_changes_ = true;  // the next frame draws it because its layout differs
    std::shared_ptr<const SceneContent> content_;
    std::unique_ptr<SceneView> view_;
    // One for each of system_rows(); they hold data in the view, so they are destroyed before it.
    std::vector<std::unique_ptr<SceneSystem>> systems_;
    std::size_t shown_ = 0;  // index in system_rows()
    // Keep the controller's newest values.
    double vertices_share_ = 1.0;              // of the vertices of all surfaces
    double resolution_share_ = 1.0;            // of the pixels of the 3D view
    std::uint64_t levels_applied_ = 0;         // sequence
    std::unique_ptr<ViewTarget> view_target_;  // created for the first view with fewer pixels
    StillView still_;
    ViewDetail detail_;  // of this frame
    std::uint32_t views_until_measured_ = kFirstMeasured;
    double resolution_saves_s_ = 0.0;  // per unit of the level; 0: nothing, or not measured
    BrowserController browser_{options_.scene_switch};
    // For the first scene shown.
    bool as_left_wanted_ = !options_.window_state_file.empty() || options_.session_opened.has_value();
    SessionSaver session_saver_{options_.session};
    SceneExtender scene_extender_;
    bool added_examined_ = false;  // whether this window continues with an added structure
    SecondHand second_hand_;
    ToolDrag drag_;
    std::array<DragTool, kMouseHands> drag_tools_{};
    std::optional<std::size_t> near_tool_;   // under the pointer
    bool camera_waits_ = false;              // the button that held a tool is still down
    std::optional<SpaceMouse> space_mouse_;  // while it is to do something
    GlfwGamepadPort gamepad_port_;           // after the window
    Gamepad gamepad_{gamepad_port_};
    std::array<RestGate, kInputDevices> input_gates_;
    std::array<InputSample, kInputDevices> input_samples_;  // of this frame
    std::array<int, kInputDevices> input_roles_{};          // of the last frame
    std::array<std::uint32_t, kInputDevices> input_buttons_{};
    std::array<std::optional<int>, kInputDevices> input_role_left_;  // before a run asked for a hand
    std::uint64_t roles_adopted_of_ = 0;                             // generation of a controller
    Instant input_at_{};
    std::int64_t marked_at_ns_ = std::numeric_limits<std::int64_t>::min() / 2;  // by an instructor
    RingCursor traces_place_;                                                   // in the trace ring
    TraceExport trace_export_;
    RunRecorder recorder_{options_.session};
    ViewOptions view_options_;
    Camera camera_;
    SceneLoader loader_;
    std::string next_scene_;  // requested while another one was being read
    Screenshots pictures_{options_.screenshot, options_.every_s, options_.stage_screenshot};
    Screenshots::View drawn_view_;
    bool screenshot_requested_ = false;
    bool sharp_ = false;  // this frame is saved: with all its rays
};

}  // namespace tact
