// The machine's monotonic clock for the servo thread: sleeps until shortly before the instant, then spins.
//
// A sleeping thread wakes 20 to 60 microseconds late; spinning hides that at the cost of that much
// processor time in every cycle. Times are absolute, so there is no drift.
#pragma once

#include <cerrno>

#include "ipc/base/clock.hpp"

namespace tact {

class ServoClock final : public Clock {
public:
    explicit ServoClock(Duration spin_tail) noexcept : spin_tail_(spin_tail) {}

    Instant now() noexcept TACT_RT override { return Monotonic::now(); }

    void wait_until(Instant t) noexcept TACT_RT override {
        const std::int64_t wake_ns = to_ns(t - spin_tail_);
        if (wake_ns > to_ns(Monotonic::now())) {
            const timespec wake{.tv_sec = wake_ns / 1'000'000'000, .tv_nsec = wake_ns % 1'000'000'000};
            while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, nullptr) == EINTR) {
            }
        }
        while (Monotonic::now() < t) relax_processor();
    }

private:
    static void relax_processor() noexcept {
#if defined(__x86_64__)
        __builtin_ia32_pause();
#endif
    }
    Duration spin_tail_;
};

}  // namespace tact
