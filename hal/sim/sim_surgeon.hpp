// An emulated surgeon's hand that guides a burr over bone, or one that follows it with a suction tube.
//
// Inputs   the rendered force, its own position, and the time since power-on; nothing of the scene
// Burr     moves away from the user until contact, then works out a bowl there: series of strokes to and
//          fro, each in another direction, slowly wider and deeper. Between two series it lifts the burr
//          and the pedal. Without contact it tries again a little beside.
// SuctionTube   searches in the same manner, stays on the side of the bowl opposite the burr of a surgeon
//               with the same random seed, and moves into the middle while that burr is lifted.
// Pedal    the second button, pressed while working
// Power    while the device is off, the hand returns to its start
// Frame    device
// Repeats  the same random seed, steps and forces give the same motion
// Thread   that of the device; no allocation
#pragma once

#include <cstdint>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

struct SimSurgeonSettings {
    bool suction_tube = false;
    std::uint64_t seed = 1;
    Vec3 at_m = Vec3::Zero();  // in front of the bone; the bowl is straight behind this point
};

class SimSurgeon {
public:
    static constexpr double kDepthM = 10e-3, kBowlM = 6.5e-3;  // of the finished bowl
    static constexpr double kPressMostN = 1.6;
    static constexpr double kReachM = 80e-3;  // maximum search distance for bone
    static constexpr double kSeriesS = 6.0;   // strokes and the lift after them

    explicit SimSurgeon(const SimSurgeonSettings& settings) noexcept;

    // Before pull(): hand position and contact force over a time h.
    void step(double h_s, const Vec3& at_m, const Vec3& contact_n, bool powered) noexcept TACT_RT;
    [[nodiscard]] Wrench pull(const Pose& pose, const Twist& twist) const noexcept TACT_RT;

    [[nodiscard]] Pose begin() const noexcept;
    [[nodiscard]] std::uint32_t buttons() const noexcept { return works_ ? 1U << 1 : 0U; }
    [[nodiscard]] bool met() const noexcept { return met_; }

private:
    static constexpr double kOffAtFirstS = 1e3;  // the device starts as if off for a long time
    // One series of strokes, computed from its number.
    struct Series {
        Vec3 along = Vec3::UnitX(), across = Vec3::UnitY();
        double press_n = 1.0;
    };
    [[nodiscard]] Series series(std::uint64_t number) const noexcept TACT_RT;
    void seek(double h_s, const Vec3& at_m) noexcept TACT_RT;
    void work(double h_s) noexcept TACT_RT;
    void towards(const Vec3& goal_m, double h_s) noexcept TACT_RT;

    SimSurgeonSettings settings_;
    Vec3 begin_m_, spot_m_, target_m_;
    Vec3 met_m_ = Vec3::Zero();
    bool met_ = false, works_ = false, back_ = false;
    double on_s_ = 0.0, off_s_ = kOffAtFirstS, worked_s_ = 0.0, contact_n_ = 0.0, press_n_ = 0.0;
    std::uint32_t missed_ = 0;
    std::uint64_t number_ = 0;
    Series series_;
};

}  // namespace tact
