// Pose and force of a hand, every servo cycle. One per hand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ipc/shm/topic.hpp"

namespace tact {

struct alignas(64) ToolTopic {
    static constexpr TopicInfo kInfo{.name = "tool", .version = 2, .writer = Writer::rt};
    std::int64_t taken_at_ns;
    std::uint64_t cycle;
    double pos_world_m[3];
    double quat_world_tool_xyzw[4];
    double force_world_n[3];  // as sent to the device, after the safety chain
    double torque_world_n_m[3];
    double force_model_n[3];  // from the force model, before the safety chain
    double velocity_world_m_s[3];
    std::uint32_t buttons;      // bit 0: clutch; bit 1: drives the tool
    std::uint8_t device_state;  // DeviceState
    std::uint8_t at_wall;       // 1: a wall of the workspace exerts force
    std::uint8_t reserved[10];  // zero
};
static_assert(std::is_trivially_copyable_v<ToolTopic> && sizeof(ToolTopic) == 192);
static_assert(offsetof(ToolTopic, force_world_n) == 72);

}  // namespace tact
