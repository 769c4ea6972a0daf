#include "hal/falcon/falcon.hpp"

#include <algorithm>

namespace tact {

using falcon::Link;
using falcon::PumpOrder;

namespace {

constexpr Duration kLostAfter = std::chrono::milliseconds(100);

// The clutch is bit 0 of a sample: the middle button of the grip, bit 2 of a reply.
std::uint32_t buttons_of(const falcon::Reply& reply) noexcept {
    const std::uint32_t b = reply.buttons;
    return (b >> 2U & 1U) | (b & 3U) << 1U | (b & 8U);
}

}  // namespace

void Falcon::latch(DeviceNotice fault) noexcept {
    gate_ = false;
    lowered_ = false;
    if (fault_ == DeviceNotice::none) fault_ = fault;  // the first one stays
}

void Falcon::forget_position() noexcept {
    located_ = false;
    configuration_ = {};
    for (VelocityWindow& v : velocity_) v.reset();
    sample_.T_dev_tool = {};
    sample_.twist_dev = {};
}

void Falcon::begin_generation() noexcept {
    if (generation_ != 0)
        latch(news_.jumps != jumps_ ? DeviceNotice::encoder_jumped : DeviceNotice::restarted);
    generation_ = news_.generation;
    jumps_ = news_.jumps;
    forget_position();
}

// Grip position from the counts. Counts that no grip position can have are lost counts.
void Falcon::locate() noexcept {
    const Vec3 leg_rad = legs_.angles_rad(news_.reply.counts);
    Vec3 grip_m;
    if (!legs_.forward(leg_rad, sample_.T_dev_tool.p_m, grip_m)) {
        cause_ = DeviceNotice::count_lost;
        latch(cause_);
        forget_position();
        return;
    }
    located_ = true;
    sample_.T_dev_tool.p_m = grip_m;
    configuration_ = legs_.configuration(grip_m);
    Vec3 rad_s;
    for (std::size_t i = 0; i < 3; ++i) {
        rad_s[static_cast<Eigen::Index>(i)] =
            legs_.rad_per_count() * velocity_[i].push(news_.reply.counts[i], sample_.taken_at);
    }
    sample_.twist_dev.linear_m_s = configuration_.jacobian * rad_s;
}

// Handles a new reply.
void Falcon::take() noexcept {
    replies_ = news_.replies;
    ++sample_.sequence;
    sample_.taken_at = instant_from_ns(news_.taken_at_ns);
    sample_.buttons = buttons_of(news_.reply);
    sample_.delay = Duration(news_.delay_ns);
    cause_ = DeviceNotice::none;
    if (homed()) return locate();
    if (!located_) return;
    cause_ = DeviceNotice::count_lost;
    latch(cause_);
    forget_position();
}

IoStatus Falcon::read(DeviceSample& newest, Instant now) noexcept {
    if (!opened_ || (!pump_->read(news_) && replies_ == 0)) return IoStatus::lost;
    const bool connected = news_.link == Link::open;
    if (connected && news_.generation != generation_) begin_generation();
    const bool fresh = connected && news_.replies != replies_;
    if (fresh) take();
    if (news_.tripped) {
        cause_ = DeviceNotice::watchdog_tripped;
        latch(cause_);
    }
    if (!connected) {
        cause_ = news_.jumps != jumps_ ? DeviceNotice::encoder_jumped : DeviceNotice::gone;
        latch(cause_);
        forget_position();
    } else if (now - sample_.taken_at >= settings_.hold_max) {
        cause_ = DeviceNotice::silent;
        latch(cause_);
    }
    if (fault_ != DeviceNotice::none && lowered_ && cause_ == DeviceNotice::none) fault_ = DeviceNotice::none;

    sample_.state = !connected                                 ? DeviceState::closed
                    : fault_ == DeviceNotice::watchdog_tripped ? DeviceState::watchdog_tripped
                    : fault_ != DeviceNotice::none             ? DeviceState::fault
                    : news_.on                                 ? DeviceState::powered
                                                               : DeviceState::ready;
    sample_.hand_present = located_;
    sample_.notice = fault_ != DeviceNotice::none ? fault_
                     : news_.last_second_bad      ? DeviceNotice::states_refused
                     : located_                   ? DeviceNotice::none
                                                  : DeviceNotice::move_about;
    newest = sample_;
    newest.taken_at = std::min(sample_.taken_at, now);
    if (!connected || now - sample_.taken_at > std::max(kLostAfter, settings_.hold_max))
        return IoStatus::lost;
    if (sample_.state == DeviceState::fault) return IoStatus::fault;
    return fresh ? IoStatus::ok : IoStatus::stale;
}

IoStatus Falcon::write(const DeviceCommand& command, Instant now) noexcept {
    if (!opened_) return IoStatus::lost;
    const std::uint32_t relaxed = pump_->relaxed();
    if (relaxed != relaxed_) gate_ = false;
    relaxed_ = relaxed;
    if (!command.enable) {
        lowered_ = true;
        if (fault_ == DeviceNotice::none && located_) gate_ = true;
    }
    PumpOrder order;
    order.heartbeat = static_cast<std::uint32_t>(command.heartbeat);
    order.generation = generation_;
    order.relaxed = relaxed;
    order.answers_ns = replies_ == 0 ? 0 : to_ns(sample_.taken_at);
    order.written_at_ns = to_ns(now);
    order.enable = command.enable && gate_ && fault_ == DeviceNotice::none && located_;
    if (order.enable && command.wrench_dev.finite())
        order.torque = legs_.drive(configuration_, command.wrench_dev.force_n).torque;
    pump_->write(order);
    if (sample_.state == DeviceState::closed) return IoStatus::lost;
    return sample_.state == DeviceState::fault ? IoStatus::fault : IoStatus::ok;
}

void Falcon::relax() noexcept { pump_->relax(); }

}  // namespace tact
