// The only path from the force of a model to the force sent to a device.
//
// Order     finite, passivity, workspace walls, saturation, motor heat, slew, ramp, enable gate
// Runs on   servo thread, every cycle, constant time
// Frame     device
// Owns      energy account, motor heat, the wrench before the ramp, the ramp's gain
// Fails by  reducing the force and reporting which stage acted. A force that is not finite becomes zero here and a
//           fault in the state machine
#pragma once

#include <cstdint>

#include "ipc/base/clock.hpp"
#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"
#include "rt/safety/passivity.hpp"

namespace tact {

struct ChainSettings {
    double force_n_max = 3.3;  // already limited to the device's maximum
    double torque_n_m_max = 0.2;
    double force_slew_n_s = 500.0;  // 3.3 N in 7 ms: fast enough not to be noticed, too slow for a jolt
    double torque_slew_n_m_s = 30.0;
    double ramp_in_s = 0.5;
    double ramp_out_s = 0.05;  // half of the time allowed after a signal
    Vec3 workspace_half_m = Vec3::Constant(0.1);
    double wall_margin_m = 0.005;
    double wall_stiffness_n_m = 500.0;
    double force_n_continuous = 0.0;  // 0: unknown, no heat model
    double heat_tau_s = 60.0;         // 0: no heat model
    double heat_start = 0.0;
    bool passivity = false;
    PassivitySettings translation;
    PassivitySettings rotation{.inertia = 2e-4, .position_step = 5e-4, .felt = 0.01, .energy_start_j = 0.0};
};

enum ChainAct : std::uint32_t {
    kChainNotFinite = 1U << 0,
    kChainPassivity = 1U << 1,
    kChainWall = 1U << 2,
    kChainForce = 1U << 3,
    kChainTorque = 1U << 4,
    kChainHeat = 1U << 5,
    kChainSlew = 1U << 6,
    kChainTorqueSlew = 1U << 7,
};

struct ChainInput {
    Wrench wanted_dev;
    Pose T_dev_tool;
    Duration dt{0};          // since the last cycle
    bool force_on = false;   // ramp towards full force, else towards zero
    bool gate_open = false;  // false: force zero and amplifier off at once
    bool amplifier = false;  // requested on; it also stays on while the ramp runs out
    double wall_gain = 1.0;  // factor on the walls' stiffness for the current delay
};

struct ChainOutput {
    Wrench wrench_dev;
    bool enable = false;
    std::uint32_t acts = 0;  // ChainAct
    double wanted_n = 0.0, wanted_n_m = 0.0;
    double step_n = 0.0, step_n_m = 0.0;  // requested change since the last cycle, before the slew limit
    double gain = 0.0;
    double heat = 0.0;
};

class OutputChain {
public:
    explicit OutputChain(const ChainSettings& settings = {}) noexcept;
    ChainOutput apply(const ChainInput& in) noexcept TACT_RT;
    // Zero force at once; the ramp restarts. After a change of model.
    void restart() noexcept TACT_RT;
    [[nodiscard]] const ChainSettings& settings() const noexcept { return settings_; }

private:
    ChainSettings settings_;
    PassivityControl translation_, rotation_;
    Pose pose_before_;
    bool pose_known_ = false;
    Wrench before_ramp_;
    double gain_ = 0.0;
    double heat_ = 0.0;
};

}  // namespace tact
