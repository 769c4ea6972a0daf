// Selects the parts of the sharp bone image to redraw: tiles of 64 pixels.
//
// Wrong     of another view: must not be shown.   Stale   its bone has changed: shown until redrawn.
// Order     stale and wrong ones first in turn, stale ones by their age, wrong ones from the centre of the view outwards, as
//           many as the rays suffice for; at least one, so that the image is complete at last, also while a burr makes
//           the same few tiles stale in every frame.
// Thread    any; plain data
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace tact {

struct PixelBox {  // [x0, x1) x [y0, y1)
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    [[nodiscard]] bool empty() const { return x0 >= x1 || y0 >= y1; }
    [[nodiscard]] PixelBox cut(const PixelBox& o) const {
        return {std::max(x0, o.x0), std::max(y0, o.y0), std::min(x1, o.x1), std::min(y1, o.y1)};
    }
    [[nodiscard]] std::uint32_t pixels() const {
        return empty() ? 0U : static_cast<std::uint32_t>(x1 - x0) * static_cast<std::uint32_t>(y1 - y0);
    }
};

class BoneTiles {
public:
    static constexpr int kEdge = 64;

    void resize(int width_px, int height_px) {
        view_ = {0, 0, width_px, height_px};
        columns_ = (width_px + kEdge - 1) / kEdge;
        const int rows = (height_px + kEdge - 1) / kEdge;
        tile_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows), State::wrong);
        stale_at_.assign(tile_.size(), 0);
        order_.resize(tile_.size());
        for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<std::uint32_t>(i);
        const auto off = [this](std::uint32_t i) {
            const PixelBox b = box(i);
            const int dx = b.x0 + b.x1 - view_.x1, dy = b.y0 + b.y1 - view_.y1;
            return dx * dx + dy * dy;
        };
        std::sort(order_.begin(), order_.end(),
                  [&](std::uint32_t a, std::uint32_t b) { return off(a) < off(b); });
    }
    // Another view; bone lies only within `bounds`.
    void all_wrong(const PixelBox& bounds) {
        bounds_ = bounds.cut(view_);
        std::fill(tile_.begin(), tile_.end(), State::wrong);
    }
    void stale(const PixelBox& where) {
        for (std::uint32_t i = 0; i < tile_.size(); ++i)
            if (tile_[i] == State::good && !box(i).cut(where).empty()) {
                tile_[i] = State::stale;
                stale_at_[i] = ++clock_;
            }
    }
    [[nodiscard]] PixelBox box(std::uint32_t i) const {
        const int x = static_cast<int>(i) % columns_ * kEdge, y = static_cast<int>(i) / columns_ * kEdge;
        return PixelBox{x, y, x + kEdge, y + kEdge}.cut(view_);
    }
    [[nodiscard]] std::uint32_t rays(std::uint32_t i) const { return box(i).cut(bounds_).pixels(); }
    [[nodiscard]] std::uint32_t rays_wrong() const {
        std::uint32_t sum = 0;
        for (std::uint32_t i = 0; i < tile_.size(); ++i) sum += tile_[i] == State::wrong ? rays(i) : 0;
        return sum;
    }
    [[nodiscard]] bool wrong(std::uint32_t i) const { return tile_[i] == State::wrong; }
    [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(tile_.size()); }
    [[nodiscard]] bool all_good() const {
        return std::all_of(tile_.begin(), tile_.end(), [](State s) { return s == State::good; });
    }
    // Takes the tiles to draw now, limited by this many rays, and marks them good. Valid until the next call.
    std::span<const std::uint32_t> take(std::uint32_t rays_most) {
        taken_.clear();
        std::uint32_t left = rays_most;
        bool room = true;
        stale_first_ = !stale_first_;
        stale_.clear();
        for (const std::uint32_t i : order_)
            if (tile_[i] == State::stale) stale_.push_back(i);
        std::sort(stale_.begin(), stale_.end(),
                  [this](std::uint32_t a, std::uint32_t b) { return stale_at_[a] < stale_at_[b]; });
        for (const bool stale : {stale_first_, !stale_first_})
            for (const std::uint32_t i : stale ? stale_ : order_) {
                if (!room || tile_[i] != (stale ? State::stale : State::wrong)) continue;
                const std::uint32_t need = rays(i);
                if (need == 0) {
                    tile_[i] = State::good;
                    continue;
                }
                if (need > left && !taken_.empty()) {
                    room = false;
                    continue;
                }
                left -= std::min(need, left);
                tile_[i] = State::good;
                taken_.push_back(i);
            }
        return taken_;
    }

private:
    enum class State : std::uint8_t { wrong, stale, good };
    PixelBox view_, bounds_;
    int columns_ = 1;
    std::vector<State> tile_;
    std::vector<std::uint32_t> order_, taken_, stale_;
    std::vector<std::uint64_t> stale_at_;  // order in which they became so
    std::uint64_t clock_ = 0;
    bool stale_first_ = false;
};

}  // namespace tact
