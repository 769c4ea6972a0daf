// Fades forces in and out without a step: a gain on the force of the held body, plus the decaying force of the
// body held before.
//
// In        The gain rises from 0 to 1 over kRampSteps steps, and falls the same way while the clutch is held. It
//           rises only after the previous force has decayed to zero.
// Out       When the held body changes, its last wrench shrinks by 0.04 N and 0.002 N m per step. Orders in quick
//           succession do not delay this. A force of 3.3 N is gone after 83 steps; at 1 kHz that is a twelfth of the
//           slew limit. The direction stays constant, as for a body that stays where the hand released it.
// Runs on   servo thread, every step; constant time, no allocation
// Frame     world
#pragma once

#include <algorithm>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

class ForceFade {
public:
    static constexpr int kRampSteps = 256;

    // First call in a step: shrinks the previous force.
    void begin_step() noexcept TACT_RT {
        leaving_ = {less(leaving_.force_n, kLeavingN), less(leaving_.torque_n_m, kLeavingNM)};
    }
    // Then one of these: rise() with a held body, fall() while it fades out, rest() with an empty hand.
    void rise() noexcept TACT_RT {
        if (leaving_.force_n.isZero(0.0) && leaving_.torque_n_m.isZero(0.0))
            ramp_ = std::min(ramp_ + 1, kRampSteps);
    }
    void fall() noexcept TACT_RT { ramp_ = std::max(ramp_ - 1, 0); }
    void rest() noexcept TACT_RT { ramp_ = 0; }
    // Gain of the held body's force: 3 s^2 - 2 s^3, so that the force starts and ends without a kink.
    [[nodiscard]] double gain() const noexcept TACT_RT {
        const double s = static_cast<double>(ramp_) / kRampSteps;
        return s * s * (3.0 - 2.0 * s);
    }
    // Last call in a step. felt: wrench of the held body, times gain(). Returns the sum with the previous force.
    Wrench show(const Wrench& felt) noexcept TACT_RT {
        shown_ = {felt.force_n + leaving_.force_n, felt.torque_n_m + leaving_.torque_n_m};
        return shown_;
    }
    // Between steps: fades out the last wrench of another fade; the new force fades in after that.
    void follow(const ForceFade& before) noexcept TACT_RT {
        shown_ = leaving_ = before.shown_;
        ramp_ = 0;
    }
    // No force at once.
    void cut() noexcept TACT_RT {
        ramp_ = 0;
        shown_ = leaving_ = {};
    }

private:
    static constexpr double kLeavingN = 0.04, kLeavingNM = 0.002;  // per step
    static constexpr double kLeavingShare = 0.005;  // per step, of forces far beyond any device's limit

    static Vec3 less(const Vec3& v, double step) noexcept {
        const double size = v.norm(), left = size - std::max(step, kLeavingShare * size);
        return left > 0.0 ? Vec3(left / size * v) : Vec3::Zero();
    }

    int ramp_ = 0;            // 0: no force, kRampSteps: full force
    Wrench shown_, leaving_;  // output of the last step; decaying wrench of the body held before
};

}  // namespace tact
