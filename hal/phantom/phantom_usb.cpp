#include "hal/phantom/phantom_usb.hpp"

#include <algorithm>
#include <cmath>

#include "hal/arm/arm_drive.hpp"

namespace tact {

using phantom::Link;
using phantom::PumpNews;
using phantom::PumpOrder;

namespace {

constexpr Duration kLostAfter = std::chrono::milliseconds(100);
constexpr Duration kBehindMax = std::chrono::milliseconds(10);  // or the longest permitted age of a state

// Faults after which the counts are invalid.
bool loses_count(DeviceNotice n) noexcept {
    return n == DeviceNotice::count_lost || n == DeviceNotice::encoder_jumped ||
           n == DeviceNotice::encoder_stuck || n == DeviceNotice::brown_out || n == DeviceNotice::gone ||
           n == DeviceNotice::restarted;
}

}  // namespace

void PhantomUsb::latch(DeviceNotice fault) noexcept {
    gate_ = false;
    lowered_ = false;
    if (fault_ == DeviceNotice::none) fault_ = fault;  // the first one stays
    if (loses_count(fault)) forget_counts();
}

void PhantomUsb::forget_counts() noexcept {
    calibration_.restart();
    velocity_.reset();
    sample_.T_dev_tool = {};
    sample_.twist_dev = {};
}

Joint6 PhantomUsb::limits_a() const noexcept {
    const ArmParameters& p = arm_.parameters();
    Joint6 limit;
    for (Eigen::Index i = 0; i < 6; ++i) {
        const double most = limit_ma_[static_cast<std::size_t>(i)] * 1e-3;
        const bool warms = p.heat_known && i < 3;  // thermal parameters exist for the arm's three motors
        limit[i] = warms ? current_limit_a(p.heat, heat_[static_cast<std::size_t>(i)], most)
                         : std::min(most, p.current_a_continuous[i]);
    }
    return limit;
}

void PhantomUsb::heat() noexcept {
    const ArmParameters& p = arm_.parameters();
    if (!p.heat_known || states_ == 0) return;
    const double dt_s = std::min((news_.state.time_us - time_us_) * 1e-6, 1.0);
    for (std::size_t i = 0; i < 3; ++i)
        heat_[i] = heated(p.heat, heat_[i], news_.state.current_ma[i] * 1e-3, dt_s);
    std::size_t hottest = 0;
    for (std::size_t i = 1; i < 3; ++i)
        if (heat_[i].winding_c > heat_[hottest].winding_c) hottest = i;
    sample_.winding_c = static_cast<float>(heat_[hottest].winding_c);
    sample_.winding_c_max = static_cast<float>(p.heat.winding_c_max);
    sample_.hottest_motor = static_cast<std::uint8_t>(hottest);
}

void PhantomUsb::calibrate(Instant now) noexcept {
    const phantom::State& s = news_.state;
    CalibrationInput in;
    in.counts = s.counts;
    in.counts_valid = !loses_count(cause_);
    in.inkwell = (s.inputs & phantom::input::kInkwell) != 0;
    in.confirm = (s.inputs & 1U) != 0;
    in.device_calibrated = (s.status & phantom::status::kCalibrated) != 0;
    const bool was_done = calibration_.force_allowed();
    calibration_.step(in, now);
    if (was_done && !calibration_.force_allowed()) latch(DeviceNotice::count_lost);
}

// Handles a new state.
void PhantomUsb::take(Instant now) noexcept {
    const phantom::State& s = news_.state;
    const bool known = calibration_.force_allowed();
    const Joint6 q = arm_.angles_rad(s.counts, calibration_.zero());
    cause_ = watch_.look(news_, limit_ma_, known ? &q : nullptr);
    if (cause_ != DeviceNotice::none) latch(cause_);
    calibrate(now);
    heat();
    states_ = news_.states;
    time_us_ = s.time_us;
    ++sample_.sequence;
    sample_.taken_at = instant_from_ns(news_.taken_at_ns);
    sample_.buttons = s.inputs & phantom::input::kButtons;
    sample_.delay = Duration(news_.delay_ns);
    if (!calibration_.force_allowed()) return;
    q_ = arm_.angles_rad(s.counts, calibration_.zero());
    sample_.T_dev_tool = arm_.pose(q_);
    sample_.twist_dev = velocity_.push(s.counts, q_, sample_.taken_at);
}

DeviceNotice PhantomUsb::silence(Instant now) const noexcept {
    if (now - sample_.taken_at >= settings_.hold_max) return DeviceNotice::silent;
    if (news_.behind_since_ns != 0 &&
        now - instant_from_ns(news_.behind_since_ns) >= std::max(kBehindMax, settings_.hold_max))
        return DeviceNotice::commands_not_taken;
    return DeviceNotice::none;
}

IoStatus PhantomUsb::read(DeviceSample& newest, Instant now) noexcept {
    if (!opened_ || (!pump_->read(news_) && states_ == 0)) return IoStatus::lost;
    const bool connected = news_.link == Link::open || news_.link == Link::asking;
    if (connected && news_.generation != generation_) {
        if (generation_ != 0) latch(DeviceNotice::restarted);
        generation_ = news_.generation;
        watch_.restart();
        forget_counts();
        for (std::size_t i = 0; i < 6; ++i) {
            const auto j = static_cast<Eigen::Index>(i);
            const double arm_ma =
                arm_.parameters().joint_n_m_per_a[j] == 0.0 ? 0.0 : arm_.parameters().current_a_max[j] * 1e3;
            limit_ma_[i] = static_cast<std::int16_t>(
                std::clamp(std::min<double>(news_.info.current_ma_max[i], arm_ma), 0.0, 32767.0));
        }
    }
    const bool fresh = news_.states != states_;
    if (fresh) take(now);
    if (!connected) {
        cause_ = DeviceNotice::gone;
        latch(cause_);
    } else if (const DeviceNotice quiet = silence(now); quiet != DeviceNotice::none) {
        cause_ = quiet;
        latch(quiet);
    } else if (!fresh && cause_ == DeviceNotice::gone) {
        cause_ = DeviceNotice::none;
    }
    if (fault_ != DeviceNotice::none && lowered_ && cause_ == DeviceNotice::none) fault_ = DeviceNotice::none;

    const bool on = (news_.state.status & phantom::status::kAmplifierOn) != 0;
    sample_.state = !connected                                 ? DeviceState::closed
                    : fault_ == DeviceNotice::watchdog_tripped ? DeviceState::watchdog_tripped
                    : fault_ != DeviceNotice::none             ? DeviceState::fault
                    : on                                       ? DeviceState::powered
                                                               : DeviceState::ready;
    sample_.hand_present =
        calibration_.force_allowed() && (news_.state.inputs & phantom::input::kInkwell) == 0;
    sample_.notice = fault_ != DeviceNotice::none ? fault_
                     : news_.last_second_bad      ? DeviceNotice::states_refused
                                                  : calibration_.asks();
    sample_.bus = news_.counts.shown();
    newest = sample_;
    newest.taken_at = std::min(sample_.taken_at, now);
    if (!connected || now - sample_.taken_at > std::max(kLostAfter, settings_.hold_max))
        return IoStatus::lost;
    if (sample_.state == DeviceState::fault) return IoStatus::fault;
    return fresh ? IoStatus::ok : IoStatus::stale;
}

IoStatus PhantomUsb::write(const DeviceCommand& command, Instant now) noexcept {
    if (!opened_) return IoStatus::lost;
    const std::uint32_t relaxed = pump_->relaxed();
    if (relaxed != relaxed_) gate_ = false;
    relaxed_ = relaxed;
    if (!command.enable) {
        lowered_ = true;
        if (fault_ == DeviceNotice::none) gate_ = true;
    }
    PumpOrder order;
    order.heartbeat = static_cast<std::uint32_t>(command.heartbeat);
    order.generation = generation_;
    order.relaxed = relaxed;
    order.state_us = states_ == 0 ? 0 : time_us_;
    order.written_at_ns = to_ns(now);
    order.enable = command.enable && gate_ && fault_ == DeviceNotice::none && calibration_.force_allowed();
    if (order.enable) {
        const Wrench wrench = command.wrench_dev.finite() ? command.wrench_dev : Wrench{};
        const DriveCurrents drive = drive_currents(arm_, q_, wrench, arm_.gravity_n_m(q_), limits_a());
        for (std::size_t i = 0; i < 6; ++i) {
            const double ma = drive.current_a[static_cast<Eigen::Index>(i)] * 1e3;
            order.current_ma[i] =
                static_cast<std::int16_t>(std::clamp<double>(std::round(ma), -limit_ma_[i], limit_ma_[i]));
        }
    }
    pump_->write(order);
    if (sample_.state == DeviceState::closed) return IoStatus::lost;
    return sample_.state == DeviceState::fault ? IoStatus::fault : IoStatus::ok;
}

void PhantomUsb::relax() noexcept {
    if (pump_) pump_->relax();
}

}  // namespace tact
