#include "rt/force/drilling/stroke_history.hpp"

#include <algorithm>

namespace tact {

StrokeHistory::StrokeHistory(std::size_t bricks, std::size_t room)
    : mark_(bricks), brick_(std::max<std::size_t>(room, 1)), kept_(brick_.size() * BoneBricks::kVoxels) {}

void StrokeHistory::look(std::uint32_t brick, const std::uint8_t* voxels) noexcept {
    if (open_ && (too_large_ || mark_[brick] == number_)) return;
    std::copy_n(voxels, looked_.size(), looked_.begin());
}

void StrokeHistory::keep(std::uint32_t brick) noexcept {
    if (!open_) begin_stroke();
    if (too_large_ || mark_[brick] == number_) return;
    mark_[brick] = number_;
    Stroke& now = stroke(done_ - 1);
    while (now.end - stroke(0).begin >= brick_.size()) {
        if (done_ == 1) {
            too_large_ = true;
            return;
        }
        forget_first();
    }
    const std::size_t slot = now.end++ % brick_.size();
    brick_[slot] = brick;
    std::copy(looked_.begin(), looked_.end(),
              kept_.begin() + static_cast<std::ptrdiff_t>(slot * looked_.size()));
}

void StrokeHistory::restart(std::uint32_t strokes) noexcept {
    first_ = done_ = all_ = 0;
    strokes_ = strokes;
    open_ = too_large_ = false;
    turn_ = Turn::none;
}

void StrokeHistory::begin_stroke() noexcept {
    all_ = done_;
    if (too_large_) {  // the stroke before it; what was earlier is forgotten already
        done_ = all_ = 0;
        too_large_ = false;
    }
    if (all_ == kStrokesMost) forget_first();
    const std::uint64_t at = done_ > 0 ? stroke(done_ - 1).end : 0;
    all_ = ++done_;
    stroke(done_ - 1) = {at, at};
    ++strokes_;
    ++number_;
    open_ = true;
    pause_s_ = length_s_ = 0.0;
}

void StrokeHistory::forget_first() noexcept {
    first_ = (first_ + 1) % kStrokesMost;
    --done_;
    --all_;
}

void StrokeHistory::step(double step_s, bool took) noexcept {
    if (!open_) return;
    length_s_ += step_s;
    pause_s_ = took ? 0.0 : pause_s_ + step_s;
    if (pause_s_ >= kPauseS || length_s_ >= kLongestS) end_stroke();
}

bool StrokeHistory::undo() noexcept {
    if (turn_ != Turn::none || done_ == 0 || too_large_) return false;
    return begin_exchange(Turn::undo, done_ - 1);
}

bool StrokeHistory::redo() noexcept {
    if (turn_ != Turn::none || open_ || all_ == done_) return false;
    return begin_exchange(Turn::redo, done_);
}

bool StrokeHistory::begin_exchange(Turn turn, std::uint32_t which) noexcept {
    end_stroke();
    turn_ = turn;
    next_ = stroke(which).begin;
    end_ = stroke(which).end;
    return true;
}

void StrokeHistory::exchange_brick(std::size_t slot, std::span<std::uint8_t> density) noexcept {
    std::uint8_t* const kept = kept_.data() + slot * BoneBricks::kVoxels;
    std::swap_ranges(kept, kept + BoneBricks::kVoxels,
                     density.data() + std::size_t{brick_[slot]} * BoneBricks::kVoxels);
}

void StrokeHistory::finish_exchange() noexcept {
    if (turn_ == Turn::undo) {
        --done_;
        --strokes_;
    } else {
        ++done_;
        ++strokes_;
    }
    turn_ = Turn::none;
}

}  // namespace tact
