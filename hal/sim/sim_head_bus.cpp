#include "hal/sim/sim_head_bus.hpp"

#include <linux/can/error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace tact {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kSensorsApartM = 0.1;

}  // namespace

SimHead::SimHead(const SimHeadSettings& s) : rest_m_(s.rest_m), sway_m_(s.sway_m), turn_rad_(s.turn_rad) {
    SeededRandom random(s.seed);
    for (auto& axis : waves_) {
        double sum = 0.0;
        for (Wave& w : axis) {
            w = {kTurn * (0.05 + 0.75 * random.uniform()), kTurn * random.uniform(),
                 0.3 + 0.7 * random.uniform()};
            sum += w.weight;
        }
        for (Wave& w : axis) w.weight /= sum;
    }
}

Pose SimHead::at(unsigned sensor, Instant when) const noexcept {
    const double t_s = to_s(when.time_since_epoch());
    std::array<double, 6> v{};
    for (std::size_t axis = 0; axis < 6; ++axis)
        for (const Wave& w : waves_[axis]) v[axis] += w.weight * std::sin(w.rate_rad_s * t_s + w.phase_rad);
    const Pose T_tracker_head{rest_m_ + sway_m_ * Vec3(v[0], v[1], v[2]),
                              quat_from_rotation_vector(turn_rad_ * Vec3(v[3], v[4], v[5]))};
    return T_tracker_head * Pose{Vec3(kSensorsApartM * sensor, 0.0, 0.0), Quat::Identity()};
}

SimHeadBus::SimHeadBus(const SimHeadSettings& settings, Clock& clock)
    : settings_(settings),
      clock_(clock),
      head_(settings),
      random_(settings.seed ^ 0xB5),
      period_(static_cast<std::int64_t>(1e9 / checked(settings.can).rate_hz)) {}

void SimHeadBus::open() {
    open_ = true;
    start_ = clock_.now();
    due_ = start_ + period_;
    queued_ = given_ = 0;
}

bool SimHeadBus::reopen() noexcept {
    if (fault_.load(std::memory_order_relaxed) == TrackerFault::gone) return false;
    told_ = TrackerFault::none;
    open();
    return true;
}

void SimHeadBus::hold(const Vec3& at_m) noexcept {
    for (int i = 0; i < 3; ++i)
        held_m_[static_cast<std::size_t>(i)].store(at_m[i], std::memory_order_relaxed);
    held_.store(true, std::memory_order_relaxed);
}

Pose SimHeadBus::measured(unsigned sensor, Instant when) const noexcept {
    if (!held_.load(std::memory_order_relaxed)) return head_.at(sensor, when);
    const auto m = [this](std::size_t i) { return held_m_[i].load(std::memory_order_relaxed); };
    return {Vec3(m(0) + kSensorsApartM * sensor, m(1), m(2)), Quat::Identity()};
}

Vec3 SimHeadBus::noise(double deviation) noexcept {
    const auto normal = [this] {  // Box, Muller
        const double size = std::sqrt(-2.0 * std::log(1.0 - random_.uniform()));
        return size * std::cos(kTurn * random_.uniform());
    };
    const double x = normal(), y = normal(), z = normal();
    return deviation * Vec3(x, y, z);
}

void SimHeadBus::measure(TrackerFault fault) noexcept {
    const Instant measured_at = due_ - settings_.can.latency;
    // An independent clock with an arbitrary start.
    const auto time_us = static_cast<std::uint32_t>((due_ - start_).count() / 1000) + 0xFFF00000U;
    const bool fd = settings_.can.fix.format == CanFormat::fd;
    ++counter_;
    if (!fd) queue(encode(SyncFrame{static_cast<std::uint16_t>(counter_), time_us, TrackerStatus::ok}));
    for (std::uint8_t s = 0; s < settings_.can.fix.sensors; ++s) {
        Pose pose = measured(s, measured_at);
        const double far = pose.p_m.norm() / kNoiseAtM;
        const double grown = std::pow(far, 3.5);
        pose.p_m += noise(settings_.noise_m * grown);
        pose.q = quat_from_rotation_vector(noise(settings_.noise_rad * grown)) * pose.q;
        if (fault == TrackerFault::not_a_number) pose.p_m.x() = std::numeric_limits<double>::quiet_NaN();
        if (fault == TrackerFault::out_of_range) pose.p_m = Vec3(9.0, 9.0, 9.0);
        const double quality = std::min(1.0, 1.0 / (far * far));
        const auto low = static_cast<std::uint8_t>(counter_ & 15U);
        if (fd) {
            queue(encode(PoseFrame{s, static_cast<std::uint8_t>(counter_), kSensorValid, time_us, pose,
                                   quality, 0.0}));
        } else {
            queue(encode(PosFrame{s, low, kSensorValid, pose.p_m}));
            queue(encode(QuatFrame{s, low, pose.q}));
        }
    }
    if (fault == TrackerFault::corrupt)
        for (std::size_t i = 0; i < queued_; ++i) frames_[i].data[2] ^= 0x04U;
    due_ += period_;
}

// Reports the state of link and controller, once per change. True: no frames now.
bool SimHeadBus::tell_of(TrackerFault fault, CanBatch& batch) noexcept {
    if (fault == TrackerFault::gone || !open_) {
        batch.fault = CanFault::gone;
        open_ = false;
        return true;
    }
    const TrackerFault before = std::exchange(told_, fault);
    const auto say = [this](std::uint32_t what) {
        CanFrame error;
        error.kind = CanKind::error;
        error.id = what;
        error.length = CAN_ERR_DLC;
        queue(error);
    };
    if (fault != before) {
        queued_ = given_ = 0;
        if (fault == TrackerFault::bus_off) say(CAN_ERR_BUSOFF);
        if (before == TrackerFault::bus_off) say(CAN_ERR_RESTARTED);
        if (fault == TrackerFault::down) batch.fault = CanFault::down;
    }
    return fault == TrackerFault::down;
}

CanBatch SimHeadBus::receive(std::span<CanFrame> into, Duration patience) noexcept {
    CanBatch batch;
    const TrackerFault fault = fault_.load(std::memory_order_relaxed);
    const bool nothing = tell_of(fault, batch);
    if (batch.fault != CanFault::none) return batch;
    Instant now = clock_.now();
    const bool waits = given_ == queued_ && now < due_ && fault != TrackerFault::flood;
    if (patience > Duration{0} && (nothing || waits)) {
        clock_.wait_until(nothing ? now + patience : std::min(due_, now + patience));
        now = clock_.now();
    }
    const bool quiet = nothing || fault == TrackerFault::silent || fault == TrackerFault::bus_off;
    while (batch.count < into.size()) {
        if (given_ < queued_) {
            into[batch.count++] = frames_[given_++];
            continue;
        }
        if (now < due_) break;
        const auto late = (now - due_) / period_;
        const auto lost = late > kBacklog ? static_cast<std::uint32_t>(late - kBacklog) : 0U;
        counter_ += lost;
        due_ += lost * period_;
        if (quiet) {
            ++counter_;
            due_ += period_;
            continue;
        }
        const unsigned a_period = settings_.can.fix.format == CanFormat::fd
                                      ? settings_.can.fix.sensors
                                      : 1 + 2 * settings_.can.fix.sensors;
        batch.dropped += lost * a_period;
        queued_ = given_ = 0;
        measure(fault);
    }
    if (fault == TrackerFault::flood && queued_ > 0)
        while (batch.count < into.size()) into[batch.count++] = frames_[queued_ - 1];
    return batch;
}

}  // namespace tact
