// A gain that follows what is stable, so that the hand feels no step: neither in it nor in its slope.
//
// Why     the delay is known once a second, as a percentile. On a host that stalls it doubles from one second to
//         the next, and a gain that followed at once would halve the force within the slew limit: a knock.
// Law     two equal lags, one behind the other, of the gain's logarithm. What they give lies between what they
//         were asked for, so it never overshoots; each changes its time only where its slope is zero, so the
//         slope has no step either.
// Up      half a second in all: slower than a person tells from the field itself.
// Down    a fifth of a second: too stiff a field swells at the rate (K / K_max - 1) b / 2m at most. With the mass
//         m = 0.25 kg of a hand on an arm and b = 3 N s/m that is 6 a second at twice what is stable, so that a
//         vibration grows by a factor of about three before it dies.
// Thread  servo; TACT_RT
#pragma once

#include <algorithm>
#include <cmath>

#include "ipc/base/rt.hpp"

namespace tact {

class SmoothGain {
public:
    static constexpr double kUpS = 0.25, kDownS = 0.1;  // of each lag

    // At once: while no force is shown.
    void settle(double gain) noexcept TACT_RT { near_ = out_ = log_of(gain); }
    // The gain after so many seconds more. Asked for: over 0, at most 1.
    double follow(double wanted, double dt_s) noexcept TACT_RT {
        lag(near_, log_of(wanted), dt_s);
        lag(out_, near_, dt_s);
        return gain();
    }
    [[nodiscard]] double gain() const noexcept TACT_RT { return std::exp(out_); }

private:
    static constexpr double kLeast = 1e-6;

    [[nodiscard]] static double log_of(double gain) noexcept TACT_RT {
        return std::log(std::clamp(gain, kLeast, 1.0));
    }
    // Exact for a target that stands still, whatever the step.
    static void lag(double& state, double target, double dt_s) noexcept TACT_RT {
        state += (target - state) * -std::expm1(-dt_s / (target < state ? kDownS : kUpS));
    }

    double near_ = 0.0, out_ = 0.0;  // logarithms
};

}  // namespace tact
