#include <imgui.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "gui/window/app_parts.hpp"

namespace tact {

namespace {

// Towards the user as the wheel turns towards the user; the first turn cuts.
void move_cut(SceneToggles& t, float steps) {
    constexpr float kStep = 0.02F;  // radii of the scene
    if (t.cut) t.cut_at = std::clamp(t.cut_at - kStep * steps, -1.0F, 1.0F);
    t.cut = true;
}

}  // namespace

void GuiApp::handle_input() {
    const ImGuiIO& io = ImGui::GetIO();
    if (!lead_by_mouse() && !io.WantCaptureMouse && !calibration_.open()) {
        const float height = layout_for(theme_, io.DisplaySize.x, io.DisplaySize.y,
                                        middle_card(state_, system().panels()), strip_of(state_))
                                 .view.height;
        if (controller_.watches() && io.KeyCtrl && ImGui::IsMouseClicked(ImGuiMouseButton_Left))
            mark_under_pointer();
        else if (io.MouseDown[0] && !(controller_.watches() && io.KeyCtrl))
            camera_.rotate(io.MouseDelta.x, io.MouseDelta.y, height);
        click_view();
        if (io.MouseDown[1]) camera_.pan(io.MouseDelta.x, io.MouseDelta.y, height);
        if (io.MouseWheel != 0.0F && io.KeyAlt && content_)
            system().turn_wheel(static_cast<double>(io.MouseWheel));
        else if (io.MouseWheel != 0.0F && io.KeyCtrl && content_)
            system().choose_by_wheel(static_cast<double>(io.MouseWheel));
        else if (const float turned = io.MouseWheel + io.MouseWheelH; turned != 0.0F && io.KeyShift)
            move_cut(state_.toggles, turned);
        else if (io.MouseWheel != 0.0F)
            camera_.zoom(io.MouseWheel);
    }
    KeySituation& now = state_.situation;
    now.calibrating = calibration_.open();
    now.browser = state_.browser.open;
    const KeyWhen of_system = content_ && !now.calibrating ? system_rows()[shown_].keys : KeyWhen::always;
    now.bodies = of_system == KeyWhen::bodies;
    now.bone = of_system == KeyWhen::bone;
    now.stereo = stage_ != nullptr && !now.calibrating;
    now.replay = controller_.replays();
    now.controller = controller_.attached() && !now.replay;
    now.watching = controller_.watches();
    now.mouse = state_.mouse.may;
    now.holding = state_.mouse.holds;
    for (const KeyStroke& stroke : window_.take_keys()) {
        if (io.WantTextInput) continue;
        const KeyFound found = state_.keys.find(stroke, now);
        if (found.row == nullptr) continue;
        spdlog::debug("key {}: {}", found.row->keys, found.row->what);
        perform(found.row->action, static_cast<std::size_t>(found.place));
    }
}

void GuiApp::perform(KeyAction what, std::size_t place) {
    if (content_ && system().perform(what, place, context())) return;
    const auto command = [&](CommandKind kind) { state_.requests.push_back({kind, 0.0, {}, 0}); };
    const RunState run =
        controller_.have_health ? static_cast<RunState>(controller_.health.state) : RunState::off;
    switch (what) {
        case KeyAction::home:
            return home_view();
        case KeyAction::style:
            state_.toggles.style = (state_.toggles.style + 1) % 3;
            return;
        case KeyAction::cut:
            state_.toggles.cut = !state_.toggles.cut;
            return;
        case KeyAction::picture:
            open_alone(state_.picture.open, state_.input.open);
            return;
        case KeyAction::input_devices:
            open_alone(state_.input.open, state_.picture.open);
            return;
        case KeyAction::swap_eyes:
            return stage_->swap_eyes();
        case KeyAction::arm:  // as the button: only from a state that allows it
            if (run == RunState::ready) command(CommandKind::arm);
            return;
        case KeyAction::disarm:  // in any state: disarming is always safe, and the controller answers
            return command(CommandKind::disarm);
        case KeyAction::record:
            state_.record_wanted = true;
            return;
        case KeyAction::save_session:
            state_.browser.session_wanted = true;
            return;
        case KeyAction::play:
            return state_.replay.requests.push_back({TimelineAction::play, 0.0});
        case KeyAction::step_back:
            return state_.replay.requests.push_back({TimelineAction::step, -1.0});
        case KeyAction::step_on:
            return state_.replay.requests.push_back({TimelineAction::step, 1.0});
        case KeyAction::screenshot:
            screenshot_requested_ = true;
            return;
        case KeyAction::mark:
            return command(CommandKind::mark);
        case KeyAction::help:
            state_.situation.sheet = !state_.situation.sheet;
            return;
        case KeyAction::close_sheet:
            state_.situation.sheet = false;
            return;
        case KeyAction::open_browser:
            state_.browser.open = true;
            return;
        case KeyAction::close_browser:
            state_.browser.open = false;
            return;
        case KeyAction::calibrate:
            if (!calibration_.open()) open_calibration(false);
            return;
        case KeyAction::measure:
            return calibration_.perform(CalibrationAction::take);
        case KeyAction::skip_point:
            return calibration_.perform(CalibrationAction::skip);
        case KeyAction::redo_point:
            return calibration_.perform(CalibrationAction::redo_last);
        case KeyAction::next_step:
            return calibration_.perform(CalibrationAction::next);
        case KeyAction::leave_calibration:
            return calibration_.perform(CalibrationAction::leave);
        case KeyAction::save_calibration:
            return calibration_.perform(CalibrationAction::save);
        case KeyAction::swap_calibrated_eyes:
            return calibration_.swap_eyes();
        case KeyAction::lead_tool:
            return lead_or_let_go();
        case KeyAction::let_go_tool:
            return let_go_of_tool();
        default:  // belongs to another system
            return;
    }
}

}  // namespace tact
