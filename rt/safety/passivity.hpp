// Time-domain passivity control: dissipates by damping the energy that a sampled force field generates.
//
// Runs on   servo thread, every cycle, constant time; one for translation, one for rotation
// Owns      the energy that went into the environment, and the force applied last
// Units     either newtons and metres, or newton-metres and radians
// Bounds    the damping stays below m / (2 T) for the moving mass m and the period T, and below the value at which one
//           encoder step causes a perceptible force; without the second bound the control itself is active at high
//           rates
//
// Hannaford, Ryu, "Time-domain passivity control of haptic interfaces" (2002); Preusche et al. (2003).
#pragma once

#include <algorithm>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

struct PassivitySettings {
    double inertia = 0.136;       // kg or kg m^2, of the moving parts of the device
    double position_step = 3e-5;  // m or rad, one encoder step
    double felt = 0.2;            // N or N m, force that one encoder step may cause
    double energy_start_j =
        0.0;  // initial credit, for a potential that attracts the hand with its stored energy
};

class PassivityControl {
public:
    explicit PassivityControl(const PassivitySettings& settings = {}) noexcept
        : settings_(settings), energy_j_(settings.energy_start_j) {}

    // moved: displacement since the last call. Returns the force to apply instead of wanted.
    Vec3 shape(const Vec3& wanted, const Vec3& moved, double dt_s) noexcept TACT_RT {
        energy_j_ -= applied_.dot(moved);
        const double distance2 = moved.squaredNorm();
        if (energy_j_ >= 0.0 || distance2 <= 0.0 || dt_s <= 0.0) return wanted;
        const double bound =
            std::min(0.5 * settings_.inertia / dt_s, settings_.felt * dt_s / settings_.position_step);
        const double damping = std::min(-energy_j_ * dt_s / distance2, bound);
        return wanted - damping / dt_s * moved;
    }
    // Sets the force sent after the later stages; the energy account uses this force.
    void applied(const Vec3& force) noexcept TACT_RT { applied_ = force; }
    void forget() noexcept TACT_RT {
        energy_j_ = settings_.energy_start_j;
        applied_ = Vec3::Zero();
    }
    [[nodiscard]] double energy_j() const noexcept { return energy_j_; }

private:
    PassivitySettings settings_;
    double energy_j_;
    Vec3 applied_ = Vec3::Zero();
};

}  // namespace tact
