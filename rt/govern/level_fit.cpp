#include "rt/govern/level_fit.hpp"

#include <algorithm>
#include <cmath>

namespace tact {

namespace {

constexpr double kRestQuantile = 0.99, kRestStep = 0.02, kRestLeast_s = 1e-7;
constexpr std::uint32_t kEvery = 16;  // cycles between choices
constexpr double kSameError = 1e-12, kSameCost = 0.01;
constexpr double kPartLeast = 0.02;  // limits the scaling of a partial cost to the whole
// About one miss in a thousand cycles is what the quantile permits; the third within as many lowers the level. An
// interrupted step counts less, since no level would have met the deadline.
constexpr double kMissKept = 0.999, kInterruptedMiss = 0.4, kMissesMost = 2.2;

// A freely running loop shares its core: other programs hold several steps in a row, at any level.
constexpr std::uint32_t kMissesInARow = 2, kInterruptedInARow = 3, kMissesInARowFree = 4;

// Of the whole step.
double part_of(const LevelFit::Sample& s) noexcept {
    return std::clamp(std::min(s.work_done, s.recomputed), kPartLeast, 1.0);
}

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
        window_[count_] = {};
        rows_[count_++] = row;
    }
    window_age_s_ = slow_ = slow_before_ = 0.0;
    tries_ = 0;
    tried_s_.fill(0.0);
    row_ = 0;
    since_fall_s_ = 1e9;
    leapt_ = false;
    spread_.restart();
    near_ = 1.0;
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
    tried_s_[row] = tries_ % kTries == 0 ? model_s : std::min(tried_s_[row], model_s);
    rest_s_ = std::max(rest_s, kRestLeast_s);
    if (++tries_ % kTries != 0) return;
    rows_[row].cost_s = std::max(rows_[row].cost_s, tried_s_[row]);
}

// The windows of all rows end together: rows compared with each other remember the same time.
void LevelFit::pass(double dt_s) noexcept {
    window_age_s_ += dt_s;
    if (window_age_s_ < kKept_s) return;
    window_age_s_ = 0.0;
    spread_.turn();
    slow_before_ = slow_;
    slow_ = 0.0;
    for (std::size_t i = 0; i < count_; ++i) {
        Window& w = window_[i];
        if (!w.renewed) continue;
        w = {.cost_before_s = w.cost_s, .error_before = w.error, .foreseen_s = w.foreseen_s};
        rows_[i].cost_s = cost_s(i);
        rows_[i].error = w.error_before;
    }
}

double LevelFit::cost_s(std::size_t i) const noexcept {
    const Window& w = window_[i];
    return std::max({w.cost_s, w.cost_before_s, w.foreseen_s, tried_s_[i]});
}

bool LevelFit::renew(std::size_t i, double now_s, double error, double foreseen_s) noexcept {
    if (i >= count_ || !std::isfinite(now_s + foreseen_s) || !std::isfinite(error)) return false;
    Row& row = rows_[i];
    Window& w = window_[i];
    w.cost_s = std::max(w.cost_s, now_s);
    w.foreseen_s = foreseen_s;
    w.error = std::max(w.error, error);
    w.renewed = true;
    const Row before = row;
    row.cost_s = cost_s(i);
    row.error = std::max(w.error, w.error_before);
    const bool dearer = row.cost_s > kLeapt * before.cost_s;
    leapt_ = leapt_ || (dearer && i == row_);
    return dearer || row.error > kLeapt * before.error + kSameError;
}

template <class ValueOf>
double LevelFit::at(float level, ValueOf value_of) const noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
        if (level > rows_[i].level + 1e-5F) continue;
        if (i == 0 || level >= rows_[i].level - 1e-5F) return value_of(i);
        const double s = static_cast<double>(level - rows_[i - 1].level) /
                         static_cast<double>(rows_[i].level - rows_[i - 1].level);
        return (1.0 - s) * value_of(i - 1) + s * value_of(i);
    }
    return count_ > 0 ? value_of(count_ - 1) : 0.0;
}

LevelFit::Tail LevelFit::read_tail(const Limits& limits) const noexcept {
    const double share = CostSpread::kTail / near_;
    const double limit_s = limits.free_running ? limits.deadline_s : kUse * limits.period_s * limits.budget;
    const double ratio = limits.free_running ? spread_.spread(share) : spread_.slowest(share),
                 usual = limits.free_running ? 1.0 : spread_.speed();
    const double floor_s = count_ > 0 ? spread_.speed() * rows_[0].cost_s : 0.0;
    return {.ratio = ratio,
            .interrupt_s = std::min(spread_.interrupt_s(limit_s - floor_s), kInterruptShare * limit_s),
            .alike = ratio <= kAlike * usual && spread_.samples() >= kTailKnown};
}

bool LevelFit::fits(std::size_t row, const Limits& limits, const Tail& tail, double part) const noexcept {
    const double budget_s = kUse * limits.period_s * limits.budget, now = spread_.speed();
    // The present row shows what it costs; another one, if dry steps measured it and all were alike.
    const bool certain = part >= 1.0 || (tail.alike && tried_s_[row] >= kTelling * rows_[row].cost_s);
    if (!certain) part = std::min(part, kRise);
    const double spread_least = certain ? 1.0 : kSpreadLeast;
    double speed = now;
    if (row != row_) {
        const double slow = std::max(slow_, slow_before_);
        speed = std::max(now, limits.free_running ? std::min(slow, 1.0) : slow);
    }
    const double cost_s = rows_[row].cost_s, usual_s = speed * cost_s;
    const double interrupted_s = usual_s + tail.interrupt_s;
    if (!limits.free_running) {
        const double tail_s = std::max(tail.ratio * cost_s, usual_s * spread_least);
        return std::max(tail_s, interrupted_s) + rest_s_ <= part * budget_s;
    }
    // Its core is shared: other programs make it slow all the time.
    return std::max(usual_s * std::max(tail.ratio, spread_least), interrupted_s) <=
               part * limits.deadline_s &&
           kFreeSpread * usual_s + rest_s_ <= part * budget_s;
}

