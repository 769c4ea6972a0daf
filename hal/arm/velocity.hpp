// Velocity from quantized positions at arbitrary times.
//
// Method   adaptive window: the longest run of newest samples that one straight line explains, each
//          within a step (after Janabi-Sharifi, Hayward and Chen 2000); derivation in the .cpp
// At rest  exactly 0
// Slow     at constant speed, and at rest on the edge between two steps, the error is at most 2 steps per
//          window
// Moving   under acceleration the window shortens; the lag is about 0.9 sqrt(step / acceleration)
// Time     samples with a time stamp that did not advance are ignored; a gap restarts the window
// Thread   one; TACT_RT, fixed memory
#pragma once

#include <array>
#include <cstddef>

#include "hal/arm/arm_kinematics.hpp"
#include "ipc/base/clock.hpp"

namespace tact {

struct VelocitySettings {
    Duration span_max = std::chrono::milliseconds(30);  // longest window: trades noise at rest against lag
    Duration gap_max = std::chrono::milliseconds(50);   // a longer gap discards the earlier samples
};

class VelocityWindow {
public:
    // step: quantization step, in the unit of the positions; 0 counts as the smallest positive number.
    explicit VelocityWindow(double step = 1.0, const VelocitySettings& settings = {});

    // Adds a position and returns the speed in its unit per second. Non-finite positions are ignored.
    double push(double position, Instant at) noexcept TACT_RT;
    void reset() noexcept TACT_RT;
    [[nodiscard]] double per_s() const noexcept { return per_s_; }
    [[nodiscard]] Duration window() const noexcept { return window_; }  // of the newest speed

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
        std::size_t samples = 0;  // without the newest
        bool cut = false;         // one line does not fit the sample before these
    };
    void keep(double position, Instant at) noexcept;
    // Fits a line to the newest sample and up to `most` samples before it.
    [[nodiscard]] Fit line(double position, Instant at, std::size_t most) const noexcept;

    double step_;
    VelocitySettings settings_;
    std::array<Sample, kSamples> samples_{};
    std::size_t newest_ = 0, count_ = 0;
    double per_s_ = 0.0;
    Duration window_{};
};

// Linear and angular velocity of the tip from the encoders: one estimator per joint, where the quantization occurs,
// then J q'.
class ArmVelocity {
public:
    explicit ArmVelocity(const ArmKinematics& arm, const VelocitySettings& settings = {});

    // q must belong to these counts.
    [[nodiscard]] Twist push(const Counts6& counts, const Joint6& q, Instant at) noexcept TACT_RT;
    void reset() noexcept TACT_RT;
    [[nodiscard]] const Joint6& joint_rad_s() const noexcept { return rad_s_; }

private:
    const ArmKinematics* arm_;
    std::array<VelocityWindow, 6> windows_;
    Joint6 rad_s_ = Joint6::Zero();
};

}  // namespace tact
