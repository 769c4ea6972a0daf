// A gain that follows the stability limit without a step in value or slope.
//
// Why     The delay is known once per second, as a percentile. On a host that stalls it doubles from one second to the
//         next; an immediate gain change would halve the force at the slew limit, which the hand feels as a knock.
// Law     Two equal first-order lags in series on the gain's logarithm. The output lies between the requested values, so
//         it never overshoots. Each lag changes its time constant only where its slope is zero, so the slope is continuous.
// Up      half a second in total: too slow to be distinguished from the field itself.
// Down    a fifth of a second: vibration in a field above the limit grows at a rate of at most (K / K_max - 1) b / 2m. With
//         the mass m = 0.25 kg of a hand on an arm and b = 3 N s/m that is 6 per second at twice the limit, so a
//         vibration grows by a factor of about three before it decays.
// Thread  servo; TACT_RT
#pragma once

#include <algorithm>
#include <cmath>

#include "ipc/base/rt.hpp"

namespace tact {

class SmoothGain {
public:
    static constexpr double kUpS = 0.25, kDownS = 0.1;  // of each lag

    // Sets the gain at once; only while the force is zero.
    void settle(double gain) noexcept TACT_RT { near_ = out_ = log_of(gain); }
    // Advances by dt_s and returns the gain. wanted: in (0, 1].
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
    // Exact for a constant target at any step.
    static void lag(double& state, double target, double dt_s) noexcept TACT_RT {
        state += (target - state) * -std::expm1(-dt_s / (target < state ? kDownS : kUpS));
    }

    double near_ = 0.0, out_ = 0.0;  // logarithms
};

}  // namespace tact
