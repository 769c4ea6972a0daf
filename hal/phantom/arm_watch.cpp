#include "hal/phantom/arm_watch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace tact::phantom {

namespace {

Eigen::Index at(std::size_t i) noexcept { return static_cast<Eigen::Index>(i); }

double moved_rad(const State& a, const State& b, std::size_t i, double rad_per_count) noexcept {
    return std::abs(static_cast<double>(std::int64_t{a.counts[i]} - b.counts[i]) * rad_per_count);
}

}  // namespace

bool ArmWatch::jumped(const State& s, double dt_s) const noexcept {
    for (std::size_t i = 0; i < 6; ++i) {
        const double step = std::abs(p_->rad_per_count[at(i)]);
        if (step > 0.0 && moved_rad(s, before_, i, step) > kRateMax * dt_s + 2.0 * step) return true;
    }
    return false;
}

bool ArmWatch::stuck(const State& s, const Joint6* q) noexcept {
    double way = 0.0;
    std::array<double, 6> moved{};
    for (std::size_t i = 0; i < 3; ++i) way += moved[i] = moved_rad(s, before_, i, p_->rad_per_count[at(i)]);
    bool any = false;
    for (std::size_t i = 0; i < 3; ++i) {
        const double push_a = std::abs(s.current_ma[i]) * 1e-3;
        const bool pushes =
            p_->joint_n_m_per_a[at(i)] != 0.0 && push_a > 0.1 * p_->current_a_continuous[at(i)];
        const bool at_end = q == nullptr || (*q)[at(i)] < p_->low_rad[at(i)] + kAwayRad ||
                            (*q)[at(i)] > p_->high_rad[at(i)] - kAwayRad;
        if (moved[i] > 0.0 || !pushes || at_end)
            others_rad_[i] = 0.0;
        else
            others_rad_[i] += way;
        any = any || others_rad_[i] > kStuckWayRad;
    }
    return any;
}

bool ArmWatch::drive_broken(const PumpNews& news, const std::array<std::int16_t, 6>& limit_ma,
                            std::uint32_t dt_us) noexcept {
    const bool on = (news.state.status & status::kAmplifierOn) != 0;
    bool any = false;
    for (std::size_t i = 0; i < 6; ++i) {
        const int limit = limit_ma[i];
        const int wanted = on && news.seen_known ? std::clamp<int>(news.seen_ma[i], -limit, limit) : 0;
        // Compares with a known command only; with the amplifier off, the current must be zero.
        const bool comparable = limit > 0 && (news.seen_known || !on);
        const bool off = comparable && 5 * std::abs(news.state.current_ma[i] - wanted) > limit;
        off_us_[i] = off ? std::min(off_us_[i] + dt_us, 2 * kDriveUs) : 0;
        any = any || off_us_[i] >= kDriveUs;
    }
    return any;
}

DeviceNotice ArmWatch::look(const PumpNews& news, const std::array<std::int16_t, 6>& limit_ma,
                            const Joint6* q) noexcept {
    const State& s = news.state;
    const std::uint32_t dt_us = started_ ? s.time_us - before_.time_us : 0;
    const bool jump = started_ && jumped(s, std::min(dt_us * 1e-6, 0.1));
    const bool still = started_ && stuck(s, q);
    const bool broken = drive_broken(news, limit_ma, std::min<std::uint32_t>(dt_us, 5'000));
    before_ = s;
    started_ = true;
    const auto has = [&s](std::uint16_t bit) { return (s.status & bit) != 0; };
    if (has(status::kSafetyOpen)) return DeviceNotice::safety_open;
    if (has(status::kBrownOut)) return DeviceNotice::brown_out;
    if (has(status::kOverTemperature)) return DeviceNotice::over_temperature;
    if (has(status::kOverCurrent)) return DeviceNotice::over_current;
    if (has(status::kCountLost)) return DeviceNotice::count_lost;
    if (jump) return DeviceNotice::encoder_jumped;
    if (still) return DeviceNotice::encoder_stuck;
    if (broken) return DeviceNotice::drive_broken;
    if (has(status::kWatchdogTripped)) return DeviceNotice::watchdog_tripped;
    // The board has accepted a command with enable but is off.
    if (news.seen_known && news.seen_enable && !has(status::kAmplifierOn)) return DeviceNotice::amplifier_off;
    return DeviceNotice::none;
}

}  // namespace tact::phantom
