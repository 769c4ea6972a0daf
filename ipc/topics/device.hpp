// State of the devices, per hand, ten times per second: age of their samples and heat of their motors. The
// health topic holds a device's state and notice, and its bus counters.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ipc/shm/topic.hpp"

namespace tact {

inline constexpr std::size_t kDeviceHands = 2;

struct DeviceHand {
    std::uint64_t samples;     // received so far
    std::int64_t age_ns;       // of the newest, in the publishing cycle; -1: none yet
    std::int64_t age_ns_most;  // in any cycle since the previous record
    // Thermal load in the safety chain: low-pass filtered square of the force relative to the continuous
    // force. From 1 on, the force is limited to the continuous one; 0 where force_n_continuous is 0: no
    // thermal model.
    float heat;
    float force_n_max, force_n_continuous;
    // Temperature of the hottest winding in degrees C from the driver's thermal model; winding_c_max 0: no model.
    float winding_c, winding_c_max;
    std::uint8_t motor;  // index of the hottest motor
    std::uint8_t valid;  // 0 or 1
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
