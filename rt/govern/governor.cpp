#include "rt/govern/governor.hpp"

#include <algorithm>
#include <cmath>

namespace tact {

Governor::Governor(const GovernorSettings& settings) noexcept : settings_(settings) {}

namespace {
bool possible(const KnobSpec& knob) noexcept {
    return knob.floor >= 0.0F && knob.floor <= 1.0F && knob.start >= knob.floor && knob.start <= 1.0F &&
           knob.slew_per_s > 0.0F;
}
}  // namespace

std::size_t Governor::add(const KnobSpec& knob) noexcept {
    if (count_ == kPathsMax || !possible(knob)) return kPathsMax;
    paths_[count_] = {.knob = knob, .level = knob.start, .wished = knob.start};
    return count_++;
}

void Governor::replace(std::size_t path, const KnobSpec& knob) noexcept {
    if (path >= count_ || !possible(knob)) return;
    GovernedPath& p = paths_[path];
    const bool by_hand = settings_.law == Law::fixed && p.wished != p.knob.start;
    p = {.knob = knob,
         .level = knob.start,
         .wished = by_hand ? std::max(p.wished, knob.floor) : knob.start,
         .present = p.present};
}

bool Governor::step(double rate_hz, Duration dt) noexcept {
    const double dt_s = std::max(to_s(dt), 0.0);
    if (settings_.law == Law::fixed) {
        bool changed = false;
        for (std::size_t i = 0; i < count_; ++i) {
            GovernedPath& p = paths_[i];
            if (p.level == p.wished) continue;
            const float step = p.knob.slew_per_s * static_cast<float>(dt_s);
            p.level = p.wished > p.level ? std::min(p.level + step, p.wished) : p.wished;
            p.reason = LevelReason::by_command;
            changed = true;
        }
        return changed;
    }
    if (!std::isfinite(rate_hz) || rate_hz < 0.0) return false;
    const RateIs rate = judge_rate(rate_hz, settings_.goal_hz, settings_.tolerance);
    if (rate == RateIs::right) {
        bool changed = false;
        for (std::size_t i = 0; i < count_; ++i) {
            changed = changed || paths_[i].reason != LevelReason::hold;
            paths_[i].reason = LevelReason::hold;
        }
        return changed;
    }
    const double factor = sensitus_factor(rate_hz, settings_.goal_hz, settings_.gain, settings_.tolerance);
    const bool first_haptic = rate == RateIs::high;
    const bool first = scale(first_haptic, factor, dt_s, rate);
    return first ? true : scale(!first_haptic, factor, dt_s, rate);
}

// One kind of path by one factor. True: at least one of them moved.
bool Governor::scale(bool haptic, double factor, double dt_s, RateIs rate) noexcept {
    bool moved = false;
    for (std::size_t i = 0; i < count_; ++i) {
        GovernedPath& p = paths_[i];
        if (!p.present || p.knob.haptic != haptic) continue;
        // A knob with floor 0 has to find its way back up from it.
        const double before = static_cast<double>(p.level);
        const double base = rate == RateIs::high ? std::max(before, 1e-3) : before;
        double wanted = std::clamp(base * factor, static_cast<double>(p.knob.floor), 1.0);
        if (rate == RateIs::high)
            wanted = std::min(wanted, before + static_cast<double>(p.knob.slew_per_s) * dt_s);
        const auto level = static_cast<float>(wanted);
        LevelReason reason = rate == RateIs::low ? LevelReason::rate_low : LevelReason::rate_high;
        if (level == p.level) reason = rate == RateIs::low ? LevelReason::at_floor : LevelReason::at_top;
        moved = moved || level != p.level;
        p.reason = reason;
        p.level = level;
    }
    return moved;
}

bool Governor::set_goal_hz(double goal_hz) noexcept {
    if (!(goal_hz >= 1.0 && goal_hz <= 1e7)) return false;
    settings_.goal_hz = goal_hz;
    return true;
}

bool Governor::set_level(std::size_t path, double level) noexcept {
    if (path >= count_) return false;
    GovernedPath& p = paths_[path];
    if (!(level >= static_cast<double>(p.knob.floor) && level <= 1.0)) return false;
    if (settings_.law != Law::fixed) set_law(Law::fixed);
    p.wished = static_cast<float>(level);
    return true;
}

// The law "fixed" starts with the levels as they are, so that nothing jumps.
void Governor::set_law(Law law) noexcept {
    if (law == Law::fixed && settings_.law != Law::fixed) {
        for (std::size_t i = 0; i < count_; ++i) paths_[i].wished = paths_[i].level;
    }
    settings_.law = law;
}

void Governor::set_present(std::size_t path, bool present) noexcept {
    if (path < count_) paths_[path].present = present;
}

}  // namespace tact
