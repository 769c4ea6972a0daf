// Instants and durations, and the clock of the servo loop.
//
// The loop takes a Clock so that the same loop runs on the machine's monotonic clock and, in tests and
// replays, on a manual clock.
#pragma once

#include <time.h>

#include <chrono>
#include <cstdint>

#include "ipc/base/rt.hpp"

namespace tact {

// Tag for CLOCK_MONOTONIC, shared by all processes of one boot.
struct Monotonic {
    using rep = std::int64_t;
    using period = std::nano;
    using duration = std::chrono::nanoseconds;
    using time_point = std::chrono::time_point<Monotonic>;
    static constexpr bool is_steady = true;

    static time_point now() noexcept {
        timespec ts{};
        clock_gettime(CLOCK_MONOTONIC, &ts);  // a vDSO read: no system call
        return time_point(std::chrono::seconds(ts.tv_sec) + duration(ts.tv_nsec));
    }
};

using Duration = std::chrono::nanoseconds;
using Instant = Monotonic::time_point;

[[nodiscard]] constexpr std::int64_t to_ns(Instant t) noexcept { return t.time_since_epoch().count(); }
[[nodiscard]] constexpr Instant instant_from_ns(std::int64_t ns) noexcept { return Instant(Duration(ns)); }
[[nodiscard]] constexpr double to_s(Duration d) noexcept { return static_cast<double>(d.count()) * 1e-9; }
[[nodiscard]] constexpr double to_us(Duration d) noexcept { return static_cast<double>(d.count()) * 1e-3; }

class Clock {
public:
    virtual ~Clock() = default;
    virtual Instant now() noexcept TACT_RT = 0;
    // Returns at or after t. A past t returns at once.
    virtual void wait_until(Instant t) noexcept TACT_RT = 0;
};

class ManualClock final : public Clock {
public:
    Instant now() noexcept TACT_RT override { return now_; }
    void wait_until(Instant t) noexcept TACT_RT override {
        if (t > now_) now_ = t;
    }
    void advance(Duration d) noexcept { now_ += d; }

private:
    Instant now_{};
};

}  // namespace tact
