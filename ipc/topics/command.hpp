// What a person asks of the controller. Acknowledged in HealthTopic by sequence number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ipc/shm/topic.hpp"

namespace tact {

enum class CommandKind : std::uint16_t {
    none,
    arm,
    disarm,
    reset_fault,
    set_law,      // text: name of the law
    set_goal_hz,  // value
    set_level,    // text: path, value: level, used by the law "fixed"
    set_fidelity_auto,
};

enum class CommandResult : std::uint16_t { none, done, refused_state, refused_value, unknown };

struct CommandTopic {
    static constexpr TopicInfo kInfo{.name = "command", .version = 1, .writer = Writer::gui};
    std::uint64_t sequence;  // from 1
    std::int64_t taken_at_ns;
    double value;
    std::uint16_t kind;  // CommandKind
    std::uint16_t reserved[3];
    char text[32];  // ends with 0
};
static_assert(std::is_trivially_copyable_v<CommandTopic> && sizeof(CommandTopic) == 64);

}  // namespace tact
