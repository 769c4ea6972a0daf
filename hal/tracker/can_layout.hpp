// Layout of the tracker's frames: the same as tact_tracker.dbc; a test compares the two.
//
// Bits     little endian ("Intel"): start is the lowest bit, bit 0 the lowest bit of byte 0
// Units    of a signal as sent; physical value = raw * scale
// Classic  1 Mbit/s: SYNC opens a period, then POS and QUAT of every sensor, which carry the low bits of
//          its counter
// FD       1/5 Mbit/s: one POSE per sensor and period
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace tact {

inline constexpr unsigned kTrackerSensorsMax = 4;

inline constexpr std::uint32_t kSyncId = 0x0F0;
inline constexpr std::uint32_t kPosId = 0x100;  // + sensor
inline constexpr std::uint32_t kQuatId = 0x110;
inline constexpr std::uint32_t kPoseId = 0x200;
inline constexpr std::uint8_t kClassicBytes = 8;
inline constexpr std::uint8_t kPoseBytes = 24;

// Data id that enters the checksum before the bytes.
[[nodiscard]] constexpr std::uint16_t can_data_id(std::uint32_t id) noexcept {
    return static_cast<std::uint16_t>(0x5400U + id);
}

struct CanSignal {
    const char* name;
    unsigned start, bits;
    bool is_signed;
    double scale;
    const char* unit;
};

inline constexpr double kPositionStepMm = 0.05;
inline constexpr double kQuat13Step = 1.0 / 4095.0;
inline constexpr double kQuat16Step = 1.0 / 32768.0;

namespace can_sync {
inline constexpr CanSignal kCounter{"Counter", 0, 16, false, 1.0, ""};
inline constexpr CanSignal kTime{"Time", 16, 32, false, 1.0, "us"};
inline constexpr CanSignal kStatus{"Status", 48, 8, false, 1.0, ""};
inline constexpr CanSignal kCrc{"Crc", 56, 8, false, 1.0, ""};
inline constexpr std::array kSignals{kCounter, kTime, kStatus, kCrc};
}  // namespace can_sync

namespace can_pos {
inline constexpr CanSignal kX{"X", 0, 16, true, kPositionStepMm, "mm"};
inline constexpr CanSignal kY{"Y", 16, 16, true, kPositionStepMm, "mm"};
inline constexpr CanSignal kZ{"Z", 32, 16, true, kPositionStepMm, "mm"};
inline constexpr CanSignal kStatus{"Status", 48, 4, false, 1.0, ""};
inline constexpr CanSignal kCounter{"Counter", 52, 4, false, 1.0, ""};
inline constexpr CanSignal kCrc{"Crc", 56, 8, false, 1.0, ""};
inline constexpr std::array kSignals{kX, kY, kZ, kStatus, kCounter, kCrc};
}  // namespace can_pos

namespace can_quat {
inline constexpr CanSignal kX{"Qx", 0, 13, true, kQuat13Step, ""};
inline constexpr CanSignal kY{"Qy", 13, 13, true, kQuat13Step, ""};
inline constexpr CanSignal kZ{"Qz", 26, 13, true, kQuat13Step, ""};
inline constexpr CanSignal kW{"Qw", 39, 13, true, kQuat13Step, ""};
inline constexpr CanSignal kCounter{"Counter", 52, 4, false, 1.0, ""};
inline constexpr CanSignal kCrc{"Crc", 56, 8, false, 1.0, ""};
inline constexpr std::array kSignals{kX, kY, kZ, kW, kCounter, kCrc};
}  // namespace can_quat

namespace can_pose {
inline constexpr CanSignal kCrc{"Crc", 0, 16, false, 1.0, ""};
inline constexpr CanSignal kCounter{"Counter", 16, 8, false, 1.0, ""};
inline constexpr CanSignal kSensor{"Sensor", 24, 4, false, 1.0, ""};
inline constexpr CanSignal kStatus{"Status", 28, 4, false, 1.0, ""};
inline constexpr CanSignal kTime{"Time", 32, 32, false, 1.0, "us"};
inline constexpr CanSignal kX{"X", 64, 16, true, kPositionStepMm, "mm"};
inline constexpr CanSignal kY{"Y", 80, 16, true, kPositionStepMm, "mm"};
inline constexpr CanSignal kZ{"Z", 96, 16, true, kPositionStepMm, "mm"};
inline constexpr CanSignal kQx{"Qx", 112, 16, true, kQuat16Step, ""};
inline constexpr CanSignal kQy{"Qy", 128, 16, true, kQuat16Step, ""};
inline constexpr CanSignal kQz{"Qz", 144, 16, true, kQuat16Step, ""};
inline constexpr CanSignal kQw{"Qw", 160, 16, true, kQuat16Step, ""};
inline constexpr CanSignal kQuality{"Quality", 176, 8, false, 1.0 / 255.0, ""};
inline constexpr CanSignal kDistortion{"Distortion", 184, 8, false, 1.0 / 255.0, ""};
inline constexpr std::array kSignals{kCrc, kCounter, kSensor, kStatus, kTime, kX,       kY,
                                     kZ,   kQx,      kQy,     kQz,     kQw,   kQuality, kDistortion};
}  // namespace can_pose

struct CanMessage {
    const char* name;  // in the .dbc, where the names of per-sensor messages end in the sensor number
    std::uint32_t id;  // of sensor 0
    unsigned copies;   // one per sensor, or 1
    std::uint8_t bytes;
    bool fd;
    std::span<const CanSignal> signals;
};

inline constexpr std::array kTrackerMessages{
    CanMessage{"TactSync", kSyncId, 1, kClassicBytes, false, can_sync::kSignals},
    CanMessage{"TactPos", kPosId, kTrackerSensorsMax, kClassicBytes, false, can_pos::kSignals},
    CanMessage{"TactQuat", kQuatId, kTrackerSensorsMax, kClassicBytes, false, can_quat::kSignals},
    CanMessage{"TactPose", kPoseId, kTrackerSensorsMax, kPoseBytes, true, can_pose::kSignals},
};

// Status of a SYNC: the tracker's own state.
enum class TrackerStatus : std::uint8_t { ok = 0, starting = 1, no_source = 2, fault = 3 };
// Status bits of a sensor.
inline constexpr std::uint8_t kSensorValid = 1;      // without it the pose is invalid
inline constexpr std::uint8_t kSensorDistorted = 2;  // metal nearby: usable, but less accurate
inline constexpr std::uint8_t kSensorFar = 4;        // at the edge of the field: noise grows with distance^4

[[nodiscard]] constexpr std::uint32_t can_raw(const CanSignal& s,
                                              std::span<const std::uint8_t> data) noexcept {
    std::uint64_t word = 0;
    const unsigned first = s.start / 8, last = (s.start + s.bits - 1) / 8;
    for (unsigned i = last + 1; i-- > first;) word = word << 8 | (i < data.size() ? data[i] : 0U);
    return static_cast<std::uint32_t>(word >> (s.start % 8) & ((std::uint64_t{1} << s.bits) - 1));
}

[[nodiscard]] constexpr std::int32_t can_signed(const CanSignal& s,
                                                std::span<const std::uint8_t> data) noexcept {
    const std::uint32_t raw = can_raw(s, data);
    const std::uint32_t sign = std::uint32_t{1} << (s.bits - 1);
    return static_cast<std::int32_t>((raw ^ sign) - sign);
}

// The bits must be zero before the call.
constexpr void can_put(const CanSignal& s, std::uint32_t raw, std::span<std::uint8_t> data) noexcept {
    const std::uint64_t word = (std::uint64_t{raw} & ((std::uint64_t{1} << s.bits) - 1)) << (s.start % 8);
    const unsigned first = s.start / 8, last = (s.start + s.bits - 1) / 8;
    for (unsigned i = first; i <= last && i < data.size(); ++i)
        data[i] = static_cast<std::uint8_t>(data[i] | (word >> (8 * (i - first)) & 0xFFU));
}

}  // namespace tact
