// The mouse as a hand: a pointer in the window leads an emulated hand. So do a SpaceMouse and a gamepad: the window moves the target for them.
//
// MouseTopic       from the window, every frame while the pointer holds a tool, and once when it lets go: where the hand is to be
// MouseStateTopic  from the housekeeping thread, at every change and ten times a second: which hands a pointer may lead, and which it leads
// Frame            world, SI; the pose is that of the tool, absolute, so a lost record changes nothing
// Stale            a record that is not renewed within kMouseStaleNs counts as having let go
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ipc/shm/topic.hpp"

namespace tact {

inline constexpr std::size_t kMouseHands = 2;
inline constexpr std::int64_t kMouseStaleNs = 250'000'000;

// What a person holds at the window instead of an arm.
enum class LeadDevice : std::uint8_t { mouse, spacemouse, gamepad, count };
inline constexpr std::array kLeadDeviceNames{"mouse", "spacemouse", "gamepad"};  // in options and reports

struct alignas(64) MouseTopic {
    static constexpr TopicInfo kInfo{.name = "mouse", .version = 1, .writer = Writer::gui};
    static constexpr double kReachM = 1.0;  // no arm's workspace is larger; each arm bounds it further
    static constexpr std::uint32_t kButtons = 3;
    std::int64_t taken_at_ns;
    std::uint64_t generation;  // of the controller's region: a record for another controller is refused
    double pos_world_m[3];
    double quat_world_tool_xyzw[4];
    std::uint32_t buttons;      // of the stylus, as ToolTopic::buttons
    std::uint8_t hand;          // 0 or 1
    std::uint8_t holds;         // 1: the pointer holds the tool; 0: it lets go
    std::uint8_t device;        // LeadDevice that moves the target
    std::uint8_t reserved[45];  // zero
};
static_assert(std::is_trivially_copyable_v<MouseTopic> && sizeof(MouseTopic) == 128);

// False: some field has an impossible value.
[[nodiscard]] inline bool sensible(const MouseTopic& t) noexcept {
    double square = 0.0;
    for (const double p : t.pos_world_m)
        if (!(std::abs(p) <= MouseTopic::kReachM)) return false;  // also what is not a number
    for (const double q : t.quat_world_tool_xyzw) square += q * q;
    return square > 0.98 && square < 1.02 && (t.buttons & ~MouseTopic::kButtons) == 0 &&
           t.hand < kMouseHands && t.holds <= 1 && t.device < static_cast<std::uint8_t>(LeadDevice::count);
}

enum class MouseLead : std::uint8_t {
    none,   // the hand is a person's, or moves by its script alone
    may,    // a pointer may take it
    leads,  // a pointer holds it
    stale,  // the pointer held it and fell silent; the hand has relaxed
};

struct alignas(64) MouseStateTopic {
    static constexpr TopicInfo kInfo{.name = "mouse state", .version = 1, .writer = Writer::rt};
    std::int64_t taken_at_ns;
    std::uint64_t accepted;  // records passed on to a hand
    std::uint64_t
        refused;  // records with an impossible value, for another controller, or for a hand that follows no pointer
    std::uint64_t stale;             // times that a pointer fell silent while it held a hand
    std::uint8_t lead[kMouseHands];  // MouseLead
    std::uint8_t wanted
        [kMouseHands];  // LeadDevice that the configuration names for this hand; the mouse if it names none
    std::uint8_t by[kMouseHands];  // LeadDevice that leads it, or led it last
    std::uint8_t reserved[26];     // zero
};
static_assert(std::is_trivially_copyable_v<MouseStateTopic> && sizeof(MouseStateTopic) == 64);

[[nodiscard]] inline bool sensible(const MouseStateTopic& t) noexcept {
    for (const std::uint8_t lead : t.lead)
        if (lead > static_cast<std::uint8_t>(MouseLead::stale)) return false;
    for (std::size_t i = 0; i < kMouseHands; ++i)
        if (t.wanted[i] >= static_cast<std::uint8_t>(LeadDevice::count) ||
            t.by[i] >= static_cast<std::uint8_t>(LeadDevice::count))
            return false;
    return true;
}

}  // namespace tact
