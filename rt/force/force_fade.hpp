// What is felt comes and goes without a step: a gain on the force of what is in the hand, and the force of
// what left it.
//
// In        the gain rises from 0 to 1 in kRampS, and falls the same way while the clutch is held. It waits until
//           what left is gone.
// Out       after a change of what is in the hand, the last wrench shrinks by 40 N/s and 2 N m/s, whatever
//           happens meanwhile: orders in quick succession do not hold it up. 3.3 N are gone after 83 ms; at
//           1 kHz that is a twelfth of what the slew limit allows. It is a constant force, as that of a body that
//           stays where it was let go.
// Time      each step is given its length, so a fade takes as long at any rate above 1 / kStepMostS. A longer step
//           counts as kStepMostS: a pause of the machine must not become a step of the force.
// Runs on   servo thread, every step; constant time, no allocation
// Frame     world
#pragma once

#include <algorithm>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

class ForceFade {
public:
    static constexpr double kRampS = 0.256;
    static constexpr double kStepS = 1e-3;  // of a step whose length is not a number
    static constexpr double kStepMostS = 0.02;

    // Steps of this length until the gain has risen. For tests and benches.
    static constexpr int ramp_steps(double step_s) {
        int steps = 0;
        while (steps * step_s < (1.0 - 1e-9) * kRampS) ++steps;
        return steps;
    }

    // First of all in a step: what left shrinks. step_s: time since the step before.
    void begin_step(double step_s) noexcept TACT_RT {
        step_s_ = step_s >= 0.0 ? std::min(step_s, kStepMostS) : step_s < 0.0 ? 0.0 : kStepS;
        leaving_ = {less(leaving_.force_n, kLeavingNPerS), less(leaving_.torque_n_m, kLeavingNMPerS)};
    }
    // Then one of these: something is felt; it is on its way out; there is nothing in the hand.
    void rise() noexcept TACT_RT {
        if (leaving_.force_n.isZero(0.0) && leaving_.torque_n_m.isZero(0.0))
            ramp_ = std::min(ramp_ + step_s_ * kRampPerS, 1.0);
    }
    void fall() noexcept TACT_RT { ramp_ = std::max(ramp_ - step_s_ * kRampPerS, 0.0); }
    void rest() noexcept TACT_RT { ramp_ = 0.0; }
    // Of what is in the hand: 3 s^2 - 2 s^3, so that the force enters and leaves without a kink.
    [[nodiscard]] double gain() const noexcept TACT_RT { return ramp_ * ramp_ * (3.0 - 2.0 * ramp_); }
    // Last in a step. felt: of what is in the hand, times gain(). Returns what is shown: with what left.
    Wrench show(const Wrench& felt) noexcept TACT_RT {
        shown_ = {felt.force_n + leaving_.force_n, felt.torque_n_m + leaving_.torque_n_m};
        return shown_;
    }
    // Between steps: what another fade showed last fades from here, and what is felt instead fades in after
    // it.
    void follow(const ForceFade& before) noexcept TACT_RT {
        shown_ = leaving_ = before.shown_;
        ramp_ = 0.0;
    }
    // No force at once.
    void cut() noexcept TACT_RT {
        ramp_ = 0.0;
        shown_ = leaving_ = {};
    }

private:
    static constexpr double kRampPerS = 1.0 / kRampS;
    static constexpr double kLeavingNPerS = 40.0, kLeavingNMPerS = 2.0;
    static constexpr double kLeavingSharePerS = 5.0;  // and of what is far beyond any device

    [[nodiscard]] Vec3 less(const Vec3& v, double per_s) const noexcept {
        const double size = v.norm(), left = size - step_s_ * std::max(per_s, kLeavingSharePerS * size);
        return left > 0.0 ? Vec3(left / size * v) : Vec3::Zero();
    }

    double step_s_ = kStepS;  // of the step that is made
    double ramp_ = 0.0;       // 0: no force, 1: all of it
    Wrench shown_, leaving_;  // of the last step; of what was in the hand before, on its way to zero
};

}  // namespace tact
