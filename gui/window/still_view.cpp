#include "gui/window/still_view.hpp"

namespace tact {

StillView::Step StillView::next(const std::optional<std::uint64_t>& key, Instant now, bool busy) {
    if (!key || key != key_) {
        key_ = key;
        since_ = now;
        kept_ = false;
        return Step::at_levels;
    }
    if (kept_) return Step::copy;
    if (busy) since_ = now;
    return now - since_ >= kAfter ? Step::refine : Step::at_levels;
}

void StillView::keep(int x_px, int y_px, int width_px, int height_px) {
    saved_.save(x_px, y_px, width_px, height_px);
    kept_ = true;
}

}  // namespace tact
