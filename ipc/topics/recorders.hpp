// Recorders of this run on the link, from the housekeeping thread: at every change.
#pragma once

#include <cstdint>
#include <type_traits>

#include "ipc/shm/topic.hpp"

namespace tact {

struct alignas(64) RecordersTopic {
    static constexpr TopicInfo kInfo{.name = "recorders", .version = 1, .writer = Writer::rt};
    std::int64_t taken_at_ns;
    std::uint32_t recorders;    // that write every cycle to a file
    std::uint32_t flights;      // that keep the last half minute
    std::uint8_t reserved[48];  // zero
};
static_assert(std::is_trivially_copyable_v<RecordersTopic> && sizeof(RecordersTopic) == 64);

}  // namespace tact
