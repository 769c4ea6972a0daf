// SpaceMouse and gamepad, as hand or as camera: their deflection is the speed of the tool's target or of the view.
//
// Hand     takes the tool when it moves, and holds the target from then on, also at rest and unplugged, until a person lets go; from
//          rest it takes the tool again.
// Camera   turns, pans and zooms; its first button is the home view
#include <imgui.h>

#include <utility>

#include "gui/window/app_parts.hpp"
#include "gui/window/steer_camera.hpp"

namespace tact {
namespace {

constexpr std::array<HeldBy, kInputDevices> kHeldBy{HeldBy::spacemouse, HeldBy::gamepad};
constexpr std::array<LeadDevice, kInputDevices> kLeadBy{LeadDevice::spacemouse, LeadDevice::gamepad};

}  // namespace

// Every frame, also one whose dashboard is not drawn.
void GuiApp::follow_input() {
    const double frame_s = input_at_ == Instant{} ? 0.0 : to_s(frame_at_ - input_at_);
    input_at_ = frame_at_;
    if (options_.hidden) return;  // nobody sees it
    adopt_input_roles();
    InputState& input = state_.input;
    input.may_lead = may_lead();
    if (!input.choice[0].is(InputRole::off) && !space_mouse_) space_mouse_.emplace();
    if (input.choice[0].is(InputRole::off)) space_mouse_.reset();
    const SpaceMouseState cap = space_mouse_ ? space_mouse_->take() : SpaceMouseState{};
    gamepad_.read();
    const std::array<InputSample, kInputDevices> samples{space_mouse_sample(cap, input.choice[0]),
                                                         gamepad_.sample(input.choice[1])};
    input.device[0] = {samples[0].present, space_mouse_text(cap)};
    input.device[1] = {samples[1].present, gamepad_.text()};
    for (std::size_t i = 0; i < kInputDevices; ++i) {
        const InputChoice& choice = input.choice[i];
        if (std::exchange(input_roles_[i], choice.role) != choice.role) {
            input_gates_[i].close();
            if (leads(i)) let_go_of_tool();
        }
        input_samples_[i] = input_gates_[i].pass(samples[i]);
        if (choice.is(InputRole::camera)) steer_view(i, input_samples_[i], frame_s);
        if (choice.is(InputRole::hand)) steer_tool(i, input_samples_[i], frame_s);
        input_buttons_[i] = input_samples_[i].buttons;
    }
}

// A run that was started with --hand spacemouse or gamepad; once, because the person may choose otherwise.
void GuiApp::adopt_input_roles() {
    if (!controller_.attached() || !controller_.have_mouse || roles_adopted_of_ == controller_.generation())
        return;
    roles_adopted_of_ = controller_.generation();
    for (std::size_t i = 0; i < kInputDevices; ++i) {
        if (input_role_left_[i]) continue;
        for (std::size_t hand = 0; hand < kMouseHands; ++hand) {
            const MouseStateTopic& mouse = controller_.mouse;
            if (mouse.lead[hand] == static_cast<std::uint8_t>(MouseLead::none) ||
                mouse.wanted[hand] != static_cast<std::uint8_t>(kLeadBy[i]) ||
                state_.input.choice[i].is(InputRole::hand))
                continue;
            input_role_left_[i] = state_.input.choice[i].role;
            state_.input.choice[i].role = static_cast<int>(InputRole::hand);
        }
    }
}

// Without what a run asked for, and the person left so.
std::array<InputChoice, kInputDevices> GuiApp::kept_input() const {
    auto kept = state_.input.choice;
    for (std::size_t i = 0; i < kInputDevices; ++i)
        if (input_role_left_[i] && kept[i].is(InputRole::hand)) kept[i].role = *input_role_left_[i];
    return kept;
}

void GuiApp::steer_view(std::size_t device, const InputSample& sample, double frame_s) {
    if (!content_ || calibration_.open()) return;
    if ((sample.buttons & ~input_buttons_[device] & 1U) != 0) home_view();
    if (sample.deflection.rests()) return;
    steer(camera_, view_motion(sample.deflection, state_.input.choice[device].speed, frame_s));
}

bool GuiApp::leads(std::size_t device) const { return drag_.held(kHeldBy[device]); }

// That for which the device was named; else the first that may be led.
std::size_t GuiApp::hand_for(std::size_t device) const {
    for (std::size_t hand = 0; hand < kMouseHands; ++hand)
        if (drag_tools_[hand].may &&
            controller_.mouse.wanted[hand] == static_cast<std::uint8_t>(kLeadBy[device]))
            return hand;
    return drag_tools_[0].may ? 0 : 1;
}

void GuiApp::steer_tool(std::size_t device, const InputSample& sample, double frame_s) {
    if (!leads(device)) {
        const bool moves = !sample.deflection.rests() || sample.buttons != 0;
        if (!moves || drag_.holds() || calibration_.open() || !may_lead()) return;
        take_tool(hand_for(device), kHeldBy[device]);
    }
    if (!drag_tools_[drag_.hand()].may) return let_go_of_tool();
    const RateMotion m = hand_motion(sample.deflection, state_.input.choice[device].speed, frame_s);
    drag_.steer(drag_view(), m.move, m.turn_rad, sample.buttons);
}

// With the hint of the mouse, which is drawn at the same place.
void GuiApp::hint_of_input() {
    MouseHint& hint = state_.mouse;
    hint.device = MouseHint::kMouse;
    hint.gone = false;
    hint.waits.clear();
    hint.waits_in_vain = false;
    for (std::size_t i = 0; i < kInputDevices; ++i) {
        const InputState::Device& device = state_.input.device[i];
        if (leads(i)) {
            hint.device = static_cast<int>(i);
            hint.gone = !device.present;
        }
        if (!state_.input.choice[i].is(InputRole::hand) || !hint.waits.empty()) continue;
        hint.waits_in_vain = !device.present;
        hint.waits = device.present ? std::string("Move the ") + kInputNouns[i] + " to lead the tool."
                                    : std::string(kInputNames[i]) + ": " + device.text;
    }
}

}  // namespace tact
