// Wake-up lateness of a servo thread on this machine: for `tact bench servo`.
//
// Method   a thread set up like the servo's (FIFO and last core if permitted, memory locked) runs empty
//          cycles on the servo's clock and pacer: planned start time, sleep, spin tail, one clock reading. Lateness
//          is that reading minus the plan, as in tact-rt. A second round without the spin tail shows the kernel's
//          lateness alone.
// Takes    `seconds` per round. Throws StartupError if the thread cannot be started.
#pragma once

#include <cstdint>

#include "tests/bench/loop_thread.hpp"

namespace tact {

struct ServoBenchSettings {
    Duration period = std::chrono::milliseconds(1);
    Duration spin_tail = kServoSpinTail;
    int priority = kServoPriority;
    double seconds = 3.0;
};

struct LatenessMetrics {
    double p50_us = 0.0, p99_us = 0.0, p999_us = 0.0, max_us = 0.0;
    std::uint64_t cycles = 0;
};

struct ServoBench {
    LatenessMetrics lateness;         // sleep and spin tail
    LatenessMetrics lateness_asleep;  // sleep alone
    std::uint64_t overruns = 0;       // cycles that woke after the start time of the next one
    bool fifo = false;                // true: the priority was permitted
    int core = -1;                    // core of the thread; -1: not pinned
};

[[nodiscard]] ServoBench bench_servo(const ServoBenchSettings& settings = {});

}  // namespace tact
