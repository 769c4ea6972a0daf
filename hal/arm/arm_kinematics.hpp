// Forward and inverse kinematics of an arm, and the joint torques for a wrench at the tip.
//
// Frame   device: x right, y up, z to the user, origin at the middle of the workspace
// Joints  0 turret, left +; 1 thigh, up +, 0 horizontal towards the user; 2 shin, absolute, up +, 0 straight down
//         (a parallel linkage drives it: it keeps its direction while the thigh moves);
//         3 yaw about the shin; 4 pitch; 5 roll about the stylus. All 0 is the reset pose.
// Wrench  at the tip, in device axes. The gimbal's axes meet at the tip.
// Thread  any: pure functions of their arguments; TACT_RT
//
// The derivation is at the top of the .cpp.
#pragma once

#include <array>
#include <cstdint>

#include "hal/arm/arm_parameters.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

using Counts6 = std::array<std::int32_t, 6>;
using Jacobian3 = Eigen::Matrix3d;
using Jacobian6 = Eigen::Matrix<double, 6, 6>;  // rows: linear, angular

// Distance of a configuration from singularities and joint limits.
struct ArmConfiguration {
    double reach_m = 0.0;        // A, from the turret's axis; singular at 0: no force along x
    double elbow_cos = 0.0;      // cos(shin - thigh); singular at 0: no force along the arm
    double wrist_cos = 0.0;      // cos(pitch); singular at 0: yaw and roll rotate about the same axis
    double to_limit_rad = 0.0;   // to the nearest joint limit; negative: beyond it
    bool near_singular = false;  // reach below a tenth of the thigh, or elbow_cos or wrist_cos below 0.1
};

class ArmKinematics {
public:
    explicit ArmKinematics(const ArmParameters& parameters) : p_(parameters) {}

    [[nodiscard]] const ArmParameters& parameters() const noexcept { return p_; }

    // zero: the counts in the pose of parameters().calibration_rad.
    [[nodiscard]] Joint6 angles_rad(const Counts6& counts, const Counts6& zero) const noexcept TACT_RT;
    // The nearest counts, clamped to 32 bits.
    [[nodiscard]] Counts6 counts(const Joint6& q, const Counts6& zero) const noexcept TACT_RT;

    [[nodiscard]] Vec3 tip_m(const Joint6& q) const noexcept TACT_RT;
    // The orientation of an arm whose wrist is not sensed is the identity.
    [[nodiscard]] Pose pose(const Joint6& q) const noexcept TACT_RT;
    [[nodiscard]] Jacobian3 jacobian(const Joint6& q) const noexcept TACT_RT;
    [[nodiscard]] Jacobian6 jacobian6(const Joint6& q) const noexcept TACT_RT;
    [[nodiscard]] Twist twist(const Joint6& q, const Joint6& rad_s) const noexcept TACT_RT;

    // The configuration with the tip at this pose: elbow up, turret within 90 degrees, wrist within its limits where
    // possible. False: out of reach; q is then the nearest along the line from the shoulder.
    [[nodiscard]] bool inverse(const Pose& T_dev_tool, Joint6& q) const noexcept TACT_RT;

    // Joint torques for the wrench: J^T w. Without motors in the wrist, the torque is ignored, and the arm's own
    // joints do not replace it. No joint exceeds |force| (thigh + shin) + |torque|.
    [[nodiscard]] Joint6 torque_n_m(const Joint6& q, const Wrench& wrench_dev) const noexcept TACT_RT;
    // Joint torques that hold the arm's own weight.
    [[nodiscard]] Joint6 gravity_n_m(const Joint6& q) const noexcept TACT_RT;

    [[nodiscard]] ArmConfiguration configuration(const Joint6& q) const noexcept TACT_RT;
    // Displacement and rotation of the tip for one count of the joint that moves it most.
    [[nodiscard]] double position_step_m(const Joint6& q) const noexcept TACT_RT;
    [[nodiscard]] double turn_step_rad(const Joint6& q) const noexcept TACT_RT;

private:
    [[nodiscard]] Eigen::Index driven() const noexcept { return p_.wrist == Wrist::driven ? 6 : 3; }
    ArmParameters p_;
};

}  // namespace tact
