// A user's command to the controller. Acknowledged in HealthTopic by sequence number.
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
    // For bodies; body is an id of BodiesTopic.
    select_body,      // takes the body into the hand; kNoBody: releases it
    fix_body,         // value: 1 fixed, 0 free
    place_body,       // sets the pose; a body in the hand is gripped again there, at zero force
    add_body,         // body: index of a structure; with its pose
    remove_body,      // never the last one
    set_clash,        // value: 1 on, 0 off
    set_subtraction,  // value: 1 on, 0 off
    set_laplacian,    // value: 1 on, 0 off
    // For a surface refined around the tool. body: DetailShape, value: width, pos_model_m[0]: error far
    // away, both in radii of full detail (TouchTopic)
    set_detail_filter,
    mark,  // only its event: triggers a flight recording
    // Places that a search found for a body, which pull it while set_pull is on.
    add_found_place,  // body and pose, value: its score / the best one; one of another body replaces all
    clear_found_places,
    set_pull,      // value: 1 on, 0 off
    set_flexible,  // value: 1 on, 0 off
    set_together,  // value: 1 on, 0 off
    // The last stroke of the burr, and the last one that was undone.
    undo_stroke,
    redo_stroke,
    // The burr in the first hand. body: DrillShape + 256 x DrillGrit, value: diameter (m), pos_model_m[0]: length of the
    // head (m) of a cylinder or cone.
    set_burr,
    set_burr_speed,  // value: rad/s while its drive is on
    set_irrigation,  // value: m3/s
    set_suction,     // value: m3/s
};
inline constexpr CommandKind kLastCommand = CommandKind::set_suction;
// True for commands that the force model executes or refuses; all others concern the loop.
[[nodiscard]] constexpr bool is_for_model(CommandKind kind) {
    return kind >= CommandKind::select_body && kind <= kLastCommand && kind != CommandKind::mark;
}

enum class CommandResult : std::uint16_t {
    none,
    done,
    refused_state,
    refused_value,
    unknown,
};

struct CommandTopic {
    static constexpr TopicInfo kInfo{.name = "command", .version = 3, .writer = Writer::gui};
    std::uint64_t sequence;  // from 1
    std::int64_t taken_at_ns;
    double value;
    std::uint16_t kind;  // CommandKind
    std::uint16_t reserved;
    std::uint32_t body;
    double pos_model_m[3];  // place_body, add_body, add_found_place
    double quat_model_body_xyzw[4];
    char text[32];            // ends with 0
    std::uint8_t padding[8];  // zero
};
static_assert(std::is_trivially_copyable_v<CommandTopic> && sizeof(CommandTopic) == 128);

}  // namespace tact
