// From a wrench at the tip to the currents of the motors, within what motors and device stand.
//
// Limits   the wrench is first held to the device's largest force and torque, then shortened as a whole
//          until no motor is asked for more than its limit: the hand feels less, never another direction
// Weight   the torques that hold the arm up come first and are not shortened with the wrench; a motor that
//          cannot even do that does what it can, and nothing of the wrench is shown
// Fails by currents of zero and valid = false for anything that is not a finite number
// Thread   servo; TACT_RT, no state
#pragma once

#include "hal/arm/arm_kinematics.hpp"

namespace tact {

struct DriveCurrents {
    Joint6 current_a = Joint6::Zero();
    double share = 0.0;  // of the wrench that the currents show, 0 to 1
    bool valid = false;
};

// limit_a: of each motor now, cold or warm; no more than the arm's current_a_max counts.
// hold_n_m: torques at the joints that come first, as ArmKinematics::gravity_n_m gives them; or zero.
[[nodiscard]] DriveCurrents drive_currents(const ArmKinematics& arm, const Joint6& q,
                                           const Wrench& wrench_dev, const Joint6& hold_n_m,
                                           const Joint6& limit_a) noexcept TACT_RT;

}  // namespace tact
