// Speed from positions that come in steps, at whatever times they come.
//
// Method   adaptive window: the longest stretch of newest samples that one straight line explains, each
//          within a step (after Janabi-Sharifi, Hayward and Chen 2000); derivation in the .cpp
// At rest  exactly 0
// Slow     at constant speed, and at rest on the edge between two steps, never wrong by more than 2 steps
//          a window
// Moving   when the hand speeds up, the window shortens by itself: late by about
//          0.9 sqrt(step / acceleration)
// Time     samples without progress of time are left out; a gap starts anew
// Thread   one; TACT_RT, fixed memory
#pragma once

#include <array>
#include <cstddef>

#include "hal/arm/arm_kinematics.hpp"
#include "ipc/base/clock.hpp"

namespace tact {

struct VelocitySettings {
    Duration span_max = std::chrono::milliseconds(30);  // longest window: noise at rest against delay
    Duration gap_max =
        std::chrono::milliseconds(50);  // longer without a sample: what was before is forgotten
};

class VelocityWindow {
public:
    // step: of the positions, in their unit; 0 is taken as the smallest there is.
    explicit VelocityWindow(double step = 1.0, const VelocitySettings& settings = {});

    // Takes a position and gives the speed in its unit a second. What is not finite is left out.
    double push(double position, Instant at) noexcept TACT_RT;
    void reset() noexcept TACT_RT;
    [[nodiscard]] double per_s() const noexcept { return per_s_; }
    [[nodiscard]] Duration window() const noexcept { return window_; }  // that the newest speed comes from

private:
    static constexpr std::size_t kSamples = 40;
    struct Sample {
        double position = 0.0;
        Instant at{};
    };
    [[nodiscard]] const Sample& back(std::size_t age) const noexcept {
        return samples_[(newest_ + kSamples - age) % kSamples];
    }
    struct Fit {
        double per_s = 0.0;
        Duration window{};
        std::size_t samples = 0;  // besides the newest
        bool cut = false;         // one line does not explain the sample before these
    };
    void keep(double position, Instant at) noexcept;
    // Of the newest sample and at most so many before it.
    [[nodiscard]] Fit line(double position, Instant at, std::size_t most) const noexcept;

    double step_;
    VelocitySettings settings_;
    std::array<Sample, kSamples> samples_{};
    std::size_t newest_ = 0, count_ = 0;
    double per_s_ = 0.0;
    Duration window_{};
};

// The tip's velocity and its turning, from the encoders: one estimator a joint, where the steps are, then J
// q'.
class ArmVelocity {
public:
    explicit ArmVelocity(const ArmKinematics& arm, const VelocitySettings& settings = {});

    // q belongs to these counts.
    [[nodiscard]] Twist push(const Counts6& counts, const Joint6& q, Instant at) noexcept TACT_RT;
    void reset() noexcept TACT_RT;
    [[nodiscard]] const Joint6& joint_rad_s() const noexcept { return rad_s_; }

private:
    const ArmKinematics* arm_;
    std::array<VelocityWindow, 6> windows_;
    Joint6 rad_s_ = Joint6::Zero();
};

}  // namespace tact
