// The mouse as a hand: what it can take, takes and lets go (tool_drag.hpp), and what a person sees of it.
#include <imgui.h>

#include "gui/window/app_parts.hpp"

namespace tact {
namespace {

constexpr float kHandlePx = 18.0F, kNearPx = 24.0F;  // at scale 1

Pose pose_of(const ToolTopic& tool) {
    const double* const q = tool.quat_world_tool_xyzw;
    return {Vec3(tool.pos_world_m), Quat(q[3], q[0], q[1], q[2]).normalized()};
}

}  // namespace

DragView GuiApp::drag_view() const {
    const PixelRect& v = layout_.view;
    return {camera_.eye(v.width / std::max(v.height, 1.0F)), camera_.orientation(), v,
            content_->centre_model_m, &content_->meta};
}

// The tools of the hands that a pointer may lead, where they are now.
void GuiApp::follow_tools() {
    drag_tools_ = {};
    if (!content_ || !controller_.attached() || !controller_.have_mouse || controller_.watches()) return;
    const bool known[kMouseHands] = {controller_.have_tool, controller_.have_second};
    for (std::size_t i = 0; i < kMouseHands; ++i) {
        DragTool& tool = drag_tools_[i];
        tool.may = known[i] && controller_.mouse.lead[i] != static_cast<std::uint8_t>(MouseLead::none);
        if (!tool.may) continue;
        tool.T_world_tool = pose_of(i == 0 ? controller_.tool : controller_.second);
        tool.at_model_m =
            system().tool_at(i, context()).value_or(content_->meta.to_model(tool.T_world_tool.p_m));
    }
}

void GuiApp::take_tool(std::size_t hand, HeldBy by) {
    drag_.take(hand, drag_tools_[hand], content_->meta, by);
    state_.mouse.taken = true;
}

void GuiApp::let_go_of_tool() {
    if (!drag_.holds()) return;
    camera_waits_ =
        drag_.held(HeldBy::button);  // until the button is released, or the drag would turn the view
    drag_.let_go();
    for (RestGate& gate : input_gates_) gate.close();
    if (controller_.attached())
        region_->mouse.publish(drag_.record(controller_.generation(), to_ns(frame_at_)));
}

// By key: the tool under the pointer, else the first one.
void GuiApp::lead_or_let_go() {
    if (drag_.holds()) return let_go_of_tool();
    const ImVec2 p = ImGui::GetIO().MousePos;
    const std::size_t hand =
        ToolDrag::tool_near(drag_view(), drag_tools_, p.x, p.y, 1e6F).value_or(drag_tools_[0].may ? 0 : 1);
    if (drag_tools_[hand].may) take_tool(hand, HeldBy::key);
}

// With the input of a frame. True: the mouse leads a tool, or has just let it go, so it does not move the camera.
bool GuiApp::lead_by_mouse() {
    const ImGuiIO& io = ImGui::GetIO();
    MouseHint& hint = state_.mouse;
    hint.may = may_lead();
    near_tool_.reset();
    const bool taken = hint.taken;
    if (!hint.may || calibration_.open()) {
        let_go_of_tool();
        hint = {};
        hint.taken = taken;
        return false;
    }
    if (!io.MouseDown[0]) camera_waits_ = false;
    const bool free = !io.WantCaptureMouse && ImGui::IsMousePosValid();
    // The eyes of a stereo display see the tool at other places than a pointer.
    // A drag of its ring takes the tool over from another device.
    if (!drag_.by_pointer() && free && !stage_ && !camera_waits_)
        near_tool_ =
            ToolDrag::tool_near(drag_view(), drag_tools_, io.MousePos.x, io.MousePos.y, theme_.px(kNearPx));
    if (near_tool_ && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) take_tool(*near_tool_, HeldBy::button);
    if (drag_.by_pointer() && (drag_.by_key() ? !ImGui::IsMousePosValid() : !io.MouseDown[0]))
        let_go_of_tool();
    if (drag_.holds() && !drag_tools_[drag_.hand()].may) let_go_of_tool();
    if (drag_.by_pointer()) {
        const bool at_work = free || !drag_.by_key();  // not while the pointer is over a panel
        const bool begun = ImGui::IsMouseClicked(ImGuiMouseButton_Left) && !drag_.by_key();
        drag_.move(drag_view(), {.dx = at_work && !begun ? io.MouseDelta.x : 0.0F,
                                 .dy = at_work && !begun ? io.MouseDelta.y : 0.0F,
                                 .wheel = at_work ? io.MouseWheel + io.MouseWheelH : 0.0F,
                                 .turn = io.KeyCtrl,
                                 .fine = io.KeyShift,
                                 .drive = at_work && (io.MouseDown[1] || (drag_.by_key() && io.MouseDown[0])),
                                 .clutch = at_work && io.MouseDown[2]});
    }
    if (drag_.by_pointer() || near_tool_)
        ImGui::SetMouseCursor(drag_.by_pointer() ? ImGuiMouseCursor_ResizeAll : ImGuiMouseCursor_Hand);
    hint.holds = drag_.holds();
    hint.by_key = drag_.by_key();
    hint.near = near_tool_.has_value();
    hint.bone = state_.situation.bone;
    hint.drives = drag_.holds() && (drag_.buttons() & 2U) != 0;
    hint.silent =
        drag_.holds() && controller_.mouse.lead[drag_.hand()] == static_cast<std::uint8_t>(MouseLead::stale);
    hint.label = false;
    if (!hint.taken && !stage_) {
        const DragTool& tool = drag_tools_[drag_tools_[0].may ? 0 : 1];
        if (const auto at = ToolDrag::on_screen(drag_view(), tool.at_model_m)) {
            hint.label = true;
            hint.label_x = at->x();
            hint.label_y = at->y() + theme_.px(kHandlePx);
        }
    }
    hint_of_input();
    return drag_.by_pointer() || camera_waits_;
}

// Every frame, also one without input: the controller takes silence for letting go.
void GuiApp::publish_mouse() {
    if (drag_.holds() && controller_.attached())
        region_->mouse.publish(drag_.record(controller_.generation(), to_ns(Monotonic::now())));
}

void GuiApp::show_handles(ViewFrame& view) const {
    for (std::size_t i = 0; i < kMouseHands; ++i) {
        view.handle[i].reset();
        if (!drag_tools_[i].may || calibration_.open()) continue;
        DrawnHandle handle;
        handle.at_model_m = handle.target_model_m = drag_tools_[i].at_model_m;
        handle.radius_px = theme_.px(kHandlePx) * to_px(window_.size());
        if (near_tool_ == i) handle.state = HandleState::near;
        if (drag_.holds() && drag_.hand() == i) {
            handle.state = HandleState::held;
            handle.target_model_m = drag_.target_model_m(content_->meta);
        }
        view.handle[i] = handle;
    }
}

}  // namespace tact
