// How a thread waits for the descriptors of its bus, without ever keeping the processor from whoever is below it.
//
// A pump runs at a priority above the kernel's own threads that end transfers and take devices away. If it
// looped while it waits for those, as poll() makes it once a descriptor is in error, they would never come
// to it: seen on a real-time kernel, where an arm that was unplugged kept its pump awake for a second.
//
// Thread  a pump's; blocks, so never the servo's.
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

// Until a descriptor is ready, but no longer than `patience`.
inline void wait_for(std::span<pollfd> descriptors, Duration patience) noexcept {
    const timespec time = to_timespec(patience);
    if (ppoll(descriptors.data(), descriptors.size(), &time, nullptr) <= 0) return;
    const auto failed = [](const pollfd& p) { return (p.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0; };
    if (std::any_of(descriptors.begin(), descriptors.end(), failed)) nap(std::min(patience, kBusNap));
}

}  // namespace tact
