// The head's pose without the tracker's noise, and its prediction for the time of display.
//
// Filter    1 euro filter (Casiez, Roussel, Vogel 2012), position and rotation each: a low-pass whose
//           cut-off rises with the speed, f = min_cutoff + beta |speed|: no jitter at rest, little lag in
//           motion
// Steps     of any length: weight = 1 - exp(-2 pi f dt), exact for a value that is constant between
//           samples, so the result does not depend on the step lengths. A sample that is not newer is
//           ignored; after a gap beyond kGap the filter restarts.
// Predicts  with the twist of the filtered pose, kept constant, at most kHorizon past the newest sample:
//           beyond that the pose stays constant
// Frame     that of the samples; twist about its axes, at the sensor's own point
// Thread    one; no allocation
#pragma once

#include "ipc/base/clock.hpp"
#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

struct OneEuroSettings {
    double min_cutoff_hz;
    double beta_hz_per_speed;  // Hz per m/s, or per rad/s
    double speed_cutoff_hz;    // low-pass of the speed that steers the cut-off
};

// Cut-offs at rest: common values for trackers. The others were measured against 0.8 mm and 0.15 degrees of
// noise at 240 Hz, see README.md.
struct HeadFilterSettings {
    OneEuroSettings position{1.15, 60.0, 2.5};
    OneEuroSettings rotation{1.5, 18.0, 2.5};
};

class HeadFilter {
public:
    static constexpr Duration kHorizon = std::chrono::milliseconds(50);
    static constexpr Duration kGap = std::chrono::milliseconds(200);

    explicit HeadFilter(const HeadFilterSettings& settings = {}) : settings_(settings) {}

    void add(Instant taken_at, const Pose& pose) noexcept TACT_RT;
    void clear() noexcept { known_ = false; }

    [[nodiscard]] bool known() const noexcept { return known_; }
    [[nodiscard]] Instant taken_at() const noexcept { return taken_at_; }
    [[nodiscard]] const Pose& pose() const noexcept { return filtered_; }
    [[nodiscard]] const Twist& twist() const noexcept { return twist_; }
    // Pose at that instant, usually the future time of display.
    [[nodiscard]] Pose at(Instant when) const noexcept TACT_RT;

private:
    HeadFilterSettings settings_;
    bool known_ = false;
    Instant taken_at_{};
    Pose raw_, filtered_;
    Twist steering_;  // of the raw pose, low-pass filtered: steers the cut-offs
    Twist twist_;     // of the filtered pose
};

}  // namespace tact
