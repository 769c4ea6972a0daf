// Lets a level jump without a step in the force: the difference at the jump stays as an offset that decays.
//
// Offset    wrench shown before the jump less the new level's wrench. Its force is at most the sum of both levels' error bounds, which
//           is all that two levels at one place can differ by; what goes beyond it is motion and passes through.
// Decay     exponential, kTau_s. While it lasts the force is not the derivative of an energy; what remains of the offset is part of
//           the published error.
// Thread    servo; constant time
#pragma once

#include <algorithm>
#include <cmath>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

class LevelGlide {
public:
    static constexpr double kTau_s = 0.03;

    // Another body, density or grip: the next wrench follows no earlier one.
    void restart() noexcept TACT_RT { *this = {}; }

    // jumped: this wrench is of another level than the one before. Changes wrench and error to what is shown.
    void apply(bool jumped, double step_s, Wrench& wrench, double& error_n) noexcept TACT_RT {
        const double keep = std::exp(-std::clamp(step_s, 0.0, 1.0) / kTau_s);
        offset_.force_n *= keep;
        offset_.torque_n_m *= keep;
        const double level_error_n = error_n;
        if (jumped && known_) {
            offset_ = {shown_.force_n - wrench.force_n, shown_.torque_n_m - wrench.torque_n_m};
            const double size_n = offset_.force_n.norm(), most_n = level_error_n + error_before_n_;
            if (size_n > most_n) {
                offset_.force_n *= most_n / size_n;
                offset_.torque_n_m *= most_n / size_n;
            }
        }
        wrench.force_n += offset_.force_n;
        wrench.torque_n_m += offset_.torque_n_m;
        error_n += offset_.force_n.norm();
        shown_ = wrench;
        error_before_n_ = error_n;
        known_ = true;
    }

private:
    Wrench offset_{Vec3::Zero(), Vec3::Zero()}, shown_{Vec3::Zero(), Vec3::Zero()};
    double error_before_n_ = 0.0;
    bool known_ = false;
};

}  // namespace tact
