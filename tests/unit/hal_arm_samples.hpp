// Arms for tests: the models of the table, with made-up values for unknown parameters.
#pragma once

#include "hal/arm/arm_kinematics.hpp"
#include "hal/arm/arm_parameters.hpp"
#include "hal/arm/arm_table.hpp"

namespace tact::sample {

inline ArmParameterSet complete_parameters(const std::string& model) {
    ArmParameterSet f = arm_parameter_set(model);
    for (const ArmKey& key : arm_keys(f)) {
        const std::string name = key.name;
        double value = name == "low_deg" ? -25.0 : name == "high_deg" ? 80.0 : 0.0;
        if (name == "thigh_mm" || name == "shin_mm") value = 150.0;
        if (name == "origin_mm") value = 0.0;
        if (name == "workspace_mm") value = 120.0;
        if (name == "counts_per_turn") value = 8192.0;
        if (name == "drive_ratio") value = 9.0;
        if (name == "torque_constant_mn_m_a") value = 200.0;
        if (name == "current_a_max") value = 3.0;
        if (name == "current_a_continuous") value = 1.0;
        const bool optional = name == "gravity_mn_m" || name == "tip_mass_g" || name == "motor_ohm" ||
                              name == "motor_k_w" || name == "motor_tau_s" || name == "winding_c_max" ||
                              name == "viscous_n_m_s" || name == "coulomb_n_m" || name == "apparent_mass_g" ||
                              name == "torque_mn_m_max" || name == "torque_mn_m_continuous";
        if (optional) continue;
        for (std::size_t i = 0; i < key.metrics.size(); ++i) {
            if (key.metrics[i].known()) continue;
            if (name == "elbow_deg") value = i == 0 ? -70.0 : 70.0;
            key.metrics[i] = {value, FigureSource::configured};
        }
    }
    return f;
}

inline ArmKinematics arm(const std::string& model) {
    return ArmKinematics(arm_parameters(complete_parameters(model)));
}

inline Joint6 joints(double turret, double thigh, double shin, double yaw = 0.0, double pitch = 0.0,
                     double roll = 0.0) {
    Joint6 q;
    q << turret, thigh, shin, yaw, pitch, roll;
    return q;
}

}  // namespace tact::sample
