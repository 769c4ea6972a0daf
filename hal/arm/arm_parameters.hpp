// Parameters of an arm in SI, complete and checked, for the rest of hal/arm.
//
// Errors   StartupError for an unknown parameter, with the keys to set, and for contradictory parameters
// Thread   start-up only
#pragma once

#include "hal/arm/arm_table.hpp"
#include "ipc/base/motor_heat.hpp"
#include "ipc/base/pose.hpp"

namespace tact {

using Joint6 = Eigen::Matrix<double, 6, 1>;

struct ArmParameters {
    std::string model, name;
    Wrist wrist = Wrist::none;
    CalibrationStyle calibration = CalibrationStyle::reset_pose;
    double thigh_m = 0.0, shin_m = 0.0;
    Vec3 origin_m = Vec3::Zero();           // see origin_mm
    Vec3 workspace_half_m = Vec3::Zero();   // box about the device's origin
    Joint6 rad_per_count = Joint6::Zero();  // 0: no encoder
    Joint6 low_rad = Joint6::Zero(), high_rad = Joint6::Zero();
    double elbow_low_rad = 0.0, elbow_high_rad = 0.0;
    Joint6 calibration_rad = Joint6::Zero();
    double force_n_max = 0.0, force_n_continuous = 0.0, stiffness_n_m_max = 0.0;
    Vec3 torque_n_m_max = Vec3::Zero(), torque_n_m_continuous = Vec3::Zero();
    Joint6 joint_n_m_per_a = Joint6::Zero();  // torque constant times drive ratio; 0: no motor
    Joint6 current_a_max = Joint6::Zero(), current_a_continuous = Joint6::Zero();
    bool heat_known = false;  // false: currents are limited to the continuous current
    MotorHeatParameters heat;
    double gravity_thigh_n_m = 0.0, gravity_shin_n_m = 0.0;  // 0 when unknown: no compensation
    double tip_mass_kg = 0.0;
    double viscous_n_m_s = 0.0, coulomb_n_m = 0.0, apparent_mass_kg = 0.0;
};

// Complete and consistent, or StartupError that names every missing parameter and its key.
[[nodiscard]] ArmParameters arm_parameters(const ArmParameterSet& metrics);

}  // namespace tact
