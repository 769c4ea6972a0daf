// Real-time priorities of tact-rt's threads, and a function that sets them where permitted.
//
// Refused  no error: the thread continues with ordinary scheduling, and the returned text holds the
//          attempt, the reason and the fix
// Thread   any, at start-up
#pragma once

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>

#include <cstring>
#include <string>

#include "ipc/base/rights.hpp"

namespace tact {

inline constexpr int kServoPriority = 80;
inline constexpr int kPumpPriority = 85;  // of a device's bus: above the servo, which waits for its states
inline constexpr int kSupervisorPriority = 95;  // the highest, which deploy/limits.conf grants

// whose: "the servo". Empty: granted, or nothing was requested (0).
[[nodiscard]] inline std::string raise_to_fifo(pthread_t thread, const std::string& whose, int priority) {
    if (priority <= 0) return {};
    sched_param param{};
    param.sched_priority = priority;
    const int error = pthread_setschedparam(thread, SCHED_FIFO, &param);
    if (error == 0) return {};
    rlimit limit{};
    getrlimit(RLIMIT_RTPRIO, &limit);
    return "cannot use SCHED_FIFO at priority " + std::to_string(priority) + " for " + whose + " (" +
           std::strerror(error) + "): RLIMIT_RTPRIO is " +
           (limit.rlim_cur == RLIM_INFINITY ? "unlimited" : std::to_string(limit.rlim_cur)) +
           ". The thread uses ordinary scheduling.\n  fix: " + kLimitsFix;
}

}  // namespace tact
