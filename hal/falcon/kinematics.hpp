// Forward and inverse kinematics of the Falcon's three legs, and the motor torques for a force at the grip.
//
// Frame    device: x right, y up, z to the user, parallel to the table; origin middle_z_m in front of the
//          base, about the middle of the workspace
// Legs     0 top, 1 right, 2 left; angle of a thigh from the base's plane, positive pushes the grip to the user
// Lengths  from the open driver libnifalcon (FalconGeometry.h)
// Torque   Martin and Hillier, "Characterisation of the Novint Falcon haptic device for application as a
//          robot manipulator", ACRA 2009: a step of the command is 1.9835e-5 N m at the motor, geared 7.62
// Unsure   not yet tested on hardware. Sources differ in the angle at count 0 (35, 40, 50 degrees; 35 here), in the
//          gear (7.62, 7.72) and in lengths by up to 5 mm: positions are accurate to some millimetres, distances
//          and forces to some percent
// Thread   any: pure functions of their arguments; TACT_RT
//
// The derivation is at the top of the .cpp.
#pragma once

#include <array>
#include <cstdint>
#include <numbers>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"

namespace tact::falcon {

using Counts3 = std::array<std::int16_t, 3>;
using Torque3 = std::array<std::int16_t, 3>;  // steps of the command, as sent to the device

inline constexpr double kDegree = std::numbers::pi / 180.0;

struct Geometry {
    double thigh_m = 0.060;           // a
    double shin_m = 0.1025;           // b, the long link of the parallelogram
    double grip_m = 0.01443;          // c, from the parallelogram's end to the middle of the grip, radially
    double ends_m = 2 * 0.01125;      // d + e, the parallelogram's short links at knee and grip
    double grip_across_m = -0.025;    // f, as c, tangentially
    double base_m = 0.040;            // r, from the middle of the base to a hip, radially
    double base_across_m = -0.02309;  // s, tangentially
    std::array<double, 3> leg_rad{105.0 * kDegree, -15.0 * kDegree, -135.0 * kDegree};  // about z, from x
    double zero_rad = 35.0 * kDegree;                                                   // at count 0
    double gear = 7.62;             // motor turns per turn of its thigh
    double counts_per_turn = 1280;  // of a motor: 320 slots, four edges each
    double motor_n_m_per_step = 1.9835e-5;
    double middle_z_m = 0.120;
};

inline constexpr std::int16_t kTorqueMax = 4095;  // steps: 0.62 N m at a thigh, 6 to 9 N at the grip
inline constexpr std::int16_t kCountMax = 2600;   // unreachable by any thigh: -61 to 131 degrees
inline constexpr double kWorkspaceHalfM = 0.035;  // box about the origin, within +-2000 counts of each leg
inline constexpr double kReachM = 0.10;           // from the origin: beyond the reach of the grip
inline constexpr double kForceMaxN = 8.9;         // two pounds, from the manufacturer

struct ArmConfiguration {
    Vec3 leg_rad = Vec3::Zero();
    Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();  // of the grip's position by the leg angles, m
    double spread = 0.0;    // volume spanned by the shins' directions, 0 to 1; 0: the grip is not held
    double leverage = 0.0;  // least fraction of a thigh's force along its shin; 0: leg stretched
    bool good = false;      // the configuration exists, and both measures reach kPoorest

    static constexpr double kPoorest = 0.1;
};

struct Drive {
    Torque3 torque{};
    double share = 0.0;  // output fraction of the force, 0 to 1
    bool valid = false;
};

class Kinematics {
public:
    explicit Kinematics(const Geometry& geometry = {});

    [[nodiscard]] const Geometry& geometry() const noexcept { return g_; }
    [[nodiscard]] double rad_per_count() const noexcept { return rad_per_count_; }

    [[nodiscard]] Vec3 angles_rad(const Counts3& counts) const noexcept TACT_RT;
    // The nearest counts, clamped to 16 bits.
    [[nodiscard]] Counts3 counts(const Vec3& leg_rad) const noexcept TACT_RT;

    // Leg angles for this grip position, knees outwards. False: out of reach.
    [[nodiscard]] bool inverse(const Vec3& grip_m, Vec3& leg_rad) const noexcept TACT_RT;
    // Grip position for these angles. near_m: start of the search, such as the last position; a search from
    // the origin also succeeds, in more steps. False: no solution within reach; grip_m is unchanged.
    [[nodiscard]] bool forward(const Vec3& leg_rad, const Vec3& near_m, Vec3& grip_m) const noexcept TACT_RT;
    [[nodiscard]] ArmConfiguration configuration(const Vec3& grip_m) const noexcept TACT_RT;

    // Command steps for a force at the grip. Beyond kForceMaxN or kTorqueMax the force is scaled down and
    // keeps its direction. Zero for a non-finite force or a configuration that is not good.
    [[nodiscard]] Drive drive(const ArmConfiguration& configuration,
                              const Vec3& force_n) const noexcept TACT_RT;
    // The inverse: the force of these steps.
    [[nodiscard]] Vec3 force_n(const ArmConfiguration& configuration,
                               const Torque3& torque) const noexcept TACT_RT;
    // The largest motion of the grip for one count, at the origin.
    [[nodiscard]] double position_step_m() const noexcept;

private:
    struct Leg {
        Vec3 gradient;      // of the closure condition by the grip's position, m
        double turn = 0.0;  // derivative of the closure condition by the leg's angle, m^2
        double gap = 0.0;   // m^2; 0 when the leg closes
    };
    [[nodiscard]] Vec3 in_leg(std::size_t leg, const Vec3& grip_m) const noexcept;
    [[nodiscard]] Leg leg(std::size_t i, const Vec3& grip_m, double angle_rad) const noexcept;

    Geometry g_;
    double rad_per_count_, torque_per_step_;
    std::array<Vec3, 3> radial_, across_;
};

}  // namespace tact::falcon
