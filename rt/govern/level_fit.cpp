#include "rt/govern/level_fit.hpp"

#include <algorithm>
#include <cmath>

namespace tact {

namespace {

constexpr double kRestQuantile = 0.99, kRestStep = 0.02, kRestLeast_s = 1e-7;
constexpr std::uint32_t kEvery = 16;  // cycles between choices
constexpr double kSameError = 1e-12;
constexpr double kPartLeast = 0.02;  // limits the scaling of a partial cost to the whole
// About one miss in a thousand cycles is what the quantile permits; the third within as many lowers the level. An
// interrupted step counts less, since no level would have met the deadline.
constexpr double kMissKept = 0.999, kInterruptedMiss = 0.4, kMissesMost = 2.2;

}  // namespace

bool LevelFit::set_rows(std::span<const Row> rows) noexcept {
    count_ = 0;
    float before = -1.0F;
    for (const Row& row : rows) {
        if (count_ == kRowsMax) break;
        if (!(row.level > before && row.level <= 1.0F) || !std::isfinite(row.cost_s) ||
            !std::isfinite(row.error))
            continue;
        before = row.level;
        rows_[count_++] = row;
    }
    tries_ = 0;
    tried_s_.fill(1e9);
    row_ = 0;
    since_fall_s_ = 1e9;
    spread_.restart();
    return count_ > 0;
}

bool LevelFit::calibrating(float& level) const noexcept {
    if (tries_ >= kTries * count_) return false;
    level = rows_[tries_ / kTries].level;
    return true;
}

// The first dry steps run with cold caches, so the smallest measurement counts. A model out of contact costs less than
// in contact, so a larger prediction stays in force.
void LevelFit::calibrate(double model_s, double rest_s) noexcept {
    if (tries_ >= kTries * count_) return;
    const std::size_t row = tries_ / kTries;
    tried_s_[row] = std::min(tried_s_[row], model_s);
    rest_s_ = std::max(rest_s, kRestLeast_s);
    if (++tries_ % kTries != 0) return;
    rows_[row].cost_s = std::max(rows_[row].cost_s, tried_s_[row]);
}

double LevelFit::cost_at(float level) const noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
        if (level > rows_[i].level + 1e-5F) continue;
        if (i == 0 || level >= rows_[i].level - 1e-5F) return rows_[i].cost_s;
        const double s = static_cast<double>(level - rows_[i - 1].level) /
                         static_cast<double>(rows_[i].level - rows_[i - 1].level);
        return (1.0 - s) * rows_[i - 1].cost_s + s * rows_[i].cost_s;
    }
    return count_ > 0 ? rows_[count_ - 1].cost_s : 0.0;
}

double LevelFit::predicted_s(std::size_t row, double interrupts_s_most) const noexcept {
    const double usual_s = spread_.speed() * rows_[row].cost_s;
    return std::max(usual_s * spread_.spread(), usual_s + std::min(spread_.interrupt_s(), interrupts_s_most));
}

bool LevelFit::fits(std::size_t row, const Limits& limits, double part) const noexcept {
    const double budget_s = kUse * limits.period_s * limits.budget;
    return predicted_s(row, kInterruptShare * budget_s) + rest_s_ <= part * budget_s;
}

std::size_t LevelFit::best(const Limits& limits, double part, double cost_s_most) const noexcept {
    std::size_t chosen = 0;
    for (std::size_t i = 1; i < count_; ++i) {
        const Row& row = rows_[i];
        if (row.level > limits.level_max || row.cost_s > cost_s_most || !fits(i, limits, part)) continue;
        if (row.error <= rows_[chosen].error + kSameError || !fits(chosen, limits, part)) chosen = i;
    }
    return chosen;
}

float LevelFit::choose(const Limits& limits) noexcept {
    row_ = best(limits, kRise, 1e9);
    return rows_[row_].level;
}

CostSpread::Kind LevelFit::learn(const Sample& s) noexcept {
    const double part = std::clamp(std::min(s.work_done, s.recomputed), kPartLeast, 1.0);
    const CostSpread::Kind kind = spread_.add(s.model_s / part, cost_at(s.level), kSpeedLeast);
    follow_rest(s.rest_s);
    since_fall_s_ += s.dt_s;
    misses_ *= kMissKept;
    if (s.deadline_missed) misses_ += kind == CostSpread::Kind::interrupted ? kInterruptedMiss : 1.0;
    ++cycle_;
    return kind;
}

void LevelFit::follow_rest(double rest_s) noexcept {
    const bool above = rest_s > rest_s_;
    rest_s_ *= above ? 1.0 + kRestStep * kRestQuantile : 1.0 - kRestStep * (1.0 - kRestQuantile);
    rest_s_ = std::max(rest_s_, kRestLeast_s);
}

LevelFit::Choice LevelFit::add(const Sample& s, const Limits& limits) noexcept {
    if (count_ == 0) return {.level = s.level};
    const CostSpread::Kind kind = learn(s);
    const std::size_t before = row_;
    const bool changed_cost = kind == CostSpread::Kind::changed, due = cycle_ % kEvery == 0 || changed_cost;
    LevelReason reason = LevelReason::hold;
    if (due) over_s_ = fits(row_, limits, 1.0) ? 0.0 : over_s_ + kEvery * s.dt_s;
    if (s.deadline_missed && row_ > 0 && misses_ > kMissesMost) {
        row_ = best(limits, 1.0, kMissRetreat * rows_[row_].cost_s);
        reason = LevelReason::deadline_missed;
        misses_ = 0.0;
    } else if (due) {
        const bool over = over_s_ > kOver_s || (changed_cost && over_s_ > 0.0);
        if (over || rows_[row_].level > limits.level_max) {
            row_ = best(limits, kRise, 1e9);
            reason = LevelReason::cost_high;
        } else if (since_fall_s_ > hold_s_) {
            const std::size_t better = best(limits, kRise, 1e9);
            // With equal errors the higher level wins: its cost fits.
            const double gain = rows_[row_].error - rows_[better].error;
            if (gain > kSameError || (gain >= -kSameError && better > row_)) {
                row_ = better;
                reason = LevelReason::cost_low;
            }
        }
    }
    if (row_ != before) over_s_ = 0.0;
    if (row_ < before) {
        if (since_fall_s_ > kHoldForgotten_s)
            hold_s_ = kHold_s;
        else if (rose_)
            hold_s_ = std::min(2.0 * hold_s_, kHoldMost_s);
        since_fall_s_ = 0.0;
        rose_ = false;
    }
    rose_ = rose_ || row_ > before;
    return {.level = rows_[row_].level, .changed = row_ != before, .reason = reason};
}

}  // namespace tact
