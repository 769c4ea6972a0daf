#include "rt/safety/output_chain.hpp"

#include <algorithm>

#include "rt/safety/stages.hpp"

namespace tact {

OutputChain::OutputChain(const ChainSettings& settings) noexcept
    : settings_(settings),
      translation_(settings.translation),
      rotation_(settings.rotation),
      heat_(settings.heat_start) {}

ChainOutput OutputChain::apply(const ChainInput& in) noexcept {
    ChainOutput out;
    const double elapsed_s = std::max(to_s(in.dt), 0.0);
    const double dt_s = std::min(elapsed_s, to_s(stages::kStepMax));

    // Finite. Checks also the pose, because later stages use it.
    Wrench w = in.wanted_dev;
    const bool pose_finite = in.T_dev_tool.finite();
    if (!in.wanted_dev.finite() || !pose_finite) {
        out.acts |= kChainNotFinite;
        w = {};
    }
    const Pose pose = pose_finite ? in.T_dev_tool : pose_before_;
    out.wanted_n = w.force_n.stableNorm();
    out.wanted_n_m = w.torque_n_m.stableNorm();

    // Passivity.
    if (settings_.passivity && pose_known_) {
        const Vec3 moved = pose.p_m - pose_before_.p_m;
        const Vec3 turned = rotation_vector_rad(pose.q * pose_before_.q.conjugate());
        const Wrench asked = w;
        w.force_n = translation_.shape(w.force_n, moved, elapsed_s);
        w.torque_n_m = rotation_.shape(w.torque_n_m, turned, elapsed_s);
        if (w.force_n != asked.force_n || w.torque_n_m != asked.torque_n_m) out.acts |= kChainPassivity;
    }
    pose_before_ = pose;
    pose_known_ = pose_known_ || pose_finite;

    // Walls of the workspace.
    const Vec3 wall_n = stages::wall_force_n(pose.p_m, settings_.workspace_half_m, settings_.wall_margin_m,
                                             settings_.wall_stiffness_n_m * in.wall_gain);
    if (!wall_n.isZero(0.0)) out.acts |= kChainWall;
    w.force_n += wall_n;

    // Saturation.
    const Wrench unlimited = w;
    w.force_n = stages::saturated(w.force_n, settings_.force_n_max);
    w.torque_n_m = stages::saturated(w.torque_n_m, settings_.torque_n_m_max);
    if (w.force_n != unlimited.force_n) out.acts |= kChainForce;
    if (w.torque_n_m != unlimited.torque_n_m) out.acts |= kChainTorque;

    // Motor heat.
    const double warm_n_max =
        stages::heat_limit_n(heat_, settings_.force_n_max, settings_.force_n_continuous);
    const Vec3 cool_n = stages::saturated(w.force_n, warm_n_max);
    if (cool_n != w.force_n) out.acts |= kChainHeat;
    w.force_n = cool_n;

    // Slew.
    const Wrench steep = w;
    w.force_n = stages::slewed(before_ramp_.force_n, w.force_n, settings_.force_slew_n_s * dt_s);
    w.torque_n_m = stages::slewed(before_ramp_.torque_n_m, w.torque_n_m, settings_.torque_slew_n_m_s * dt_s);
    if (w.force_n != steep.force_n) out.acts |= kChainSlew;
    if (w.torque_n_m != steep.torque_n_m) out.acts |= kChainTorqueSlew;
    out.step_n = (steep.force_n - before_ramp_.force_n).stableNorm();
    out.step_n_m = (steep.torque_n_m - before_ramp_.torque_n_m).stableNorm();
    before_ramp_ = w;

    // Ramp.
    gain_ = stages::ramped(gain_, in.force_on, dt_s, settings_.ramp_in_s, settings_.ramp_out_s);
    w.force_n *= gain_;
    w.torque_n_m *= gain_;

    // Gate.
    if (!in.gate_open || !pose_finite || !w.finite()) {
        restart();
        w = {};
        out.enable = false;
    } else {
        out.enable = in.amplifier || gain_ > 0.0;  // without a gain there is no wrench
    }
    translation_.applied(w.force_n);
    rotation_.applied(w.torque_n_m);
    heat_ = stages::heated(heat_, w.force_n.norm(), settings_.force_n_continuous, settings_.heat_tau_s,
                           elapsed_s);

    out.wrench_dev = w;
    out.gain = gain_;
    out.heat = heat_;
    return out;
}

void OutputChain::restart() noexcept {
    before_ramp_ = {};
    gain_ = 0.0;
    translation_.forget();
    rotation_.forget();
}

}  // namespace tact
