// What the sticks, triggers and buttons of a gamepad mean.
//
//            as a hand                                  as the camera
// left       the tool, in the plane of the view         turns the view
// right      the same, a fifth of the speed             pans
// triggers   right: away from the viewer; left: nearer  right: nearer; left: farther
// shoulder   either held: the left stick turns the tool, the right one finely, the triggers roll it;  left stick and triggers roll the view
// A, B       first and second button of the stylus      A: home view
//
// Thread   frame thread; plain arithmetic
#pragma once

#include "gui/input/gamepad_port.hpp"
#include "gui/input/rate_control.hpp"

namespace tact {

inline constexpr double kGamepadFine = 0.2;

[[nodiscard]] Deflection gamepad_hand(const GamepadState& state, const InputChoice& choice);
[[nodiscard]] Deflection gamepad_view(const GamepadState& state, const InputChoice& choice);

// Notices gamepads that come and go.
class Gamepad {
public:
    explicit Gamepad(GamepadPort& port) : port_(port) {}
    // Once a frame, before the others.
    void read();
    [[nodiscard]] InputSample sample(const InputChoice& choice) const;
    [[nodiscard]] std::string text() const;  // its name, or why there is none
    [[nodiscard]] const GamepadState& state() const { return state_; }

private:
    GamepadPort& port_;
    GamepadState state_;
    std::uint64_t connection_ = 0;
};

}  // namespace tact
