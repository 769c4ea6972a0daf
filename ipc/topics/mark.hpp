// A place that an instructor marks in the scene, from the housekeeping thread: at every mark.
#pragma once

#include <cstdint>
#include <type_traits>

#include "ipc/shm/topic.hpp"

namespace tact {

struct alignas(64) MarkTopic {
    static constexpr TopicInfo kInfo{.name = "mark", .version = 1, .writer = Writer::rt};
    std::int64_t taken_at_ns;
    std::uint64_t count;  // marks so far
    double pos_model_m[3];
    std::uint32_t pid;          // of the instructor's window
    std::uint8_t reserved[20];  // zero
};
static_assert(std::is_trivially_copyable_v<MarkTopic> && sizeof(MarkTopic) == 64);

}  // namespace tact
