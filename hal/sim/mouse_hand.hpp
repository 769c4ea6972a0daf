// How an emulated hand follows a pointer in the window: a spring and a damper to a target that moves smoothly.
//
// Target   a pose, about 60 times a second, from the housekeeping thread (MouseTarget through a Latest). A critically damped filter of
//          second order, x'' = w^2 (goal - x) - 2 w x' with w = kResponse, turns its steps into a motion at the servo's rate. It is
//          causal (no prediction, so no overshoot) and lags 2/w = 33 ms; steps of a 60 Hz pointer change the speed by less than a tenth.
// Bounded  the goal by the arm's reach, the distance that the filter sees by 2 kSpeedMost / w; so the target's speed stays below
//          kSpeedMost and its acceleration below 2 w kSpeedMost, whatever the pointer does. The same in rotation.
// Pull     F = k (target - hand) + c (target' - hand'), at most kForceMost: a person's fingers, soft enough that the rendered force
//          holds the tool back behind the pointer, where it is seen.
// Taken    begins at the hand's pose and speed, so nothing jumps
// Let go   by the window, or when no target came for kStaleAfter: no pull and no button; the hand is moved by the motors alone
// Frame    device
// Thread   that of the device; no allocation
#pragma once

#include <cstdint>

#include "ipc/base/clock.hpp"
#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

// Trivially copyable, for a Latest. Checked by its writer: finite, a unit quaternion.
struct MouseTarget {
    std::int64_t arrived_ns;  // in the device's clock
    double pos_dev_m[3];
    double quat_dev_tool_xyzw[4];
    std::uint32_t buttons;
    std::uint32_t holds;  // 1: the pointer holds the tool
};

class MouseHand {
public:
    static constexpr Duration kStaleAfter = std::chrono::milliseconds(250);
    static constexpr double kResponse = 60.0;                     // 1/s
    static constexpr double kSpeedMost = 0.6;                     // m/s
    static constexpr double kTurnMost = 6.0;                      // rad/s
    static constexpr double kStiffness = 150.0;                   // N/m
    static constexpr double kDamping = 10.0;                      // N s/m
    static constexpr double kTurnStiffness = 0.3;                 // N m/rad
    static constexpr double kForceMost = 8.0, kTorqueMost = 0.3;  // N, N m

    explicit MouseHand(const Vec3& reach_m) : reach_m_(reach_m) {}

    // Before the steps up to `now`. target: the newest one; hand: where it is and how it moves.
    void follow(const MouseTarget& target, Instant now, const Pose& hand,
                const Twist& motion) noexcept TACT_RT;
    void step(double h_s) noexcept TACT_RT;
    [[nodiscard]] Wrench pull(const Pose& hand, const Twist& motion) const noexcept TACT_RT;

    [[nodiscard]] bool leads() const noexcept { return leads_; }
    // It led at least once: from then on the hand is the person's, and no script moves it.
    [[nodiscard]] bool taken() const noexcept { return taken_; }
    [[nodiscard]] std::uint32_t buttons() const noexcept { return leads_ ? buttons_ : 0U; }
    [[nodiscard]] const Pose& target() const noexcept { return target_; }
    [[nodiscard]] const Twist& target_motion() const noexcept { return motion_; }

private:
    Vec3 reach_m_;
    bool leads_ = false, taken_ = false;
    std::uint32_t buttons_ = 0;
    Pose goal_, target_;
    Twist motion_;  // of the target
};

}  // namespace tact
