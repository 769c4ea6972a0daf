// What is felt comes and goes without a step: a gain on the force of what is in the hand, and the force of
// what left it.
//
// In        the gain rises from 0 to 1 over kRampSteps steps, and falls the same way while the clutch is
//           held. It waits until what left is gone.
// Out       after a change of what is in the hand, the last wrench shrinks by 0.04 N and 0.002 N m a step,
//           whatever happens meanwhile: orders in quick succession do not hold it up. 3.3 N are gone after 83
//           steps; at 1 kHz that is a twelfth of what the slew limit allows. It is a constant force, as that
//           of a body that stays where it was let go.
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

    // First of all in a step: what left shrinks.
    void begin_step() noexcept TACT_RT {
        leaving_ = {less(leaving_.force_n, kLeavingN), less(leaving_.torque_n_m, kLeavingNM)};
    }
    // Then one of these: something is felt; it is on its way out; there is nothing in the hand.
    void rise() noexcept TACT_RT {
        if (leaving_.force_n.isZero(0.0) && leaving_.torque_n_m.isZero(0.0))
            ramp_ = std::min(ramp_ + 1, kRampSteps);
    }
    void fall() noexcept TACT_RT { ramp_ = std::max(ramp_ - 1, 0); }
    void rest() noexcept TACT_RT { ramp_ = 0; }
    // Of what is in the hand: 3 s^2 - 2 s^3, so that the force enters and leaves without a kink.
    [[nodiscard]] double gain() const noexcept TACT_RT {
        const double s = static_cast<double>(ramp_) / kRampSteps;
        return s * s * (3.0 - 2.0 * s);
    }
    // Last in a step. felt: of what is in the hand, times gain(). Returns what is shown: with what left.
    Wrench show(const Wrench& felt) noexcept TACT_RT {
        shown_ = {felt.force_n + leaving_.force_n, felt.torque_n_m + leaving_.torque_n_m};
        return shown_;
    }
    // Between steps: what another fade showed last fades from here, and what is felt instead fades in after
    // it.
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
    static constexpr double kLeavingN = 0.04, kLeavingNM = 0.002;  // a step
    static constexpr double kLeavingShare = 0.005;                 // and of what is far beyond any device

    static Vec3 less(const Vec3& v, double step) noexcept {
        const double size = v.norm(), left = size - std::max(step, kLeavingShare * size);
        return left > 0.0 ? Vec3(left / size * v) : Vec3::Zero();
    }

    int ramp_ = 0;            // 0: no force, kRampSteps: all of it
    Wrench shown_, leaving_;  // of the last step; of what was in the hand before, on its way to zero
};

}  // namespace tact
