// Parameters of each arm: lengths, encoders, drives, limits, motors, weight; each value with its source.
//
// Units    of the data sheets and of [arm] in the configuration, which may override every value
// Joints   turret, thigh, shin, then the gimbal's yaw, pitch, roll; signs and zeros as in arm_kinematics.hpp
// Errors   StartupError, with the known models
// Thread   start-up only
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace tact {

enum class FigureSource : std::uint8_t { unknown, verified, derived, remembered, configured };

struct Figure {
    double value = std::numeric_limits<double>::quiet_NaN();
    FigureSource source = FigureSource::unknown;

    [[nodiscard]] bool known() const noexcept { return source != FigureSource::unknown; }
};

enum class Wrist : std::uint8_t { none, sensed, driven };
enum class CalibrationStyle : std::uint8_t { reset_pose, inkwell, automatic };

struct ArmParameterSet {
    std::string model, name;
    Wrist wrist = Wrist::none;
    CalibrationStyle calibration = CalibrationStyle::reset_pose;
    Figure thigh_mm, shin_mm;
    std::array<Figure, 3> origin_mm;        // middle of the workspace, relative to the tip in the reset pose
    std::array<Figure, 3> workspace_mm;     // full widths x, y, z
    std::array<Figure, 6> counts_per_turn;  // of the encoder's shaft; negative: reversed count direction
    std::array<Figure, 6> drive_ratio;      // turns of motor and encoder per turn of the joint
    std::array<Figure, 6> low_deg, high_deg;
    std::array<Figure, 2> elbow_deg;        // shin minus thigh, lowest and highest
    std::array<Figure, 6> calibration_deg;  // joint angles in the calibration pose
    Figure force_n_max, force_n_continuous, stiffness_n_mm_max;
    std::array<Figure, 3> torque_mn_m_max, torque_mn_m_continuous;  // of the gimbal's joints
    std::array<Figure, 6> torque_constant_mn_m_a;                   // of the motors
    std::array<Figure, 6> current_a_max, current_a_continuous;  // a negative torque constant reverses a motor
    Figure motor_ohm, winding_c_max;                            // of the three motors of the arm
    std::array<Figure, 2> motor_k_w, motor_tau_s;               // winding, housing
    std::array<Figure, 2> gravity_mn_m;                         // factors of cos(thigh), sin(shin)
    Figure tip_mass_g;                                          // additional mass at the tip: handle, gimbal
    Figure viscous_n_m_s, coulomb_n_m, apparent_mass_g;  // friction per joint, apparent mass at the tip
};

// Known models, and their parameters. Throws StartupError that lists the known models.
[[nodiscard]] std::vector<std::string> arm_models();
[[nodiscard]] ArmParameterSet arm_parameter_set(const std::string& model);

// One key of [arm]. A key of joints takes three numbers (the arm's joints) or six.
struct ArmKey {
    const char* name;
    std::span<Figure> metrics;
    double low, high;  // permitted range
    const char* what;
};
[[nodiscard]] std::vector<ArmKey> arm_keys(ArmParameterSet& metrics);

}  // namespace tact
