#include "hal/io/line_logic.hpp"

namespace tact {

LinesCause LineLogic::judge(const LineReading& in, bool enable, Instant now) noexcept {
    if (!in.good) {
        unfollowed_ = false;  // the start of the deviation is unknown
        return LinesCause::lost;
    }
    // A line that is not fitted reads as its permissive state.
    const auto closed = static_cast<std::uint8_t>((in.closed & ~in.touched) | ~settings_.fitted);
    const bool a = (closed & kLineStopA) != 0, b = (closed & kLineStopB) != 0;
    const bool both = (settings_.fitted & kLineStopA) != 0 && (settings_.fitted & kLineStopB) != 0;
    const bool differ = both && a != b;
    if (differ && !differ_) differ_since_ = now;
    differ_ = differ;
    if (differ && now - differ_since_ > settings_.discrepancy) disagreed_ = true;
    if (!a && !b) disagreed_ = false;

    // Uses the level without touched(): a read-back may bounce while it follows.
    const bool amplifier = (in.closed & kLineAmplifier) != 0;
    const bool unfollowed = (settings_.fitted & kLineAmplifier) != 0 && amplifier != enable;
    if (unfollowed && !unfollowed_) unfollowed_since_ = now;
    unfollowed_ = unfollowed;

    if (disagreed_) return LinesCause::channels_disagree;
    if (!a || !b) return LinesCause::emergency_stop;
    if (unfollowed && now - unfollowed_since_ > settings_.follow) return LinesCause::amplifier;
    if ((closed & kLineDeadMan) == 0) return LinesCause::dead_man;
    return LinesCause::none;
}

void LineLogic::look(const LineReading& in, std::uint64_t rearms, std::uint64_t drops, bool enable,
                     Instant now) noexcept {
    LinesCause bad = judge(in, enable, now);
    if (bad == LinesCause::none && drops != drops_) bad = LinesCause::dropped;
    drops_ = drops;
    const bool asked = rearms != rearms_;
    rearms_ = rearms;
    if (bad != LinesCause::none) {
        if (state_ != LinesState::stopped) ++trips_;
        cause_ = bad;
        state_ = LinesState::stopped;
        well_ = false;
        return;
    }
    if (!well_) well_since_ = now;
    well_ = true;
    if (state_ == LinesState::stopped && now - well_since_ >= settings_.release) {
        state_ = LinesState::waiting;
    } else if (state_ == LinesState::waiting && asked) {
        state_ = LinesState::permitted;
        cause_ = LinesCause::none;
    }
}

}  // namespace tact
