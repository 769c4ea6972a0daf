// Several visual paths: the law gives the change of a frame's time, n ln V, and scale_visual() spends it where it costs least. With loss
// w_i ln(1 / L_i) of a path and time c + sum r_i L_i, the least loss at a given time has the same r_i L_i / w_i for all paths: so the
// path with the greatest cost x elasticity / loss goes down, and the one with the least goes up.
#include <algorithm>
#include <array>
#include <cmath>

#include "rt/govern/governor.hpp"
#include "rt/govern/step_limits.hpp"

namespace tact {

namespace {

constexpr double kPathDownMost = 2.0 * kDownMost;  // of one path among several, in ln(level)
// A path gives time to another one if its ratio of gain to loss is this many times as large, by a step of this much in
// ln(level), and so long after the last change.
constexpr double kUnbalanced = 1.4, kBalanceStep = 0.15, kBalanceAfter_s = 0.4;

}  // namespace

DisplayCost::PerPath Governor::visual_levels() const noexcept {
    DisplayCost::PerPath level{};
    for (std::size_t i = 0; i < count_; ++i)
        if (!paths_[i].knob.haptic && paths_[i].present)
            level[i] = std::max(static_cast<double>(paths_[i].level), kLeastLevel);
    return level;
}

// The time that the factor on all visual levels would save or cost, spent in small steps on the path where it is best at that moment.
bool Governor::scale_visual(double factor, double dt_s, LevelReason up_or_down, LevelReason stuck) noexcept {
    scaled_ln_ = 0.0;
    if (settings_.law == Law::sensitus) return scale(false, factor, dt_s, up_or_down, stuck);
    constexpr double kStep = 0.1;  // in ln(level)
    constexpr int kStepsMost = 128;
    const DisplayCost::Estimate now = display_cost_.at(visual_levels());
    const bool down = factor < 1.0;
    const bool known = now.frame_s > 0.0;
    std::array<double, kPathsMax> level{}, least{}, most{}, gain{};
    double sum = 0.0;
    const bool several =
        std::count_if(paths_.begin(), paths_.begin() + static_cast<std::ptrdiff_t>(count_),
                      [this](const GovernedPath& p) { return takes_part(p) && !p.knob.haptic; }) > 1;
    const double most_down = several ? kPathDownMost : kDownMost;
    for (std::size_t i = 0; i < count_; ++i) {
        const GovernedPath& p = paths_[i];
        if (!takes_part(p) || p.knob.haptic) continue;
        const double before = static_cast<double>(p.level), floor = static_cast<double>(p.knob.floor);
        level[i] = down ? before : std::max(before, kLeastLevel);
        least[i] =
            std::min(std::max({floor, std::min(before, kLeastLevel), before * std::exp(-most_down)}), before);
        most[i] = std::min({1.0, std::max(before, kLeastLevel) * std::exp(kUpMost),
                            before + static_cast<double>(p.knob.slew_per_s) * dt_s});
        gain[i] = known ? now.gain_s[i] / now.frame_s : i == 0 || !several ? 1.0 : 0.0;
        sum += gain[i];
        if (down && gain[i] < kWorthGain) least[i] = before;
    }
    const double wanted_ln = std::abs(std::log(std::max(factor, 1e-9)));
    double left = wanted_ln * sum;  // of ln(time)
    const auto started = level;
    for (int step = 0; step < kStepsMost && left > 1e-9; ++step) {
        std::size_t best = kPathsMax;
        double best_ratio = 0.0;
        for (std::size_t i = 0; i < count_; ++i) {
            if (!(most[i] > 0.0) || (down ? level[i] <= least[i] : level[i] >= most[i])) continue;
            const double ratio = gain[i] * level[i] / (started[i] * static_cast<double>(paths_[i].knob.loss));
            if (best != kPathsMax && !(down ? ratio > best_ratio : ratio < best_ratio)) continue;
            best = i;
            best_ratio = ratio;
        }
        if (best == kPathsMax) break;
        const double change = gain[best] > 0.0 ? std::min(kStep, left / gain[best]) : kStep;
        const double before = level[best];
        level[best] = down ? std::max(before * std::exp(-change), least[best])
                           : std::min(before * std::exp(change), most[best]);
        left -= std::abs(std::log(level[best] / before)) * gain[best];
    }
    if (sum > 0.0) scaled_ln_ = wanted_ln - std::max(left, 0.0) / sum;
    bool moved = false;
    for (std::size_t i = 0; i < count_; ++i) {
        GovernedPath& p = paths_[i];
        if (!takes_part(p) || p.knob.haptic) continue;
        const auto wanted = static_cast<float>(level[i]);
        if (wanted != p.level)
            p.reason = up_or_down;
        else if (down ? p.level <= std::max(p.knob.floor, static_cast<float>(kLeastLevel)) : p.level >= 1.0F)
            p.reason = stuck;
        moved = moved || wanted != p.level;
        p.level = wanted;
    }
    if (moved) frame_s_ = since_visual_s_ = 0.0;
    return moved;
}

// A path with a large gain for its loss gives time to one with a small gain; the time of a frame stays. So the levels in the end do not
// depend on the way there.
bool Governor::rebalance_visual() noexcept {
    if (settings_.law != Law::elastic || resting_ || since_visual_s_ < kBalanceAfter_s) return false;
    const DisplayCost::Estimate now = display_cost_.at(visual_levels());
    if (!(now.frame_s > 0.0)) return false;
    std::size_t giver = kPathsMax, taker = kPathsMax;
    double most = 0.0, least = 0.0;
    for (std::size_t i = 0; i < count_; ++i) {
        const GovernedPath& p = paths_[i];
        if (!takes_part(p) || p.knob.haptic) continue;
        const double ratio = now.gain_s[i] / static_cast<double>(p.knob.loss);
        if (p.level > p.knob.floor && now.gain_s[i] >= kWorthGain * now.frame_s && ratio > most) {
            giver = i;
            most = ratio;
        }
        if (p.level < 1.0F && (taker == kPathsMax || ratio < least)) {
            taker = i;
            least = ratio;
        }
    }
    if (giver == kPathsMax || taker == kPathsMax || giver == taker || most < kUnbalanced * least)
        return false;
    GovernedPath &from = paths_[giver], &to = paths_[taker];
    const double given_s = kBalanceStep * now.gain_s[giver];
    const double up = now.gain_s[taker] > 0.0 ? std::min(given_s / now.gain_s[taker], kUpMost) : kUpMost;
    const double down = std::min(up * now.gain_s[taker] / now.gain_s[giver], kBalanceStep);
    from.level = std::max(from.level * static_cast<float>(std::exp(-down)), from.knob.floor);
    to.level = std::min(
        std::max(to.level, static_cast<float>(kLeastLevel)) * static_cast<float>(std::exp(up)), 1.0F);
    from.reason = to.reason;
    frame_s_ = since_visual_s_ = 0.0;
    rate_.restart();
    return true;
}

bool Governor::visual_can_give() const noexcept {
    const DisplayCost::Estimate now = display_cost_.at(visual_levels());
    for (std::size_t i = 0; i < count_; ++i) {
        const GovernedPath& p = paths_[i];
        const bool buys = !(now.frame_s > 0.0) || settings_.law == Law::sensitus ||
                          now.gain_s[i] >= kWorthGain * now.frame_s;
        if (takes_part(p) && !p.knob.haptic && p.level > p.knob.floor && buys) return true;
    }
    return false;
}

}  // namespace tact
