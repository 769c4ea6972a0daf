// The machine's monotonic clock for the servo thread: sleeps until shortly before the instant, then spins.
//
// A sleeping thread wakes 20 to 60 microseconds late; spinning hides that at the cost of that much
// processor time in every cycle. Times are absolute, so there is no drift.
//
// Share    of a wait that may be spun: half, so that a loop whose steps leave less than spin_tail sleeps all the same. The
//          kernel takes 50 ms of every second from a FIFO thread that does not, or ends it. 1: by choice it need not sleep
#pragma once

#include <algorithm>
#include <cerrno>

#include "ipc/base/clock.hpp"

namespace tact {

class ServoClock final : public Clock {
public:
    static constexpr double kSpinShare = 0.5;

    explicit ServoClock(Duration spin_tail, double spin_share = kSpinShare) noexcept
        : spin_tail_(spin_tail), spin_share_(spin_share) {}

    Instant now() noexcept TACT_RT override { return Monotonic::now(); }

    // The last part of a wait, which is spun.
    [[nodiscard]] Duration spin(Duration wait) const noexcept TACT_RT {
        return std::min(spin_tail_,
                        Duration(static_cast<std::int64_t>(spin_share_ * static_cast<double>(wait.count()))));
    }

    void wait_until(Instant t) noexcept TACT_RT override {
        const Instant from = Monotonic::now();
        const std::int64_t wake_ns = to_ns(t - spin(t - from));
        if (wake_ns > to_ns(from)) {
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
    double spin_share_;
};

}  // namespace tact
