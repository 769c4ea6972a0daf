// Waits for the descriptors of a bus without starving threads of lower priority.
//
// A pump runs at a priority above the kernel threads that complete transfers and remove devices. poll() returns
// at once when a descriptor is in error; a pump that loops on it would starve those threads. Observed on a
// real-time kernel: an unplugged arm kept its pump busy for a second.
//
// Thread  pump only; blocks, so never the servo
#pragma once

#include <poll.h>
#include <time.h>

#include <algorithm>
#include <span>

#include "ipc/base/clock.hpp"

namespace tact {

inline constexpr Duration kBusNap = std::chrono::milliseconds(1);

[[nodiscard]] inline timespec to_timespec(Duration d) noexcept {
    const auto ns = std::max<std::int64_t>(d.count(), 0);
    return {.tv_sec = ns / 1'000'000'000, .tv_nsec = ns % 1'000'000'000};
}

inline void nap(Duration d) noexcept {
    const timespec time = to_timespec(d);
    nanosleep(&time, nullptr);
}

// Waits until a descriptor is ready, at most `patience`.
inline void wait_for(std::span<pollfd> descriptors, Duration patience) noexcept {
    const timespec time = to_timespec(patience);
    if (ppoll(descriptors.data(), descriptors.size(), &time, nullptr) <= 0) return;
    const auto failed = [](const pollfd& p) { return (p.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0; };
    if (std::any_of(descriptors.begin(), descriptors.end(), failed)) nap(std::min(patience, kBusNap));
}

}  // namespace tact
