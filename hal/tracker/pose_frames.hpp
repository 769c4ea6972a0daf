// The tracker's frames as bytes: encoded by emulators and tests, decoded by the driver.
//
// Frame    the tracker's own, right-handed; metres, unit quaternions
// Decode   looks at one frame alone: its length, checksum and values. What comes out is finite and within
//          what the layout can say, whatever the bytes were; not `none` leaves `out` as it was.
// Encode   rounds to the layout's steps and stops at its ends; a pose that is not finite becomes one that is
//          marked as not valid. CAN cannot carry a value that is not a number.
// Thread   any; no allocation
#pragma once

#include <cstdint>

#include "hal/tracker/can_frame.hpp"
#include "hal/tracker/can_layout.hpp"
#include "hal/tracker/refusals.hpp"
#include "ipc/base/pose.hpp"

namespace tact {

inline constexpr double kQuatNormError = 0.01;  // 13 bits leave 2.5e-4 at most

struct SyncFrame {
    std::uint16_t counter = 0;
    std::uint32_t time_us = 0;  // the tracker's clock
    TrackerStatus status = TrackerStatus::ok;
};

struct PosFrame {
    std::uint8_t sensor = 0;
    std::uint8_t counter = 0;  // low four bits of the SYNC's
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
    double quality = 1.0;     // 0 to 1, as the tracker judges itself
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
