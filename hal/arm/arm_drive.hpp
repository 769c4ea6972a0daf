// From a wrench at the tip to the currents of the motors, within the limits of motors and device.
//
// Limits   the wrench is first limited to the device's largest force and torque, then scaled down as a whole
//          until no motor exceeds its limit: the hand feels less, never another direction
// Weight   gravity torques have priority and are not scaled with the wrench; a motor too weak to hold the
//          weight gives its limit current, and the output contains nothing of the wrench
// Errors   non-finite input gives zero currents and valid = false
// Thread   servo; TACT_RT, no state
#pragma once

#include "hal/arm/arm_kinematics.hpp"

namespace tact {

struct DriveCurrents {
    Joint6 current_a = Joint6::Zero();
    double share = 0.0;  // output fraction of the wrench, 0 to 1
    bool valid = false;
};

// limit_a: present current limit of each motor; the arm's current_a_max applies in addition.
// hold_n_m: joint torques with priority, from ArmKinematics::gravity_n_m; or zero.
[[nodiscard]] DriveCurrents drive_currents(const ArmKinematics& arm, const Joint6& q,
                                           const Wrench& wrench_dev, const Joint6& hold_n_m,
                                           const Joint6& limit_a) noexcept TACT_RT;

}  // namespace tact
