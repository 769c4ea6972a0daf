// Prevents a step of the force when the level jumps: the difference becomes an offset that decays.
//
// Offset    wrench before the jump minus the new level's wrench. Its force is limited to the sum of both levels' error
//           bounds, the largest difference of two levels at one pose; any excess is due to motion and stays.
// Decay     exponential, time constant kTau_s. Meanwhile the force is not the derivative of an energy; the remaining
//           offset is part of the published error.
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

    // Call for another body, map or grip: the next wrench has no predecessor.
    void restart() noexcept TACT_RT { *this = {}; }

    // jumped: the level differs from that of the previous wrench. Adds the offset to wrench and error.
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
