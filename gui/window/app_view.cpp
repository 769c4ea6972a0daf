#include <imgui.h>

#include <algorithm>
#include <iterator>

#include "gui/window/app_parts.hpp"

namespace tact {
namespace {

// A resting view whose full detail takes longer is not refined: the user may begin to move it meanwhile.
constexpr double kRefineMost_s = 0.25;
// Sorted glass takes so many times the time of the surface in software rendering (tests/bench/draw_bench).
constexpr double kSortedTakes = 16.0;
// The lowest level of gui.resolution: half of the pixels along each axis.
constexpr double kSmallest = 0.25;
// A lower resolution must save at least this part of a view's time: less is not worth the blur, and within what a measurement is off.
constexpr double kWorthSaving = 0.25;

}  // namespace

// Moving, the view is drawn at the levels; resting, once in full detail, and then copied.
void GuiApp::draw_window_view(const ViewFrame& view, Instant now) {
    const EyeView eye = camera_.eye(static_cast<float>(view.width_px) / static_cast<float>(view.height_px));
    // On a graphics card full detail takes no time that a person could notice.
    const bool busy = window_.software() && input_under_way();
    const auto step = sharp_ ? StillView::Step::at_levels : still_.next(view_key(eye, view), now, busy);
    if (step == StillView::Step::copy) {
        const PassClock::Scope scope(&passes_, Pass::ground);
        still_.show(view.x_px, view.y_px);
        detail_.pixels = detail_.pixels_max = ViewSize{view.width_px, view.height_px}.pixels();
        detail_.refined = 1;
        return;
    }
    if (step == StillView::Step::refine && refining_is_quick()) {
        system().refine();
        view_->contours().set_refined(true);
        detail_.refined = 1;
        view_options_.shaded = state_.toggles.shading;
        view_options_.light_by_pixel = true;
        view_options_.glass_layers = sorting_is_quick() ? glass_layers(window_.software()) : 0;
        draw_view(eye, view);
        view_->contours().set_refined(false);
        still_.keep(view.x_px, view.y_px, view.width_px, view.height_px);
        return;
    }
    if (views_until_measured_ > 0) --views_until_measured_;
    if (views_until_measured_ == 0 && controller_.level(kResolutionPath) != nullptr)
        measure_resolution(eye, view);
    draw_view(eye, view);
}

bool GuiApp::input_under_way() {
    const ImGuiIO& io = ImGui::GetIO();
    return std::any_of(std::begin(io.MouseDown), std::end(io.MouseDown), [](bool down) { return down; });
}

void GuiApp::draw_view(const EyeView& eye, const ViewFrame& view) {
    const double share = sharp_ || detail_.refined == 1 ? 1.0 : resolution_share_;
    const ViewSize most{view.width_px, view.height_px},
        size = ViewSize::of_share(view.width_px, view.height_px, share);
    detail_.pixels += size.pixels();
    detail_.pixels_max += most.pixels();
    if (size.pixels() < most.pixels()) return draw_small_view(eye, view, share);
    begin_view(view);
    view_->draw(eye, view_options_, view);
}

void GuiApp::draw_small_view(const EyeView& eye, const ViewFrame& view, double share) {
    GLint bound = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
    if (!view_target_) view_target_ = std::make_unique<ViewTarget>();
    const ViewSize size = ViewSize::of_share(view.width_px, view.height_px, share);
    ViewFrame small = view;
    small.x_px = small.y_px = 0;
    small.width_px = size.width_px;
    small.height_px = size.height_px;
    view_target_->begin(size, {view.width_px, view.height_px});
    begin_view(small);
    view_->draw(eye, view_options_, small);
    const PassClock::Scope scope(view.passes, Pass::enlarge);
    view_target_->show(static_cast<GLuint>(bound), view.x_px, view.y_px, view.width_px, view.height_px);
}

// The time that a lower resolution saves, enlarging included, cannot be told from the passes: triangles cost the same at any. So the view
// is drawn both ways, and once more for the user.
void GuiApp::measure_resolution(const EyeView& eye, const ViewFrame& view) {
    views_until_measured_ = kMeasuredEvery;
    detail_.refined = 2;
    ViewFrame untimed = view;
    untimed.passes = nullptr;
    glFinish();
    const Instant begun = Monotonic::now();
    draw_small_view(eye, untimed, kSmallest);
    glFinish();
    const Instant small = Monotonic::now();
    begin_view(untimed);
    view_->draw(eye, view_options_, untimed);
    glFinish();
    const double full_s = to_s(Monotonic::now() - small), saved_s = full_s - to_s(small - begun);
    resolution_saves_s_ = saved_s > kWorthSaving * full_s ? saved_s / (1.0 - kSmallest) : 0.0;
    glClear(GL_DEPTH_BUFFER_BIT);
}

double GuiApp::whole_surface_s() const {
    const double drawn = std::max<double>(view_->vertices(), 1.0);
    return passes_.path_s(VisualPathIndex::mesh) * view_->vertices_max() / drawn;
}

bool GuiApp::refining_is_quick() const { return whole_surface_s() < kRefineMost_s; }

bool GuiApp::sorting_is_quick() const {
    return !window_.software() || kSortedTakes * whole_surface_s() < kRefineMost_s;
}

std::optional<std::uint64_t> GuiApp::view_key(const EyeView& eye, const ViewFrame& view) const {
    ContentKey key;
    key.add(content_->checksum);
    for (const Eigen::Matrix4f& m : {eye.eye_from_scene, eye.projection})
        for (int i = 0; i < 16; ++i) key.add(m.data()[i]);
    for (const int px : {view.x_px, view.y_px, view.width_px, view.height_px}) key.add(px);
    const ViewOptions& o = view_options_;
    for (const bool on : {o.surface, o.force, o.box, o.depth_cue, o.smooth_edges, o.gradient,
                          state_.toggles.shading, o.cut_a.has_value()})
        key.add(on);
    if (o.cut_a) key.add(*o.cut_a);
    for (int i = 0; i < 3; ++i) key.add(o.plain_ground[i]);
    key.add(o.style);
    const auto force = [&key](const Vec3& n) {
        for (int i = 0; i < 3; ++i) key.add_rounded(n[i], 1e-3);
    };
    if (o.force && view.force_at_model_m) {
        force(view.force_world_n);
        key.add(Pose{*view.force_at_model_m, Quat::Identity()});
    }
    key.add(view.hand.has_value());
    if (view.hand) {
        key.add(view.hand->T_model_hand);
        key.add(view.hand->at_wall);
        force(view.hand->force_world_n);
    }
    for (const auto& handle : view.handle) {
        key.add(handle.has_value());
        if (!handle) continue;
        key.add(handle->state);
        key.add(Pose{handle->at_model_m, Quat::Identity()});
        key.add(Pose{handle->target_model_m, Quat::Identity()});
    }
    view_->contours().add_to(key);
    if (!systems_[shown_]->add_to_key(key)) return std::nullopt;
    return key.value();
}

}  // namespace tact
