// The arm table. Sources: (verified) read in a public source, (derived) computed from verified values, (remembered)
// from memory of the manufacturers' data sheets: prefer the value that the device reports, or measure and configure.
//
// Derivations:
// Worked out here:
// - Origin of the Omni. The manufacturer's software reported, in the inkwell, the joints (0, 0.26889, -0.370813)
//   rad, the gimbal (0.000108, 0.797273, -1.94046) rad and the tip (0, -65.5107, -88.1142) mm. The
//   kinematics give the tip (0, 44.489, -53.114) mm from the reset pose, so its origin is at (0, 110, 35)
//   mm, to 0.01 mm; and the three angles give the reported rotation to 1e-5 (hal_arm_kinematics_test).
//   This is also the inkwell configuration for the calibration.
// - Origins of the Premiums: chosen so that the manufacturer's whole box is within reach and farthest from the
//   stretched and the folded arm: on a grid of 10 mm, cos(elbow) is nowhere below 0.44 (1.5) and 0.58
//   (1.0). With the reset pose in the middle, a fifth of the box would be out of reach. Joint limits:
//   the range that the box needs plus 10 degrees.
// - Gimbal of the 6DOF: its data sheet gives 0.0023 degrees for yaw and pitch, 0.0080 for roll.
#include "hal/arm/arm_table.hpp"

#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"

