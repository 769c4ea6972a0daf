// The heartbeat of the servo thread, as the supervisor watches it from outside.
//
// Thread    the servo writes all but `drops`, which the supervisor writes; both read
#pragma once

#include <atomic>
#include <cstdint>

namespace tact {

struct ServoPulse {
    std::atomic<std::int64_t> beat_ns{0};  // of the newest cycle
    std::atomic<bool> enabled{false};      // the amplifier is wanted on
    std::atomic<std::uint64_t> rearms{0};  // by a person
    std::atomic<std::uint64_t> drops{0};   // by the supervisor
};

}  // namespace tact
