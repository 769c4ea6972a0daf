// Rate control: the deflection of a SpaceMouse's cap or of a stick is a speed, of the tool or of the view.
//
// Shape     per axis: none within the dead zone, then ((|d| - zone) / (1 - zone))^curve, continuous, 1 at full deflection
// Exact     a constant deflection moves by speed * time however the time is cut into frames
// Bounded   not a number counts as rest, more than full as full, and a frame as at most kFrameMost_s: a pause does not jump
// Axes      of the eye: x right, y up, z to the person; rotation right-handed about them
// Thread    frame thread; plain arithmetic
#pragma once

#include <cstdint>

#include "gui/dashboard/input_choice.hpp"
#include "ipc/base/pose.hpp"

namespace tact {

// -1 to 1 each.
struct Deflection {
    Vec3 move = Vec3::Zero(), turn = Vec3::Zero();
    [[nodiscard]] bool rests() const { return move.isZero(0.0) && turn.isZero(0.0); }
};

// As read from a device; deflection already shaped.
struct InputSample {
    bool present = false;
    std::uint64_t connection = 0;  // another number after each loss of the device
    Deflection deflection;
    std::uint32_t buttons = 0;  // of the stylus: 1 the first, 2 the second
};

[[nodiscard]] double shaped(double deflection, const InputChoice& choice) noexcept;
[[nodiscard]] Deflection shaped(const Deflection& raw, const InputChoice& choice) noexcept;

struct RateMotion {
    static constexpr double kFrameMost_s = 0.1;
    static constexpr double kHand_m_s = 0.06, kHandTurn_rad_s = 1.5;    // at full deflection and speed 1
    static constexpr double kViewTurn_rad_s = 1.8, kViewPan_1_s = 0.8;  // heights of the view per second
    static constexpr double kViewZoom_1_s = 9.0;                        // steps of the wheel per second

    Vec3 move = Vec3::Zero();  // hand: metres in the world. View: heights right and up, steps of zoom nearer
    Vec3 turn_rad = Vec3::Zero();
};
[[nodiscard]] RateMotion hand_motion(const Deflection& shaped, double speed, double frame_s) noexcept;
[[nodiscard]] RateMotion view_motion(const Deflection& shaped, double speed, double frame_s) noexcept;

// Motion counts once the device was seen at rest: a stick that is held over while a gamepad is plugged in, or while the tool was let
// go, moves nothing until it was released.
class RestGate {
public:
    // The sample, or rest without buttons while the gate is closed or the device absent.
    [[nodiscard]] InputSample pass(const InputSample& sample);
    void close() { open_ = false; }

private:
    bool open_ = false;
    std::uint64_t connection_ = 0;
};

}  // namespace tact
