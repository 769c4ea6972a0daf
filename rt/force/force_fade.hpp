// Fades forces in and out without a step: a gain on the force of the held body, plus the decaying force of the
// body held before.
//
// In        The gain rises from 0 to 1 in kRampS, and falls the same way while the clutch is held. It rises only after
//           the previous force has decayed to zero.
// Out       When the held body changes, its last wrench shrinks by 40 N/s and 2 N m/s. Orders in quick succession do not
//           delay this. A force of 3.3 N is gone after 83 ms; at 1 kHz that is a twelfth of the slew limit. The direction
//           stays constant, as for a body that stays where the hand released it.
// Jump      Where the model changes and the body stays (absorb()), the difference shrinks the same way.
// Time      Each step has a length, so a fade takes the same time at any rate above 1 / kStepMostS. A longer step counts
//           as kStepMostS: a pause of the machine must not cause a step of the force.
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
    static constexpr double kStepS = 1e-3;  // for a step whose length is not a number
    static constexpr double kStepMostS = 0.02;

    // Number of steps of this length until the gain is 1. For tests and benches.
    static constexpr int ramp_steps(double step_s) {
        int steps = 0;
        while (steps * step_s < (1.0 - 1e-9) * kRampS) ++steps;
        return steps;
    }

    // First call in a step: shrinks the previous force. step_s: time since the last step.
    void begin_step(double step_s) noexcept TACT_RT {
        step_s_ = step_s >= 0.0 ? std::min(step_s, kStepMostS) : step_s < 0.0 ? 0.0 : kStepS;
        leaving_ = {less(leaving_.force_n, kLeavingNPerS), less(leaving_.torque_n_m, kLeavingNMPerS)};
    }
    // Then one of these: rise() with a held body, fall() while it fades out, rest() with an empty hand.
    void rise() noexcept TACT_RT {
        if (leaving_.force_n.isZero(0.0) && leaving_.torque_n_m.isZero(0.0))
            ramp_ = std::min(ramp_ + step_s_ * kRampPerS, 1.0);
    }
    void fall() noexcept TACT_RT { ramp_ = std::max(ramp_ - step_s_ * kRampPerS, 0.0); }
    void rest() noexcept TACT_RT { ramp_ = 0.0; }
    // Gain of the held body's force: 3 s^2 - 2 s^3, so that the force starts and ends without a kink.
    [[nodiscard]] double gain() const noexcept TACT_RT { return ramp_ * ramp_ * (3.0 - 2.0 * ramp_); }
    // Last call in a step. felt: wrench of the held body, times gain(). Returns the sum with the previous force.
    Wrench show(const Wrench& felt) noexcept TACT_RT {
        shown_ = {felt.force_n + leaving_.force_n, felt.torque_n_m + leaving_.torque_n_m};
        return shown_;
    }
    // Between steps: fades out the last wrench of another fade; the new force fades in after that.
    void follow(const ForceFade& before) noexcept TACT_RT {
        shown_ = leaving_ = before.shown_;
        ramp_ = 0.0;
    }
    // Before show(), where the model of the same body changes: the difference of this step's wrench to the last one
    // shown shrinks from here on, as far as most_n; the rest is not the model's doing. A torque counts as a force at this
    // lever.
    void absorb(const Wrench& felt, double most_n, double lever_m) noexcept TACT_RT {
        leaving_ = {shown_.force_n - felt.force_n, shown_.torque_n_m - felt.torque_n_m};
        const double size_n = leaving_n(lever_m), part = size_n > most_n ? most_n / size_n : 1.0;
        leaving_ = {part * leaving_.force_n, part * leaving_.torque_n_m};
    }
    // Of what shrinks.
    [[nodiscard]] double leaving_n(double lever_m) const noexcept TACT_RT {
        return std::max(leaving_.force_n.norm(), leaving_.torque_n_m.norm() / lever_m);
    }
    // No force at once.
    void cut() noexcept TACT_RT {
        ramp_ = 0.0;
        shown_ = leaving_ = {};
    }

private:
    static constexpr double kRampPerS = 1.0 / kRampS;
    static constexpr double kLeavingNPerS = 40.0, kLeavingNMPerS = 2.0;
    static constexpr double kLeavingSharePerS = 5.0;  // of forces far beyond any device's limit

    [[nodiscard]] Vec3 less(const Vec3& v, double per_s) const noexcept {
        const double size = v.norm(), left = size - step_s_ * std::max(per_s, kLeavingSharePerS * size);
        return left > 0.0 ? Vec3(left / size * v) : Vec3::Zero();
    }

    double step_s_ = kStepS;  // length of the present step
    double ramp_ = 0.0;       // 0: no force, 1: full force
    Wrench shown_, leaving_;  // output of the last step; decaying wrench of the body held before
};

}  // namespace tact
