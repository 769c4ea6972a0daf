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
    // Of the bodies; body is an id of BodiesTopic.
    select_body,      // takes it into the hand; kNoBody: lets go
    fix_body,         // value: 1 fixed, 0 free
    place_body,       // to place; one in the hand is gripped anew there, at zero force
    add_body,         // body: index of a structure; to place
    remove_body,      // never the last one
    set_clash,        // value: 1 on, 0 off
    set_subtraction,  // value: 1 on, 0 off
    set_laplacian,    // value: 1 on, 0 off
    // Of a surface kept fine around the tool. body: DetailShape, value: width, pos_model_m[0]: error far away, both in
    // radii of full detail (TouchTopic)
    set_detail_filter,
    mark,  // nothing but the event that it is done: a flight recorder keeps what led here
};
inline constexpr CommandKind kLastCommand = CommandKind::mark;
// The force model carries it out, and may refuse it; all others concern the loop.
[[nodiscard]] constexpr bool is_for_model(CommandKind kind) {
    return kind >= CommandKind::select_body && kind <= CommandKind::set_detail_filter;
}

enum class CommandResult : std::uint16_t {
    none,
    done,
    refused_state,
    refused_value,
    unknown,
};

struct CommandTopic {
    static constexpr TopicInfo kInfo{.name = "command", .version = 2, .writer = Writer::gui};
    std::uint64_t sequence;  // from 1
    std::int64_t taken_at_ns;
    double value;
    std::uint16_t kind;  // CommandKind
    std::uint16_t reserved;
    std::uint32_t body;
    double pos_model_m[3];  // place_body, add_body
    double quat_model_body_xyzw[4];
    char text[32];            // ends with 0
    std::uint8_t padding[8];  // zero
};
static_assert(std::is_trivially_copyable_v<CommandTopic> && sizeof(CommandTopic) == 128);

}  // namespace tact
