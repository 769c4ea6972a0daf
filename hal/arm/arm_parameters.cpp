#include "hal/arm/arm_parameters.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"

namespace tact {

namespace {

// In SI units; 0 for an unknown value.
template <std::size_t N>
Eigen::Matrix<double, static_cast<int>(N), 1> in_si(const std::array<Figure, N>& metrics, double unit) {
    Eigen::Matrix<double, static_cast<int>(N), 1> v = Eigen::Matrix<double, static_cast<int>(N), 1>::Zero();
    for (std::size_t i = 0; i < N; ++i) {
        if (metrics[i].known()) v[static_cast<Eigen::Index>(i)] = metrics[i].value * unit;
    }
    return v;
}

double or_zero(const Figure& f) { return f.known() ? f.value : 0.0; }

// Keys of required parameters without a value.
class Missing {
public:
    void need(const char* key, std::span<const Figure> metrics) {
        for (const Figure& f : metrics) {
            if (f.known()) continue;
            text_ += (text_.empty() ? "" : ", ") + std::string(key);
            return;
        }
    }
    [[nodiscard]] const std::string& text() const { return text_; }

private:
    std::string text_;
};

void require_complete(const ArmParameterSet& f) {
    Missing m;
    const std::size_t sensed = f.wrist == Wrist::none ? 3 : 6, driven = f.wrist == Wrist::driven ? 6 : 3;
    const auto joints = [](const std::array<Figure, 6>& all, std::size_t n) {
        return std::span<const Figure>(all).first(n);
    };
    m.need("thigh_mm", {&f.thigh_mm, 1});
    m.need("shin_mm", {&f.shin_mm, 1});
    m.need("origin_mm", f.origin_mm);
    m.need("workspace_mm", f.workspace_mm);
    m.need("counts_per_turn", joints(f.counts_per_turn, sensed));
    m.need("drive_ratio", joints(f.drive_ratio, sensed));
    m.need("low_deg", joints(f.low_deg, sensed));
    m.need("high_deg", joints(f.high_deg, sensed));
    m.need("elbow_deg", f.elbow_deg);
    m.need("calibration_deg", joints(f.calibration_deg, sensed));
    m.need("force_n_max", {&f.force_n_max, 1});
    m.need("force_n_continuous", {&f.force_n_continuous, 1});
    m.need("stiffness_n_mm_max", {&f.stiffness_n_mm_max, 1});
    m.need("torque_constant_mn_m_a", joints(f.torque_constant_mn_m_a, driven));
    m.need("current_a_max", joints(f.current_a_max, driven));
    m.need("current_a_continuous", joints(f.current_a_continuous, driven));
    if (f.wrist == Wrist::driven) {
        m.need("torque_mn_m_max", f.torque_mn_m_max);
        m.need("torque_mn_m_continuous", f.torque_mn_m_continuous);
    }
    if (!m.text().empty()) {
        throw StartupError(
            "arm \"" + f.model + "\" (" + f.name + ")", "no published value is known for: " + m.text(),
            "measure them, or take them from the device's data sheet, and set them under [arm]; "
            "hal/arm/README.md explains each key");
    }
}

void require_sense(const ArmParameterSet& f, const ArmParameters& p) {
    const auto wrong = [&f](const std::string& what) {
        throw StartupError("arm \"" + f.model + "\"", what, "correct it under [arm] in the configuration");
    };
    const Eigen::Index joints = f.wrist == Wrist::none ? 3 : 6;
    for (Eigen::Index i = 0; i < joints; ++i) {
        if (p.low_rad[i] >= p.high_rad[i])
            wrong("low_deg is not below high_deg in joint " + std::to_string(i));
        if (std::abs(p.rad_per_count[i]) > 0.02) {
            wrong("an encoder step of more than a degree in joint " + std::to_string(i));
        }
        if (p.current_a_continuous[i] > p.current_a_max[i]) {
            wrong("current_a_continuous is above current_a_max in joint " + std::to_string(i));
        }
    }
    if (p.elbow_low_rad >= p.elbow_high_rad) wrong("elbow_deg is not a range");
    if (p.force_n_continuous > p.force_n_max) wrong("force_n_continuous is above force_n_max");
    for (Eigen::Index i = 0; i < 3; ++i) {
        if (p.torque_n_m_continuous[i] > p.torque_n_m_max[i]) {
            wrong("torque_mn_m_continuous is above torque_mn_m_max");
        }
    }
}

}  // namespace

ArmParameters arm_parameters(const ArmParameterSet& f) {
    require_complete(f);
    ArmParameters p;
    p.model = f.model;
    p.name = f.name;
    p.wrist = f.wrist;
    p.calibration = f.calibration;
    p.thigh_m = f.thigh_mm.value * kMillimetreM;
    p.shin_m = f.shin_mm.value * kMillimetreM;
    p.origin_m = in_si(f.origin_mm, kMillimetreM);
    p.workspace_half_m = in_si(f.workspace_mm, 0.5 * kMillimetreM);
    const Joint6 ratio = in_si(f.drive_ratio, 1.0), counts = in_si(f.counts_per_turn, 1.0);
    const Eigen::Index sensed = f.wrist == Wrist::none ? 3 : 6, driven = f.wrist == Wrist::driven ? 6 : 3;
    for (Eigen::Index i = 0; i < sensed; ++i) {
        // Counts of 0 would give an infinite step, which the check below rejects.
        p.rad_per_count[i] = 2.0 * std::numbers::pi / (counts[i] * ratio[i]);
    }
    p.low_rad = in_si(f.low_deg, kDegreeRad);
    p.high_rad = in_si(f.high_deg, kDegreeRad);
    p.elbow_low_rad = f.elbow_deg[0].value * kDegreeRad;
    p.elbow_high_rad = f.elbow_deg[1].value * kDegreeRad;
    p.calibration_rad = in_si(f.calibration_deg, kDegreeRad);
    p.force_n_max = f.force_n_max.value;
    p.force_n_continuous = f.force_n_continuous.value;
    p.stiffness_n_m_max = f.stiffness_n_mm_max.value / kMillimetreM;
    if (f.wrist == Wrist::driven) {
        p.torque_n_m_max = in_si(f.torque_mn_m_max, 1e-3);
        p.torque_n_m_continuous = in_si(f.torque_mn_m_continuous, 1e-3);
    }
    const Joint6 constant = in_si(f.torque_constant_mn_m_a, 1e-3);
    const Joint6 max = in_si(f.current_a_max, 1.0), continuous = in_si(f.current_a_continuous, 1.0);
    for (Eigen::Index i = 0; i < driven; ++i) {
        p.joint_n_m_per_a[i] = constant[i] * ratio[i];
        p.current_a_max[i] = max[i];
        p.current_a_continuous[i] = continuous[i];
        if (constant[i] == 0.0) {
            throw StartupError("arm \"" + f.model + "\"", "torque_constant_mn_m_a is 0",
                               "correct it under [arm] in the configuration");
        }
    }
    p.heat_known = f.motor_ohm.known() && f.winding_c_max.known() && f.motor_k_w[0].known() &&
                   f.motor_k_w[1].known() && f.motor_tau_s[0].known() && f.motor_tau_s[1].known();
    if (p.heat_known) {
        p.heat = {f.motor_ohm.value,      f.motor_k_w[0].value,   f.motor_k_w[1].value,
                  f.motor_tau_s[0].value, f.motor_tau_s[1].value, f.winding_c_max.value};
    }
    p.gravity_thigh_n_m = or_zero(f.gravity_mn_m[0]) * 1e-3;
    p.gravity_shin_n_m = or_zero(f.gravity_mn_m[1]) * 1e-3;
    p.tip_mass_kg = or_zero(f.tip_mass_g) * 1e-3;
    p.viscous_n_m_s = or_zero(f.viscous_n_m_s);
    p.coulomb_n_m = or_zero(f.coulomb_n_m);
    p.apparent_mass_kg = or_zero(f.apparent_mass_g) * 1e-3;
    require_sense(f, p);
    return p;
}

}  // namespace tact
