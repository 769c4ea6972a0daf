#include "gui/input/gamepad.hpp"

#include <algorithm>

namespace tact {
namespace {

constexpr std::uint32_t kA = 1U << 0U, kB = 1U << 1U, kShoulders = (1U << 4U) | (1U << 5U);

struct GamepadSticks {
    double left_right, left_up, right_right, right_up;  // shaped
    double triggers;                                    // right less left
    bool shoulder;
};

GamepadSticks sticks_of(const GamepadState& s, const InputChoice& choice) {
    const auto axis = [&](std::size_t i) { return shaped(static_cast<double>(s.axes[i]), choice); };
    const auto trigger = [&](std::size_t i) {
        return shaped(0.5 * (static_cast<double>(s.axes[i]) + 1.0), choice);
    };
    return {axis(0), -axis(1), axis(2), -axis(3), trigger(5) - trigger(4), (s.buttons & kShoulders) != 0};
}

}  // namespace

Deflection gamepad_hand(const GamepadState& state, const InputChoice& choice) {
    const GamepadSticks s = sticks_of(state, choice);
    const double right = s.left_right + kGamepadFine * s.right_right,
                 up = s.left_up + kGamepadFine * s.right_up;
    // Right turns the front of the tool to the right; away from the viewer is -z; a roll to the right is about -z.
    if (s.shoulder) return {Vec3::Zero(), Vec3(-up, right, -s.triggers)};
    return {Vec3(right, up, -s.triggers), Vec3::Zero()};
}

Deflection gamepad_view(const GamepadState& state, const InputChoice& choice) {
    const GamepadSticks s = sticks_of(state, choice);
    const Vec3 turn =
        s.shoulder ? Vec3(0.0, 0.0, -s.left_right - s.triggers) : Vec3(-s.left_up, s.left_right, 0.0);
    return {Vec3(s.right_right, s.right_up, s.shoulder ? 0.0 : s.triggers), turn};
}

void Gamepad::read() {
    const bool before = state_.connected;
    const std::string name = state_.name;
    port_.read(state_);
    if (before != state_.connected || (before && name != state_.name)) ++connection_;
}

InputSample Gamepad::sample(const InputChoice& choice) const {
    InputSample s;
    s.present = state_.connected;
    s.connection = connection_;
    if (!s.present) return s;
    s.deflection = choice.is(InputRole::hand) ? gamepad_hand(state_, choice) : gamepad_view(state_, choice);
    s.buttons = ((state_.buttons & kA) != 0 ? 1U : 0U) | ((state_.buttons & kB) != 0 ? 2U : 0U);
    return s;
}

std::string Gamepad::text() const {
    if (state_.connected) return state_.name.empty() ? "connected" : state_.name;
    if (state_.unknown)
        return "\"" + state_.name + "\" has no gamepad mapping. Set SDL_GAMECONTROLLERCONFIG.";
    return "not found. Plug one in.";
}

}  // namespace tact
