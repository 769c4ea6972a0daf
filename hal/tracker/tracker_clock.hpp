// Converts the tracker's clock to the machine's.
//
// A frame arrives at  arrival = time + offset + delay,  delay >= 0: the smallest observed difference is the
// offset, and the excess over it is the delay of the frame. The offset may rise by kDrift, to follow a tracker
// whose quartz runs slow; the smallest difference itself follows one that runs fast.
//
// Stale    a delay above three periods: the frame waited in a queue while newer ones arrived. Refused.
// Restart  when the two clocks differ by more than a second over one step (the tracker was restarted, or
//          its 32 bits wrapped in a long silence), or everything was stale for kStaleAtMost.
// Thread   one; no allocation
#pragma once

#include <algorithm>
#include <cstdint>

#include "ipc/base/clock.hpp"

namespace tact {

class TrackerClock {
public:
    static constexpr double kDrift = 200e-6;  // two quartzes with 100 ppm each
    static constexpr Duration kRestart = std::chrono::seconds(1);
    static constexpr Duration kStaleAtMost = std::chrono::milliseconds(250);

    explicit TrackerClock(Duration period) : delay_max_(3 * period) {}

    // False: stale. Otherwise taken_at is the time of measurement, never after the arrival.
    [[nodiscard]] bool stamp(std::uint32_t time_us, Instant arrived, Instant& taken_at) noexcept {
        if (known_) {
            const Duration step = std::chrono::microseconds(static_cast<std::int32_t>(time_us - last_us_));
            const Duration passed = arrived - arrived_;
            const Duration apart = step - passed;
            if (apart > kRestart || apart < -kRestart) known_ = false;
            time_ += step;
        }
        if (!known_) begin(arrived);
        last_us_ = time_us;
        const Duration seen = arrived - time_;
        const double leak_ns = kDrift * static_cast<double>((arrived - arrived_).count());
        arrived_ = arrived;
        offset_ = std::min(seen, offset_ + Duration(static_cast<std::int64_t>(leak_ns)));
        if (seen - offset_ > delay_max_) {
            if (arrived - good_at_ <= kStaleAtMost) return false;
            begin(arrived);
        }
        good_at_ = arrived;
        taken_at = time_ + offset_;
        return true;
    }
    [[nodiscard]] std::uint64_t restarts() const noexcept { return begun_ > 0 ? begun_ - 1 : 0; }

private:
    void begin(Instant arrived) noexcept {
        known_ = true;
        time_ = arrived_ = good_at_ = arrived;
        offset_ = Duration{0};
        ++begun_;
    }

    Duration delay_max_;
    bool known_ = false;
    std::uint32_t last_us_ = 0;
    std::uint64_t begun_ = 0;
    Instant time_{};     // the tracker's clock, unwrapped, from the first arrival on
    Instant arrived_{};  // of the last frame
    Instant good_at_{};  // of the last frame that was not stale
    Duration offset_{};
};

}  // namespace tact