namespace tact {

namespace {

constexpr Figure verified(double v) { return {v, FigureSource::verified}; }
constexpr Figure derived(double v) { return {v, FigureSource::derived}; }
constexpr Figure remembered(double v) { return {v, FigureSource::remembered}; }

template <std::size_t N>
void fill(std::array<Figure, N>& to, FigureSource source, std::initializer_list<double> values) {
    std::size_t i = 0;
    for (const double v : values) to[i++] = {v, source};
}

// Sources of complete rows.
constexpr FigureSource V = FigureSource::verified, D = FigureSource::derived, M = FigureSource::remembered;

// Calibrated where every joint is at 0.
void calibrated_at_zero(ArmParameterSet& f) { fill(f.calibration_deg, D, {0.0, 0.0, 0.0, 0.0, 0.0, 0.0}); }

ArmParameterSet omni() {
    ArmParameterSet f;
    f.name = "Phantom Omni / Touch";
    f.wrist = Wrist::sensed;
    f.calibration = CalibrationStyle::inkwell;
    f.thigh_mm = f.shin_mm = verified(133.35);
    fill(f.origin_mm, D, {0.0, 110.0, 35.0});
    fill(f.workspace_mm, M, {160.0, 120.0, 70.0});
    fill(f.counts_per_turn, V, {15000.0, 15000.0, 15000.0});  // at the joint
    fill(f.drive_ratio, V, {1.0, 1.0, 1.0});
    constexpr double deg = 1.0 / kDegreeRad;
    fill(f.low_deg, V, {-0.98 * deg, 0.0, -0.81 * deg, -2.5 * deg, -1.49 * deg, -2.58 * deg});
    fill(f.high_deg, V, {0.98 * deg, 1.75 * deg, 2.2 * deg, 2.5 * deg, 0.91 * deg, 2.58 * deg});
    f.high_deg[2] = derived(2.2 * deg);  // thigh and elbow cannot both be at their upper limits
    fill(f.elbow_deg, V, {-0.81 * deg, 1.25 * deg});
    fill(f.calibration_deg, V, {0.0, 0.26889 * deg, -0.370813 * deg, 0.0, 0.797273 * deg, -1.94046 * deg});
    f.force_n_max = remembered(3.3);
    f.force_n_continuous = remembered(0.88);
    f.stiffness_n_mm_max = verified(0.5);
    return f;
}

ArmParameterSet desktop() {
    ArmParameterSet f;
    f.name = "Phantom Desktop / Touch X";
    f.wrist = Wrist::sensed;
    f.calibration = CalibrationStyle::automatic;
    fill(f.workspace_mm, M, {160.0, 120.0, 120.0});
    calibrated_at_zero(f);
    f.force_n_max = remembered(7.9);
    f.force_n_continuous = remembered(1.75);
    f.stiffness_n_mm_max = remembered(1.5);
    return f;
}

// Parameters common to both sizes.
ArmParameterSet premium() {
    ArmParameterSet f;
    calibrated_at_zero(f);
    f.force_n_max = remembered(8.5);
    f.force_n_continuous = remembered(1.4);
    f.stiffness_n_mm_max = remembered(3.5);
    return f;
}

ArmParameterSet premium_10() {
    ArmParameterSet f = premium();
    f.name = "Phantom Premium 1.0";
    f.thigh_mm = f.shin_mm = remembered(139.7);
    fill(f.origin_mm, D, {0.0, 140.0, 10.0});
    fill(f.workspace_mm, M, {254.0, 178.0, 127.0});
    fill(f.low_deg, D, {-66.0, -10.0, -30.0});
    fill(f.high_deg, D, {66.0, 120.0, 101.0});
    fill(f.elbow_deg, D, {-64.0, 61.0});
    return f;
}

ArmParameterSet premium_15() {
    ArmParameterSet f = premium();
    f.name = "Phantom Premium 1.5";
    f.thigh_mm = verified(209.55);
    f.shin_mm = verified(169.545);
    fill(f.origin_mm, D, {0.0, 170.0, -20.0});
    fill(f.workspace_mm, M, {381.0, 267.0, 191.0});
    fill(f.counts_per_turn, V, {4096.0, 4096.0, 4096.0});
    fill(f.drive_ratio, V, {13.3, 11.2, 11.2});
    fill(f.low_deg, D, {-74.0, -19.0, -53.0});
    fill(f.high_deg, D, {74.0, 117.0, 106.0});
    fill(f.elbow_deg, D, {-74.0, 72.0});
    // Motor RE25.
    fill(f.torque_constant_mn_m_a, V, {23.4, 23.4, 23.4});
    fill(f.current_a_max, V, {5.5, 5.5, 5.5});  // stall
    fill(f.current_a_continuous, V, {1.24, 1.24, 1.24});
    f.motor_ohm = verified(2.18);
    fill(f.motor_k_w, V, {3.1, 14.0});
    fill(f.motor_tau_s, V, {12.0, 612.0});
    f.winding_c_max = verified(100.0);
    fill(f.gravity_mn_m, D, {-16.0, -74.0});
    f.viscous_n_m_s = verified(0.0005);
    f.coulomb_n_m = verified(0.01);
    f.apparent_mass_g = derived(52.0);
    return f;
}

ArmParameterSet premium_15_6dof() {
    ArmParameterSet f = premium_15();
    f.name = "Phantom Premium 1.5/6DOF";
    f.wrist = Wrist::driven;
    for (std::size_t i = 0; i < 3; ++i) {
        constexpr std::array counts{360.0 / 0.0023, 360.0 / 0.0023, 360.0 / 0.0080};
        constexpr std::array half_range{148.5, 130.0, 167.5};
        constexpr std::array max{515.0, 515.0, 170.0}, continuous{188.0, 188.0, 48.0};
        f.counts_per_turn[3 + i] = remembered(counts[i]);
        f.drive_ratio[3 + i] = remembered(1.0);
        f.low_deg[3 + i] = verified(-half_range[i]);
        f.high_deg[3 + i] = verified(half_range[i]);
        f.torque_mn_m_max[i] = remembered(max[i]);
        f.torque_mn_m_continuous[i] = verified(continuous[i]);
    }
    return f;
}

struct Model {
    const char* name;
    ArmParameterSet (*make)();
};
constexpr std::array kModels{Model{"omni", &omni}, Model{"desktop", &desktop},
                             Model{"premium-1.0", &premium_10}, Model{"premium-1.5", &premium_15},
                             Model{"premium-1.5-6dof", &premium_15_6dof}};

}  // namespace

std::vector<std::string> arm_models() {
    std::vector<std::string> names;
    for (const Model& m : kModels) names.emplace_back(m.name);
    return names;
}

ArmParameterSet arm_parameter_set(const std::string& model) {
    std::string known;
    for (const Model& m : kModels) {
        if (model == m.name) {
            ArmParameterSet f = m.make();
            f.model = model;
            return f;
        }
        known += (known.empty() ? "" : ", ") + std::string(m.name);
    }
    throw StartupError("arm \"" + model + "\"", "the table has no arm of this name",
                       "set arm.model to one of: " + known);
}

std::vector<ArmKey> arm_keys(ArmParameterSet& f) {
    const auto one = [](Figure& figure) { return std::span<Figure>(&figure, 1); };
    return {
        {"thigh_mm", one(f.thigh_mm), 10, 2000, "length from shoulder to elbow"},
        {"shin_mm", one(f.shin_mm), 10, 2000, "length from elbow to tip"},
        {"origin_mm", f.origin_mm, -2000, 2000,
         "middle of the workspace, relative to the tip in the reset pose"},
        {"workspace_mm", f.workspace_mm, 10, 4000, "full widths of the workspace"},
        {"counts_per_turn", f.counts_per_turn, -1e7, 1e7,
         "encoder counts per turn of its shaft; negative: reversed"},
        {"drive_ratio", f.drive_ratio, 0.1, 1000, "turns of motor and encoder per turn of the joint"},
        {"low_deg", f.low_deg, -360, 360, "lowest joint angles"},
        {"high_deg", f.high_deg, -360, 360, "highest joint angles"},
        {"elbow_deg", f.elbow_deg, -89, 89, "lowest and highest angle of shin minus thigh"},
        {"calibration_deg", f.calibration_deg, -360, 360, "joint angles in the calibration pose"},
        {"force_n_max", one(f.force_n_max), 0.01, 100, "peak force"},
        {"force_n_continuous", one(f.force_n_continuous), 0.01, 100, "continuous force"},
        {"stiffness_n_mm_max", one(f.stiffness_n_mm_max), 0.01, 100,
         "largest stable stiffness, from the manufacturer"},
        {"torque_mn_m_max", f.torque_mn_m_max, 1, 10000, "peak torque of the gimbal's joints"},
        {"torque_mn_m_continuous", f.torque_mn_m_continuous, 1, 10000,
         "continuous torque of the gimbal's joints"},
        {"torque_constant_mn_m_a", f.torque_constant_mn_m_a, -1000, 1000,
         "torque constant of the motors; negative: reversed"},
        {"current_a_max", f.current_a_max, 0.01, 50, "peak current of the motors"},
        {"current_a_continuous", f.current_a_continuous, 0.01, 50, "continuous current of the motors"},
        {"motor_ohm", one(f.motor_ohm), 0.01, 1000, "winding resistance of the arm's motors at 25 degrees C"},
        {"motor_k_w", f.motor_k_w, 0.01, 1000, "thermal resistances winding to housing, housing to ambient"},
        {"motor_tau_s", f.motor_tau_s, 0.1, 1e5, "thermal time constants of winding, housing"},
        {"winding_c_max", one(f.winding_c_max), 40, 200, "highest permitted winding temperature"},
        {"gravity_mn_m", f.gravity_mn_m, -500, 500,
         "gravity torques: factor of cos(thigh), factor of sin(shin)"},
        {"tip_mass_g", one(f.tip_mass_g), 0, 500, "additional mass at the tip, such as a handle or gimbal"},
        {"viscous_n_m_s", one(f.viscous_n_m_s), 0, 1, "viscous friction of a joint"},
        {"coulomb_n_m", one(f.coulomb_n_m), 0, 1, "Coulomb friction of a joint"},
        {"apparent_mass_g", one(f.apparent_mass_g), 1, 5000, "apparent mass at the tip"},
    };
}

}  // namespace tact
