// The tracker's frames as bytes: encoded by emulators and tests, decoded by the driver.
//
// Frame    the tracker's own, right-handed; metres, unit quaternions
// Decode   checks one frame alone: its length, checksum and values. Decoded values are finite and within
//          the range of the layout, whatever the bytes were; on a result other than `none`, `out` is
//          unchanged.
// Encode   rounds to the layout's steps and clamps to its range; a pose that is not finite is marked as not
//          valid, since CAN cannot carry NaN.
// Thread   any; no allocation
#pragma once

#include <cstdint>

#include "hal/tracker/can_frame.hpp"
#include "hal/tracker/can_layout.hpp"
#include "hal/tracker/refusals.hpp"
#include "ipc/base/pose.hpp"

namespace tact {

inline constexpr double kQuatNormError = 0.01;  // 13 bits cause at most 2.5e-4

struct SyncFrame {
    std::uint16_t counter = 0;
    std::uint32_t time_us = 0;  // the tracker's clock
    TrackerStatus status = TrackerStatus::ok;
};

struct PosFrame {
    std::uint8_t sensor = 0;
    std::uint8_t counter = 0;  // low four bits of the SYNC counter
    std::uint8_t status = kSensorValid;
    Vec3 p_m = Vec3::Zero();
};

struct QuatFrame {
    std::uint8_t sensor = 0;
    std::uint8_t counter = 0;
    Quat q = Quat::Identity();
};

struct PoseFrame {
    std::uint8_t sensor = 0;
    std::uint8_t counter = 0;  // of this sensor
    std::uint8_t status = kSensorValid;
    std::uint32_t time_us = 0;
    Pose T_tracker_sensor;
    double quality = 1.0;     // 0 to 1, as the tracker reports it
    double distortion = 0.0;  // 0 to 1
};

[[nodiscard]] CanFrame encode(const SyncFrame& sync) noexcept;
[[nodiscard]] CanFrame encode(const PosFrame& pos) noexcept;
[[nodiscard]] CanFrame encode(const QuatFrame& quat) noexcept;
[[nodiscard]] CanFrame encode(const PoseFrame& pose) noexcept;

[[nodiscard]] Refusal decode(const CanFrame& frame, SyncFrame& out) noexcept;
[[nodiscard]] Refusal decode(const CanFrame& frame, PosFrame& out) noexcept;
[[nodiscard]] Refusal decode(const CanFrame& frame, QuatFrame& out) noexcept;
[[nodiscard]] Refusal decode(const CanFrame& frame, PoseFrame& out) noexcept;

}  // namespace tact
