#include "hal/tracker/fix_assembler.hpp"

namespace tact {

void FixAssembler::restart() noexcept {
    sync_order_ = {};
    sync_open_ = false;
    halves_ = {};
    pose_order_ = {};
}

Refusal FixAssembler::follow(Order& order, std::uint16_t counter, unsigned mask) noexcept {
    const unsigned ahead = (counter - order.last) & mask;
    const bool first = !order.known;
    if (!first && ahead == 0) return Refusal::repeated;
    order.known = true;
    order.last = counter;
    if (first) return Refusal::none;
    if (ahead > kCounterLead) return Refusal::jump;
    missed_ += ahead - 1;
    return Refusal::none;
}

Refusal FixAssembler::judge(std::uint8_t status, const Vec3& p_m) const noexcept {
    if ((status & kSensorValid) == 0) return Refusal::sensor_status;
    if (!(p_m.norm() <= settings_.reach_m)) return Refusal::out_of_range;
    return Refusal::none;
}

void FixAssembler::drop_halves() noexcept {
    for (Halves& h : halves_) {
        if (h.pos != h.quat) refused_.add(Refusal::half);
        h = {};
    }
}

Refusal FixAssembler::take_sync(const CanFrame& frame) noexcept {
    SyncFrame sync;
    if (const Refusal r = decode(frame, sync); r != Refusal::none) return r;
    const Refusal order = follow(sync_order_, sync.counter, 0xFFFF);
    if (order == Refusal::repeated) return order;
    drop_halves();
    status_ = sync.status;
    sync_open_ = order == Refusal::none;
    sync_ = sync;
    return order;
}

Refusal FixAssembler::whole_pair(std::uint8_t sensor, TrackerFix& fix, bool& whole) noexcept {
    const Halves& h = halves_[sensor];
    if (!h.pos || !h.quat) return Refusal::none;
    if (sync_.status != TrackerStatus::ok) return Refusal::tracker_status;
    if (const Refusal r = judge(h.status, h.p_m); r != Refusal::none) return r;
    fix.sensor = sensor;
    fix.status = h.status;
    fix.time_us = sync_.time_us;
    fix.T_tracker_sensor.p_m = h.p_m;
    fix.T_tracker_sensor.q = h.q;
    // The classic frames hold only these two bits.
    fix.quality = (h.status & kSensorFar) != 0 ? 0.5 : 1.0;
    fix.distortion = (h.status & kSensorDistorted) != 0 ? 1.0 : 0.0;
    whole = true;
    return Refusal::none;
}

Refusal FixAssembler::take_pos(const CanFrame& frame, TrackerFix& fix, bool& whole) noexcept {
    PosFrame pos;
    if (const Refusal r = decode(frame, pos); r != Refusal::none) return r;
    if (pos.sensor >= settings_.sensors) return Refusal::unknown_id;
    if (!sync_open_ || pos.counter != (sync_.counter & 15U)) return Refusal::no_sync;
    Halves& h = halves_[pos.sensor];
    if (h.pos) return Refusal::repeated;
    h.pos = true;
    h.status = pos.status;
    h.p_m = pos.p_m;
    return whole_pair(pos.sensor, fix, whole);
}

Refusal FixAssembler::take_quat(const CanFrame& frame, TrackerFix& fix, bool& whole) noexcept {
    QuatFrame quat;
    if (const Refusal r = decode(frame, quat); r != Refusal::none) return r;
    if (quat.sensor >= settings_.sensors) return Refusal::unknown_id;
    if (!sync_open_ || quat.counter != (sync_.counter & 15U)) return Refusal::no_sync;
    Halves& h = halves_[quat.sensor];
    if (h.quat) return Refusal::repeated;
    h.quat = true;
    h.q = quat.q;
    return whole_pair(quat.sensor, fix, whole);
}

Refusal FixAssembler::take_pose(const CanFrame& frame, TrackerFix& fix, bool& whole) noexcept {
    PoseFrame pose;
    if (const Refusal r = decode(frame, pose); r != Refusal::none) return r;
    if (pose.sensor >= settings_.sensors) return Refusal::unknown_id;
    if (const Refusal r = follow(pose_order_[pose.sensor], pose.counter, 0xFF); r != Refusal::none) return r;
    if (const Refusal r = judge(pose.status, pose.T_tracker_sensor.p_m); r != Refusal::none) return r;
    fix = {pose.sensor, pose.status, pose.time_us, pose.T_tracker_sensor, pose.quality, pose.distortion};
    whole = true;
    return Refusal::none;
}

bool FixAssembler::take(const CanFrame& frame, TrackerFix& fix) noexcept {
    bool whole = false;
    Refusal why = Refusal::unknown_id;
    if (settings_.format == CanFormat::fd) {
        why = take_pose(frame, fix, whole);
    } else if (frame.id == kSyncId) {
        why = take_sync(frame);
    } else if (frame.id >= kPosId && frame.id < kPosId + kTrackerSensorsMax) {
        why = take_pos(frame, fix, whole);
    } else if (frame.id >= kQuatId && frame.id < kQuatId + kTrackerSensorsMax) {
        why = take_quat(frame, fix, whole);
    }
    if (why != Refusal::none) refused_.add(why);
    return whole;
}

}  // namespace tact
