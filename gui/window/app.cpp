#include "gui/window/app.hpp"

#include <imgui.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "gui/dashboard/drawn_texts.hpp"
#include "gui/window/app_parts.hpp"
#include "gui/window/show_controller.hpp"
#include "gui/window/stop_signal.hpp"
#include "ipc/base/units.hpp"
#include "ipc/base/whole_file.hpp"

namespace tact {
GuiApp::GuiApp(const GuiOptions& options)
    : options_(options),
      controller_(options.session, options.watch ? -1 : region_.fd()),
      commands_(region_->commands),
      window_(options.width_px, options.height_px, options.hidden, options.ui_scale) {
    for (const SystemRow& row : system_rows()) systems_.push_back(row.make(options_));
    region_.mark_ready();
    state_.session = options.session;
    state_.watching = options.watch;
    state_.history.first_ns = first_ns_;
    state_.strip = options.traces ? 1 : 0;
    state_.renderer = window_.renderer();
    if (options.plain) {
        state_.toggles.style = static_cast<int>(SurfaceStyle::solid);
        state_.toggles.shading = false;
    }
    if (as_left_wanted_) {
        state_.toggles = options.window_state.toggles;
        state_.toggles.style = SceneToggles{}.style;  // of the scene
        state_.span_choice = options.window_state.span_choice;
        state_.input.choice = options.window_state.input;
        state_.lateness_choice = options.window_state.lateness_choice;
    }
    state_.toggles.smooth_edges = !window_.software();
    if (!options.depth_cue) state_.toggles.depth_cue = false;
    state_.keys = options.keys;
    fps_max_ = options.fps_max >= 0.0 ? options.fps_max : (window_.paced_by_display() ? 0.0 : 60.0);
    if (options.stage.mode != StereoMode::off) make_stage_or_mono(options.stage);
    if (!options.scene.empty())
        start_loading(options.scene);
    else
        state_.scene.status = "No scene yet: start a controller, or give a scene as an argument.";
    if (options.calibrate || options.test_picture) open_calibration(options.test_picture);
    spdlog::info("renderer: {}{}", window_.renderer(), options.hidden ? ", hidden" : "");
}

SystemContext GuiApp::context() {
    return {controller_, commands_,          state_,
            camera_,     window_.software(), theme_.scale * to_px(window_.size())};
}

int GuiApp::run() {
    const Instant begun = Monotonic::now();
    for (bool last = false; !last;) {
        const Instant now = Monotonic::now();
        // A screenshot must show the scene, so the run does not end before the scene is loaded.
        const bool screenshot_pending = pictures_.wanted_at_end() && loader_.running();
        last = stop_signal() != 0 || window_.close_wanted() || (stage_ && stage_->close_wanted()) ||
               (options_.seconds > 0.0 && to_s(now - begun) >= options_.seconds && !screenshot_pending);
        frame(now, last && pictures_.wanted_at_end());
        if (!last) clock_.pace(fps_max_);
    }
    recorder_.finish();
    keep_window_state();
    for (const auto& system : systems_) system->finish(context());
    write_frame_report(options_.frames, frame_metrics(clock_, passes_));
    if (stop_signal() != 0) spdlog::info("ended by signal {}", stop_signal());
    return pictures_.failed() ? 1 : 0;
}

void GuiApp::frame(Instant now, bool take_picture) {
    clock_.begin(due_s());
    passes_.begin_frame();
    const bool input = window_.take_input();
    const bool of_series = pictures_.series_due(now, view_ != nullptr);
    sharp_ = of_series || take_picture || state_.picture.save_wanted;
    panels_due_ = panel_image_.due(now, input || take_picture || screenshot_requested_ || layout_changes_);
    if (panels_due_) window_.begin_panels(theme_);
    window_.bind();
    frame_at_ = now;
    const std::int64_t now_ns = controller_.time_ns(to_ns(now));
    state_.now_ns = now_ns;
    state_.history.now_s = 1e-9 * static_cast<double>(now_ns - first_ns_);
    follow_controller(now_ns);
    follow_scene();
    if (const auto dropped = window_.take_dropped(); !dropped.empty()) browser_.drop(dropped, state_.browser);
    browser_.follow(state_.browser);
    follow_session();
    system().follow(context());
    follow_tools();
    if (panels_due_) handle_input();
    follow_input();
    publish_mouse();
    {
        const PassClock::Scope scope(&passes_, Pass::adapt);
        system().adapt();
        follow_calibration(now_ns);
        apply_level();
        clock_.end_part(FramePart::adapt);
        if (view_) view_->upload();
        clock_.end_part(FramePart::upload);
    }
    if (content_) {
        const PassClock::Scope scope(&passes_, Pass::motion);
        system().move(controller_.time_rate() * clock_.frame_s(),
                      content_->centre_model_m + kAngstromM * camera_.eye_a().cast<double>(), context());
    }
    clock_.end_part(FramePart::particles);
    draw_scene(now_ns);
    if (of_series) pictures_.save_of_series(window_.picture(), drawn_view_);
    clock_.end_part(FramePart::scene);
    draw_panels();
    clock_.end_part(FramePart::panels);
    if (take_picture) {
        pictures_.save_at_end(window_.picture());
        if (!stage_)
            pictures_.save_stage({});
        else if (view_ || calibration_.open())
            pictures_.save_stage(stage_->pictures());
    }
    if (panels_due_ && std::exchange(screenshot_requested_, false)) pictures_.save_now(window_.picture());
    {
        const PassClock::Scope scope(&passes_, Pass::swap);
        window_.show();
    }
    passes_.end_frame(detail_.refined == 0);
    clock_.end_part(FramePart::swap);
    if (view_) system().ended(clock_.work_s());
    publish_load();
    publish_frames();
}

void GuiApp::follow_controller(std::int64_t now_ns) {
    const Controller::News news = controller_.poll();
    if (news.left) {
        // A replay that goes back is another one.
        if (!state_.replay.shown)
            spdlog::warn("the controller of session {} ended; waiting for the next", options_.session);
        commands_.forget();
        for (const auto& system : systems_) system->detach();
    }
    if (news.arrived) {
        for (const auto& system : systems_) system->attach(context());
        if (!state_.replay.shown) spdlog::info("attached to the controller of session {}", options_.session);
        second_hand_.forget();
        commands_.forget();
        forget_rates(state_);
        traces_place_ = {};
        std::string path = controller_.scene_path();
        if (options_.scene.empty() && !path.empty() &&
            (!content_ || content_->checksum != controller_.scene_checksum()))
            start_loading(path);
    }
    const Controller::Fresh fresh = controller_.read();
    if (news.arrived && controller_.replays()) begin_replay();
    system().read(fresh, context());
    if (fresh.second) second_hand_.follow(controller_.second);
    if (fresh.mark) {
        marked_at_ns_ = now_ns;
        report_mark();
    }
    if (fresh.health) add_health(controller_.health, state_.history);
    add_rates(controller_, fresh, state_);
    add_cycles(controller_, traces_place_, state_);
    trace_export_.follow(state_.traces);
    if (controller_.have_health && !controller_.watches()) commands_.update(controller_.health, now_ns);
    show_controller(controller_, commands_, state_);
    follow_replay();
    follow_recorder();
    follow_past();
}

// All times are those of the run that was recorded, and its events come again.
void GuiApp::begin_replay() {
    forget_run(state_);
    const ReplayTopic& replay = controller_.replay;
    state_.now_ns = controller_.time_ns(to_ns(frame_at_));
    state_.history.first_ns = replay.shown_ns - std::llround(1e9 * replay.at_s);
    state_.history.now_s = state_.history.at_s(state_.now_ns);
    window_.set_title(std::string("Tact: replay of ") + replay.name);
}

void GuiApp::follow_replay() {
    ReplayState& replay = state_.replay;
    replay.shown = controller_.replays();
    commands_.close(replay.shown ? "nothing is sent in a replay" : "");
    if (!replay.shown) return replay.requests.clear();
    replay.now = controller_.replay;
    replay.marks = controller_.replay_marks;
    for (const TimelineRequest& request : replay.requests)
        timeline_.send(request, replay.now, to_ns(frame_at_));
    replay.requests.clear();
}

void GuiApp::draw_panels() {
    const PassClock::Scope scope(&passes_, Pass::dashboard);
    const Window::Size size = window_.size();
    glViewport(0, 0, size.width_px, size.height_px);
    if (!panels_due_) return panel_image_.draw_over();
    const ImGuiIO& io = ImGui::GetIO();
    draw_dashboard(theme_, state_, system().panels(), io.DisplaySize.x, io.DisplaySize.y);
    ImGui::Render();
    panel_image_.draw(*ImGui::GetDrawData(), layout_, to_px(size), size.width_px, size.height_px);
    if (!options_.texts.empty())
        write_whole_file(options_.texts, texts_json(drawn_texts(*ImGui::GetDrawData())));
    for (const Request& request : state_.requests)
        if (controller_.watches())
            watch(request);
        else if (!commands_.send({request.kind,
                                  request.value,
                                  request.text,
                                  request.body,
                                  {Vec3(request.second, 0.0, 0.0), Quat::Identity()}},
                                 state_.now_ns))
            spdlog::warn("a command was not sent: its text is too long");
    state_.requests.clear();
}

// An instructor's window: the run is changed by its own.
void GuiApp::watch(const Request& request) {
    state_.command_grade = Grade::watch;
    if (request.kind == CommandKind::disarm) {
        state_.command_text = controller_.stop_run() ? "disarm: sent" : "disarm: not sent";
    } else {
        state_.command_text = "watching: only Disarm and marks";
    }
}

void GuiApp::publish_load() {
    LoadTopic load{};
    load.taken_at_ns = to_ns(Monotonic::now());
    load.frame = clock_.frame();
    load.levels_sequence = controller_.have_levels ? controller_.levels.sequence : 0;
    load.frame_s = clock_.frame_s();
    load.busy_s = clock_.work_s() - (window_.paced_by_display() ? clock_.part_s(FramePart::swap) : 0.0);
    for (std::size_t i = 0; i < static_cast<std::size_t>(FramePart::count); ++i)
        load.part_s[i] = clock_.part_s(static_cast<FramePart>(i));
    load.cpu_s = FrameClock::process_cpu_s();
    load.fps = clock_.fps();
    const bool drawn = view_ && state_.toggles.surface;
    load.vertices_drawn = drawn ? view_->vertices() : 0;
    load.triangles_drawn = drawn ? view_->triangles() : 0;
    load.vertices_max = view_ ? view_->vertices_max() : 0;
    if (view_) system().add_to(load);
    for (std::size_t i = 0; i < kVisualPaths; ++i)
        load.path_s[i] = passes_.path_s(static_cast<VisualPathIndex>(i));
    load.path_s[static_cast<std::size_t>(VisualPathIndex::resolution)] = resolution_saves_s_;
    load.pixels = detail_.pixels;
    load.pixels_max = detail_.pixels_max;
    load.refined = detail_.refined;
    region_->load.publish(load);
    state_.load = load;
    const bool levels = controller_.have_levels && controller_.attached();
    add_load(load, levels ? &controller_.levels : nullptr, state_.history);
}

void GuiApp::publish_frames() {
    constexpr auto kEvery = std::chrono::milliseconds(500);
    const Instant now = Monotonic::now();
    if (now - frames_published_ < kEvery) return;
    frames_published_ = now;
    FramesTopic topic{};
    topic.taken_at_ns = to_ns(now);
    topic.metrics = state_.frames = frame_metrics(clock_, passes_);
    region_->frames.publish(topic);
}

// The longest of the display's period, that of the maximum frame rate, and that of the governor's goal.
double GuiApp::due_s() const {
    double due = window_.paced_by_display() ? window_.display_period_s() : 0.0;
    if (fps_max_ > 0.0) due = std::max(due, 1.0 / fps_max_);
    const double goal_hz = controller_.attached() && controller_.have_levels
                               ? static_cast<double>(controller_.levels.display_goal_hz)
                               : 0.0;
    return goal_hz > 0.0 ? std::max(due, 1.0 / goal_hz) : due;
}

int run_gui(const GuiOptions& options) {
    catch_stop_signals();
    return GuiApp(options).run();
}

}  // namespace tact
