// Wake-up lateness of a servo thread on this machine: for `tact bench servo`.
//
// Method   a thread configured like the servo thread (FIFO scheduling and the last core where permitted, memory locked)
//          runs empty cycles with the servo's clock and pacer: planned start time, sleep, spin tail, one clock reading.
//          Lateness is this reading minus the planned start time, as in tact-rt. A second round without the spin tail
//          measures the lateness of the kernel alone.
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
    std::uint64_t overruns = 0;       // cycles that woke after the start time of the next cycle
    bool fifo = false;                // true: FIFO scheduling was permitted
    int core = -1;                    // core that the thread is pinned to; -1: not pinned
};

[[nodiscard]] ServoBench bench_servo(const ServoBenchSettings& settings = {});

}  // namespace tact
