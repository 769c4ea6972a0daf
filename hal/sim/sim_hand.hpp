// An emulated hand on an emulated arm: one rigid body of six degrees of freedom with viscous damping.
//
// Frame     device
// Step      exact for a force that is constant over the step, so stable at any step and any servo rate
// Scripts   passive: moved only by the motors. wander: moved by a smooth random motion. stroke: the same,
//           mostly sideways, and pressed down onto the surface. drill: the same, slowly away from the user.
//           surgeon, suction-tube: sim_surgeon.hpp. mouse, spacemouse, gamepad: as passive, until a pointer takes it
//           (mouse_hand.hpp).
// Pointer   once one has taken the hand, with any script, the script is over: between two grips the hand is passive
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "hal/sim/mouse_hand.hpp"
#include "hal/sim/sim_surgeon.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

inline constexpr std::array kSimHandNames{"passive",      "wander", "stroke",     "drill",  "surgeon",
                                          "suction-tube", "mouse",  "spacemouse", "gamepad"};
// Waits for a pointer in the window.
[[nodiscard]] inline bool is_led_hand(const std::string& name) {
    return name == "mouse" || name == "spacemouse" || name == "gamepad";
}
// Recordings from before 2026-11-25 hold the former name.
inline std::string current_hand_name(const std::string& name) {
    return name == "sucker" ? "suction-tube" : name;  // former name
}

// A relaxed hand in pen grip together with the arm of the device. Mass: 0.136 kg of the arm (manufacturer's
// value for a Premium 1.5) and about as much for the fingers. Damping: the middle of 3 to 10 N s/m,
// measured for pen grips in the literature. Rotation: a hand-held gimbal of 0.1 kg and 3 cm radius, with
// damping such that 0.05 N m turns it by 150 degrees per second.
struct SimHandSettings {
    std::string script = "passive";  // or another of kSimHandNames
    std::uint64_t seed = 1;
    double mass_kg = 0.25;
    double damping_n_s_m = 5.0;
    double inertia_kg_m2 = 1e-4;
    double damping_n_m_s = 0.02;
    double wander_m = 0.03;  // amplitude
    double wander_rad = 0.3;
    double press_m = 0.03;     // target depth: down for stroke, away from the user for drill
    Vec3 at_m = Vec3::Zero();  // start position of surgeon and suction tube
};

class SimHand {
public:
    SimHand(const SimHandSettings& settings, const Vec3& reach_m);

    // powered: the device's motors are on.
    void step(Duration dt, const Wrench& wrench_dev, bool powered = true) noexcept TACT_RT;
    // Moves the hand to this place and keeps it there, whatever its script; none: the script again.
    void hold(const std::optional<Vec3>& at_m) noexcept { held_m_ = at_m; }
    // The newest target of a pointer, before the step up to `now`.
    void follow(const MouseTarget& target, Instant now) noexcept TACT_RT {
        mouse_.follow(target, now, pose_, twist_);
    }
    [[nodiscard]] const MouseHand& mouse() const noexcept { return mouse_; }
    [[nodiscard]] std::uint32_t buttons() const noexcept {
        if (mouse_.taken()) return mouse_.buttons();
        return surgeon_ ? surgeon_->buttons() : 0;
    }
    [[nodiscard]] const Pose& pose() const noexcept { return pose_; }
    [[nodiscard]] const Twist& twist() const noexcept { return twist_; }

private:
    struct Wave {
        double frequency_rad_s, phase_rad, weight;
    };
    static constexpr std::size_t kWaves =
        3;  // sum of three sines; their incommensurate frequencies never repeat
    using Waves = std::array<std::array<Wave, kWaves>, 6>;

    [[nodiscard]] double wave(std::size_t axis) const noexcept;
    [[nodiscard]] Wrench pull() const noexcept;

    SimHandSettings settings_;
    Vec3 reach_m_;
    bool wanders_, strokes_, drills_;
    std::optional<SimSurgeon> surgeon_;
    MouseHand mouse_;
    std::optional<Vec3> held_m_;
    Waves waves_{};
    double time_s_ = 0.0;
    Pose pose_;
    Twist twist_;
};

}  // namespace tact
