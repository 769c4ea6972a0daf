// How the devices are, hand by hand, ten times a second: how young their samples are and how warm their motors.
// State and notice of a device, and what its bus counted, are in the health topic.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ipc/shm/topic.hpp"

namespace tact {

inline constexpr std::size_t kDeviceHands = 2;

struct DeviceHand {
    std::uint64_t samples;     // that it gave, so far
    std::int64_t age_ns;       // of the newest, in the cycle that publishes; -1: none yet
    std::int64_t age_ns_most;  // in any cycle since the record before
    // What the safety chain holds the force to: the square of the force over the one that the device stands for
    // ever, slow. From 1 on that one is all that is left; 0 where force_n_continuous is 0: no heat is counted.
    float heat;
    float force_n_max, force_n_continuous;
    // Of the hottest motor's winding, degrees C, as the driver counts it; winding_c_max 0: it does not.
    float winding_c, winding_c_max;
    std::uint8_t motor;  // which one that is
    std::uint8_t there;  // 0 or 1
    std::uint8_t state;  // DeviceState
    std::uint8_t read;   // IoStatus of its last read: ok, stale, lost, fault
};

struct alignas(64) DevicesTopic {
    static constexpr TopicInfo kInfo{.name = "devices", .version = 1, .writer = Writer::rt};
    std::int64_t taken_at_ns;
    std::uint64_t cycle;
    DeviceHand hand[kDeviceHands];
    std::uint8_t reserved[16];  // zero
};
static_assert(std::is_trivially_copyable_v<DevicesTopic> && sizeof(DeviceHand) == 48);
static_assert(sizeof(DevicesTopic) == 128 && offsetof(DeviceHand, heat) == 24);

}  // namespace tact
