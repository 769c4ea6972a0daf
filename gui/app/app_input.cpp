#include <imgui.h>

#include "gui/app/app_parts.hpp"
#include "gui/app/contour_rows.hpp"

namespace tact {

void GuiApp::handle_input() {
    const ImGuiIO& io = ImGui::GetIO();
    if (!io.WantCaptureMouse) {
        const float height = layout_for(theme_, io.DisplaySize.x, io.DisplaySize.y, middle_card(state_.scene),
                                        state_.strip == 1)
                                 .view.height;
        if (io.MouseDown[0]) camera_.rotate(io.MouseDelta.x, io.MouseDelta.y, height);
        if (io.MouseDown[1]) camera_.pan(io.MouseDelta.x, io.MouseDelta.y, height);
        if (io.MouseWheel != 0.0F && io.KeyAlt && content_)
            nudge_contour(state_.contours, content_->scale, static_cast<double>(io.MouseWheel));
        else if (io.MouseWheel != 0.0F && !io.KeyCtrl && !io.KeyShift)
            camera_.zoom(io.MouseWheel);
    }
    for (const Key key : window_.take_keys()) {
        if (io.WantTextInput) continue;
        if (key == Key::home) home_view();
        if (key == Key::burr) look_at_burr();
        if (key == Key::style) state_.toggles.style = (state_.toggles.style + 1) % 3;
        if (key == Key::picture) picture_wanted_ = true;
        if (key == Key::swap_eyes && stage_) stage_->swap_eyes();
        if (key == Key::mark) state_.wishes.push_back({CommandKind::mark, 0.0, {}});
        if (key == Key::raise && content_) nudge_contour(state_.contours, content_->scale, 1.0);
        if (key == Key::lower && content_) nudge_contour(state_.contours, content_->scale, -1.0);
        if (key == Key::help) state_.show_keys = !state_.show_keys;
        if (key == Key::escape && state_.show_keys)
            state_.show_keys = false;
        else
            fitting_key(key);
    }
}

void GuiApp::fitting_key(Key key) {
    const auto active = list_.active();
    const std::uint32_t held = active ? list_.bodies()[*active].id : 0;
    const auto wish = [&](FitAct act) { state_.fit_wishes.push_back({act, held, {}}); };
    if (key == Key::escape) wish(FitAct::revert);
    if (key == Key::accept) wish(FitAct::accept);
    if (key == Key::undo) wish(FitAct::undo);
    if (key == Key::redo) wish(FitAct::redo);
    if (key == Key::refine && held != 0) wish(FitAct::refine);
    if (key < Key::body_0 || !controller_.attached()) return;
    const auto digit = static_cast<std::size_t>(key) - static_cast<std::size_t>(Key::body_0);
    if (digit == 0) state_.wishes.push_back({CommandKind::select_body, 0.0, {}, kNoBody});
    if (digit >= 1 && digit <= list_.bodies().size())
        state_.wishes.push_back({CommandKind::select_body, 0.0, {}, list_.bodies()[digit - 1].id});
}

}  // namespace tact
