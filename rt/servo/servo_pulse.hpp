// Heartbeat of the servo thread, monitored by the supervisor thread.
//
// Thread    the servo writes all members except `drops`, which the supervisor writes; both read
#pragma once

#include <atomic>
#include <cstdint>

namespace tact {

struct ServoPulse {
    std::atomic<std::int64_t> beat_ns{0};  // time of the newest cycle
    std::atomic<bool> enabled{false};      // the servo commands the amplifier on
    std::atomic<std::uint64_t> rearms{0};  // number of re-arms by a person
    std::atomic<std::uint64_t> drops{0};   // number of drops of the enable line by the supervisor
};

}  // namespace tact
