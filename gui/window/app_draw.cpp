#include <spdlog/spdlog.h>

#include <algorithm>

#include "gui/window/app_parts.hpp"
#include "gui/window/grounds.hpp"

namespace tact {
namespace {
constexpr std::int64_t kMarkShownNs = 20'000'000'000;
}  // namespace

void GuiApp::draw_scene(std::int64_t now_ns) {
    const Window::Size size = window_.size();
    const Layout layout = layout_for(theme_, static_cast<float>(size.width), static_cast<float>(size.height),
                                     middle_card(state_, system().panels()), strip_of(state_));
    if (panels_due_) layout_ = layout;
    layout_changes_ = !(layout == layout_);
    const PixelRect& rect = layout_.view;
    ViewFrame view{};
    view.x_px = static_cast<int>(rect.x * to_px(size));
    view.width_px = std::max(size.width_px - view.x_px, 1);
    view.height_px = std::max(static_cast<int>(rect.height * to_px(size)), 1);
    view.y_px = size.height_px - view.height_px;
    draw_ground(size);
    view.passes = &passes_;
    if (!programs_) programs_ = std::make_unique<Programs>();
    detail_ = {};
    if (!view_) {
        begin_view(view);
    } else if (stage_) {
        const PassClock::Scope scope(&passes_, Pass::ground);
        const ImVec4 c = ImGui::ColorConvertU32ToFloat4(colour::kGround);
        stage_ground_.show(*programs_, Eigen::Vector3f(c.x, c.y, c.z), view.x_px, view.y_px, view.width_px,
                           view.height_px);
    }
    state_.a_per_px = static_cast<double>(camera_.a_per_px(rect.height));
    const Eigen::Matrix3f axes = camera_.orientation().toRotationMatrix();
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) state_.eye_axes[i][k] = axes(k, i);
    drawn_view_ = {view.x_px, view.y_px, view.width_px, view.height_px};
    if (calibration_.open()) return draw_calibration(view, now_ns);
    if (!view_) return;
    if (controller_.attached() && controller_.have_tool) {
        const double* const f = controller_.tool.force_model_n;
        view.force_world_n = Vec3(f[0], f[1], f[2]);
    }
    if (controller_.attached() && system().second_hand_is_pen())
        view.hand = second_hand_.at(now_ns, content_->meta);
    state_.second_hand = view.hand.has_value();
    if (controller_.attached() && controller_.have_mark && now_ns - marked_at_ns_ < kMarkShownNs)
        view.mark_at_model_m = Vec3(controller_.mark.pos_model_m[0], controller_.mark.pos_model_m[1],
                                    controller_.mark.pos_model_m[2]);
    system().prepare(now_ns, sharp_, view, context());
    show_handles(view);
    state_.second_force_n = view.hand ? view.hand->force_world_n.norm() : 0.0;
    state_.second_at_wall = view.hand && view.hand->at_wall;
    state_.force_n = view.force_world_n.norm();
    state_.arrow_a_per_n = static_cast<double>(view_->arrow_a_per_n());
    const SceneToggles& t = state_.toggles;
    view_options_.surface = t.surface;
    view_options_.force = t.force;
    view_options_.box = t.box;
    view_options_.style = static_cast<SurfaceStyle>(t.style);
    view_options_.depth_cue = t.depth_cue;
    view_options_.smooth_edges = t.smooth_edges;
    const bool rich = sharp_ || !window_.software();  // else only once the view rests
    view_options_.shaded = t.shading && rich;
    view_options_.light_by_pixel = rich;
    view_options_.glass_layers = rich ? glass_layers(window_.software()) : 0;
    view_options_.cut_a.reset();
    if (t.cut) view_options_.cut_a = t.cut_at * view_->radius_a();
    view_options_.gradient = !t.white_ground && !options_.plain;
    const ImVec4 dark = ImGui::ColorConvertU32ToFloat4(colour::kGround);
    view_options_.plain_ground =
        t.white_ground ? Eigen::Vector3f::Ones() : Eigen::Vector3f(dark.x, dark.y, dark.z);
    if (state_.picture.save_wanted && sharp_) save_picture(view);
    if (stage_)
        draw_stage(view, now_ns);
    else
        draw_window_view(view, frame_at_);
    system().drawn(context());
}

void GuiApp::draw_ground(const Window::Size& size) {
    const PassClock::Scope scope(&passes_, Pass::ground);
    glDisable(GL_SCISSOR_TEST);
    if (!panel_image_.show(layout_, to_px(size), size.width_px, size.height_px)) paint_ground();
    glClear(GL_DEPTH_BUFFER_BIT);
}

void GuiApp::begin_view(const ViewFrame& view) {
    const PassClock::Scope scope(&passes_, Pass::ground);
    backdrop_.show(*programs_, view_options_.plain(), view.x_px, view.y_px, view.width_px, view.height_px);
    glViewport(view.x_px, view.y_px, view.width_px, view.height_px);
}

void GuiApp::draw_stage(ViewFrame view, std::int64_t now_ns) {
    stage_->follow(controller_.attached() && controller_.have_head ? &controller_.head : nullptr, now_ns,
                   clock_.frame_s(), {view.x_px, view.y_px, view.width_px, view.height_px});
    view.x_px = view.y_px = 0;
    view.width_px = stage_->eye_width_px();
    view.height_px = stage_->eye_height_px();
    view.eyes = 2;
    for (std::size_t eye = 0; eye < 2; ++eye) {
        view.eye = eye;
        stage_->begin(eye, view_options_.plain_ground);
        draw_view(stage_->eye(eye, camera_, content_->meta.world_per_model,
                              content_->meta.to_world(content_->centre_model_m), view_->radius_a()),
                  view);
    }
    {
        const PassClock::Scope scope(&passes_, Pass::stereo);
        stage_->show(window_.frame_buffer());
    }
    state_.a_per_px = 0.0;  // each eye has its own scale
    state_.stage = std::string("stereo: ") + stage_text(*stage_);
    state_.head_lost = stage_->head().sight() == HeadSight::lost;
}

}  // namespace tact