std::size_t LevelFit::best(const Limits& limits, double part, double cost_s_most) const noexcept {
    std::array<bool, kRowsMax> fitting{};
    const Tail tail = read_tail(limits);
    double least_error = 1e300, least_cost_s = 1e300;
    bool none = true;
    for (std::size_t i = 0; i < count_; ++i) {
        fitting[i] = rows_[i].level <= limits.level_max && rows_[i].cost_s <= cost_s_most &&
                     fits(i, limits, tail, part);
        none = none && !fitting[i];
    }
    for (std::size_t i = 0; i < count_; ++i) {
        if (none)
            fitting[i] = i == 0 || (rows_[i].level <= limits.level_max &&
                                    rows_[i].cost_s <= (1.0 + kSavesNothing) * rows_[0].cost_s);
        if (fitting[i]) least_error = std::min(least_error, rows_[i].error);
    }
    const auto good = [&](std::size_t i) {
        return fitting[i] && rows_[i].error <= (1.0 + kSmallLoss) * least_error + kSameError;
    };
    for (std::size_t i = 0; i < count_; ++i)
        if (good(i)) least_cost_s = std::min(least_cost_s, rows_[i].cost_s);
    std::size_t chosen = 0;
    // Nothing is felt yet: the highest level that fits, so that a contact begins with it.
    const bool nothing = least_error <= kSameError;
    for (std::size_t i = 0; i < count_; ++i)
        if (nothing && fitting[i]) chosen = i;
    for (std::size_t i = 0; i < count_ && !nothing; ++i)
        if (good(i) && rows_[i].cost_s <= (1.0 + kSameCost) * least_cost_s) chosen = i;
    return chosen;
}

float LevelFit::choose(const Limits& limits) noexcept {
    row_ = first_row_ = best(limits, kFirst, 1e9);
    since_choice_s_ = 0.0;
    return rows_[row_].level;
}

CostSpread::Kind LevelFit::learn(const Sample& s) noexcept {
    const double part = part_of(s);
    const double of_row_s = at(s.level, [this](std::size_t row) { return rows_[row].cost_s; });
    CostSpread::Kind kind = CostSpread::Kind::usual;
    if (!(s.predicted_s > 0.0))
        kind = spread_.add(s.model_s / part, of_row_s, kSpeedLeast);
    else if (s.predicted_s >= kTelling * of_row_s) {
        const double predicted_s =
            std::max(s.predicted_s, at(s.level, [this](std::size_t row) { return tried_s_[row]; }));
        near_ += kNearStep * ((predicted_s >= kNear * of_row_s ? 1.0 : 0.0) - near_);
        near_ = std::max(near_, kNearLeast);
        kind = spread_.add(s.model_s / part, predicted_s, kSpeedLeast);
    }
    follow_rest(s.rest_s);
    since_fall_s_ += s.dt_s;
    since_choice_s_ += s.dt_s;
    misses_ *= kMissKept;
    misses_in_a_row_ = s.deadline_missed ? misses_in_a_row_ + 1 : 0;
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
    const bool interrupted = kind == CostSpread::Kind::interrupted;
    if (s.deadline_missed && interrupted && limits.free_running) misses_ -= kInterruptedMiss;
    const std::size_t before = row_;
    const bool changed_cost = kind == CostSpread::Kind::changed,
               due = cycle_ % kEvery == 0 || changed_cost || leapt_;
    LevelReason reason = LevelReason::hold;
    if (due) slow_ = std::max(slow_, spread_.speed());
    if (due) over_s_ = fits(row_, limits, read_tail(limits), 1.0) ? 0.0 : over_s_ + kEvery * s.dt_s;
    const bool in_a_row = misses_in_a_row_ >= (limits.free_running ? kMissesInARowFree
                                               : interrupted       ? kInterruptedInARow
                                                                   : kMissesInARow);
    if (s.deadline_missed && row_ > 0 && (misses_ > kMissesMost || in_a_row)) {
        const double share = in_a_row ? kUse * limits.period_s * part_of(s) / s.model_s : 1.0;
        row_ = best(limits, 1.0, std::min(share, kMissRetreat) * rows_[row_].cost_s);
        reason = LevelReason::deadline_missed;
        misses_ = 0.0;
        misses_in_a_row_ = 0;
    } else if (due) {
        const bool slower = changed_cost && s.model_s / part_of(s) > kUrgent * kUse * limits.period_s;
        const bool over = over_s_ > kOver_s || ((slower || leapt_) && over_s_ > 0.0);
        leapt_ = false;
        if (over || rows_[row_].level > limits.level_max) {
            row_ = best(limits, kRise, 1e9);
            reason = LevelReason::cost_high;
        } else if (since_fall_s_ > hold_s_) {
            const std::size_t better = best(limits, kRise, 1e9);
            // With equal errors the higher level wins: its cost fits.
            const double gain = rows_[row_].error - rows_[better].error;
            const bool early = better > first_row_ && since_choice_s_ < kEarly_s;
            if (gain > (early ? kWorthGainEarly : kWorthGain) * rows_[row_].error + kSameError ||
                (std::abs(gain) <= kSameError && better > row_ && !early)) {
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
