// Time-domain passivity control: takes out, as damping, the energy that a sampled force field has made up.
//
// Runs on   servo thread, every cycle, constant time; one for translation, one for rotation
// Owns      the energy that went into the environment and what was applied last
// Units     either newtons and metres, or newton-metres and radians
// Bounds    the damping never exceeds what half the moving mass stands at this rate, nor what one step of the
//           encoder would turn into a force that is felt; without the second bound the control itself becomes
//           active at high rates
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
    double felt = 0.2;            // N or N m, what one step may cause
    double energy_start_j =
        0.0;  // lent at the start: a potential that draws the hand gives back stored energy
};

class PassivityControl {
public:
    explicit PassivityControl(const PassivitySettings& settings = {}) noexcept
        : settings_(settings), energy_j_(settings.energy_start_j) {}

    // moved: since the last call. Gives the force to apply instead of wanted.
    Vec3 shape(const Vec3& wanted, const Vec3& moved, double dt_s) noexcept TACT_RT {
        energy_j_ -= applied_.dot(moved);
        const double distance2 = moved.squaredNorm();
        if (energy_j_ >= 0.0 || distance2 <= 0.0 || dt_s <= 0.0) return wanted;
        const double bound =
            std::min(0.5 * settings_.inertia / dt_s, settings_.felt * dt_s / settings_.position_step);
        const double damping = std::min(-energy_j_ * dt_s / distance2, bound);
        return wanted - damping / dt_s * moved;
    }
    // What really went out after the later stages; the books are kept on that.
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
