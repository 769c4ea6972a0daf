#include "hal/tracker/pose_frames.hpp"

#include <algorithm>
#include <cmath>

#include "hal/tracker/can_crc.hpp"
#include "ipc/base/units.hpp"

namespace tact {

namespace {

constexpr unsigned kPoseCrcBytes = 2;
constexpr std::uint8_t kStatusBits = kSensorValid | kSensorDistorted | kSensorFar;

std::span<std::uint8_t> begin(CanFrame& frame, std::uint32_t id, CanKind kind, std::uint8_t bytes) noexcept {
    frame.id = id;
    frame.kind = kind;
    frame.length = bytes;
    return {frame.data.data(), bytes};
}

void seal8(CanFrame& frame, const CanSignal& crc) noexcept {
    const std::span<std::uint8_t> data(frame.data.data(), kClassicBytes);
    can_put(crc, crc_of<Crc8>(can_data_id(frame.id), data.first(kClassicBytes - 1U)), data);
}

Refusal check_classic(const CanFrame& f, std::uint32_t id, unsigned copies, const CanSignal& crc) noexcept {
    if (f.id < id || f.id >= id + copies) return Refusal::unknown_id;
    if (f.kind != CanKind::classic || f.length != kClassicBytes) return Refusal::wrong_length;
    const auto data = f.payload();
    if (crc_of<Crc8>(can_data_id(f.id), data.first(kClassicBytes - 1U)) != can_raw(crc, data))
        return Refusal::crc;
    return Refusal::none;
}

// Nearest step, clamped to the range; the lowest raw number is not used, so that the range is symmetric.
void put_steps(const CanSignal& s, double value, std::span<std::uint8_t> data) noexcept {
    const double end = static_cast<double>((1U << (s.bits - 1)) - 1U);
    const double steps = std::clamp(std::round(value / s.scale), -end, end);
    can_put(s, static_cast<std::uint32_t>(static_cast<std::int32_t>(steps)), data);
}

void put_position(const CanSignal& x, const CanSignal& y, const CanSignal& z, const Vec3& p_m,
                  std::span<std::uint8_t> data) noexcept {
    put_steps(x, p_m.x() / kMillimetreM, data);
    put_steps(y, p_m.y() / kMillimetreM, data);
    put_steps(z, p_m.z() / kMillimetreM, data);
}

Vec3 position_m(const CanSignal& x, const CanSignal& y, const CanSignal& z,
                std::span<const std::uint8_t> data) noexcept {
    const auto m = [data](const CanSignal& s) { return can_signed(s, data) * (s.scale * kMillimetreM); };
    return {m(x), m(y), m(z)};
}

void put_rotation(const CanSignal& x, const CanSignal& y, const CanSignal& z, const CanSignal& w,
                  const Quat& q, std::span<std::uint8_t> data) noexcept {
    const double sign = q.w() < 0.0 ? -1.0 : 1.0;
    put_steps(x, sign * q.x(), data);
    put_steps(y, sign * q.y(), data);
    put_steps(z, sign * q.z(), data);
    put_steps(w, sign * q.w(), data);
}

Refusal rotation(const CanSignal& x, const CanSignal& y, const CanSignal& z, const CanSignal& w,
                 std::span<const std::uint8_t> data, Quat& out) noexcept {
    const auto part = [data](const CanSignal& s) { return can_signed(s, data) * s.scale; };
    const Quat q(part(w), part(x), part(y), part(z));
    if (q.w() < 0.0) return Refusal::malformed;
    const double norm = q.norm();
    if (!(std::abs(norm - 1.0) <= kQuatNormError)) return Refusal::norm;
    out.coeffs() = q.coeffs() / norm;
    return Refusal::none;
}

std::uint32_t share(double value) noexcept {
    return value > 0.0 ? static_cast<std::uint32_t>(std::lround(std::min(value, 1.0) * 255.0)) : 0U;
}

}  // namespace

CanFrame encode(const SyncFrame& sync) noexcept {
    CanFrame f;
    const auto data = begin(f, kSyncId, CanKind::classic, kClassicBytes);
    can_put(can_sync::kCounter, sync.counter, data);
    can_put(can_sync::kTime, sync.time_us, data);
    can_put(can_sync::kStatus, static_cast<std::uint32_t>(sync.status), data);
    seal8(f, can_sync::kCrc);
    return f;
}

CanFrame encode(const PosFrame& pos) noexcept {
    CanFrame f;
    const auto data = begin(f, kPosId + pos.sensor, CanKind::classic, kClassicBytes);
    const bool finite = pos.p_m.allFinite();
    put_position(can_pos::kX, can_pos::kY, can_pos::kZ, finite ? pos.p_m : Vec3(Vec3::Zero()), data);
    can_put(can_pos::kStatus, finite ? pos.status : pos.status & ~unsigned{kSensorValid}, data);
    can_put(can_pos::kCounter, pos.counter, data);
    seal8(f, can_pos::kCrc);
    return f;
}

CanFrame encode(const QuatFrame& quat) noexcept {
    CanFrame f;
    const auto data = begin(f, kQuatId + quat.sensor, CanKind::classic, kClassicBytes);
    // A quaternion has no validity flag: zeros fail by their norm.
    const Quat q = quat.q.coeffs().allFinite() ? quat.q : Quat(0.0, 0.0, 0.0, 0.0);
    put_rotation(can_quat::kX, can_quat::kY, can_quat::kZ, can_quat::kW, q, data);
    can_put(can_quat::kCounter, quat.counter, data);
    seal8(f, can_quat::kCrc);
    return f;
}

CanFrame encode(const PoseFrame& pose) noexcept {
    CanFrame f;
    const auto data = begin(f, kPoseId + pose.sensor, CanKind::fd, kPoseBytes);
    const bool finite = pose.T_tracker_sensor.finite();
    const Pose T = finite ? pose.T_tracker_sensor : Pose{};
    can_put(can_pose::kCounter, pose.counter, data);
    can_put(can_pose::kSensor, pose.sensor, data);
    can_put(can_pose::kStatus, finite ? pose.status : pose.status & ~unsigned{kSensorValid}, data);
    can_put(can_pose::kTime, pose.time_us, data);
    put_position(can_pose::kX, can_pose::kY, can_pose::kZ, T.p_m, data);
    put_rotation(can_pose::kQx, can_pose::kQy, can_pose::kQz, can_pose::kQw, T.q, data);
    can_put(can_pose::kQuality, share(pose.quality), data);
    can_put(can_pose::kDistortion, share(pose.distortion), data);
    can_put(can_pose::kCrc, crc_of<Crc16>(can_data_id(f.id), data.subspan(kPoseCrcBytes)), data);
    return f;
}

Refusal decode(const CanFrame& frame, SyncFrame& out) noexcept {
    if (const Refusal r = check_classic(frame, kSyncId, 1, can_sync::kCrc); r != Refusal::none) return r;
    const auto data = frame.payload();
    const std::uint32_t status = can_raw(can_sync::kStatus, data);
    if (status > static_cast<std::uint32_t>(TrackerStatus::fault)) return Refusal::malformed;
    out.counter = static_cast<std::uint16_t>(can_raw(can_sync::kCounter, data));
    out.time_us = can_raw(can_sync::kTime, data);
    out.status = static_cast<TrackerStatus>(status);
    return Refusal::none;
}

Refusal decode(const CanFrame& frame, PosFrame& out) noexcept {
    if (const Refusal r = check_classic(frame, kPosId, kTrackerSensorsMax, can_pos::kCrc); r != Refusal::none)
        return r;
    const auto data = frame.payload();
    const std::uint32_t status = can_raw(can_pos::kStatus, data);
    if ((status & ~unsigned{kStatusBits}) != 0) return Refusal::malformed;
    out.sensor = static_cast<std::uint8_t>(frame.id - kPosId);
    out.counter = static_cast<std::uint8_t>(can_raw(can_pos::kCounter, data));
    out.status = static_cast<std::uint8_t>(status);
    out.p_m = position_m(can_pos::kX, can_pos::kY, can_pos::kZ, data);
    return Refusal::none;
}

Refusal decode(const CanFrame& frame, QuatFrame& out) noexcept {
    if (const Refusal r = check_classic(frame, kQuatId, kTrackerSensorsMax, can_quat::kCrc);
        r != Refusal::none)
        return r;
    const auto data = frame.payload();
    if (const Refusal r = rotation(can_quat::kX, can_quat::kY, can_quat::kZ, can_quat::kW, data, out.q);
        r != Refusal::none)
        return r;
    out.sensor = static_cast<std::uint8_t>(frame.id - kQuatId);
    out.counter = static_cast<std::uint8_t>(can_raw(can_quat::kCounter, data));
    return Refusal::none;
}

Refusal decode(const CanFrame& frame, PoseFrame& out) noexcept {
    if (frame.id < kPoseId || frame.id >= kPoseId + kTrackerSensorsMax) return Refusal::unknown_id;
    if (frame.kind != CanKind::fd || frame.length != kPoseBytes) return Refusal::wrong_length;
    const auto data = frame.payload();
    if (crc_of<Crc16>(can_data_id(frame.id), data.subspan(kPoseCrcBytes)) != can_raw(can_pose::kCrc, data))
        return Refusal::crc;
    const std::uint32_t status = can_raw(can_pose::kStatus, data);
    const std::uint32_t sensor = can_raw(can_pose::kSensor, data);
    if ((status & ~unsigned{kStatusBits}) != 0 || sensor != frame.id - kPoseId) return Refusal::malformed;
    Quat q;
    if (const Refusal r = rotation(can_pose::kQx, can_pose::kQy, can_pose::kQz, can_pose::kQw, data, q);
        r != Refusal::none)
        return r;
    out.sensor = static_cast<std::uint8_t>(sensor);
    out.counter = static_cast<std::uint8_t>(can_raw(can_pose::kCounter, data));
    out.status = static_cast<std::uint8_t>(status);
    out.time_us = can_raw(can_pose::kTime, data);
    out.T_tracker_sensor = {position_m(can_pose::kX, can_pose::kY, can_pose::kZ, data), q};
    out.quality = can_raw(can_pose::kQuality, data) * can_pose::kQuality.scale;
    out.distortion = can_raw(can_pose::kDistortion, data) * can_pose::kDistortion.scale;
    return Refusal::none;
}

}  // namespace tact
