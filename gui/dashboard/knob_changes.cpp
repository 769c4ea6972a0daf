#include "gui/dashboard/knob_changes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gui/dashboard/widgets.hpp"
#include "ipc/topics/text.hpp"

namespace tact {

KnobChanges::KnobChanges() : ring_(kKept) {}

void KnobChanges::clear() {
    next_ = kept_ = 0;
    forgotten_ = 0;
    known_.fill(false);
}

const KnobChange& KnobChanges::at(std::size_t back) const {
    return ring_[(next_ + kKept - 1 - back) % kKept];
}

void KnobChanges::add(double t_s, std::size_t path, double to, LevelReason reason) {
    if (path >= kPathsMax || !(to >= 0.0 && to <= 1.0) || !std::isfinite(t_s)) return;
    if (known_[path] && t_s < at_s_[path]) return;
    const auto level = static_cast<float>(to);
    const float from = known_[path] ? level_[path] : std::numeric_limits<float>::quiet_NaN();
    const bool known = known_[path];
    level_[path] = level;
    at_s_[path] = t_s;
    known_[path] = true;
    // Searches the newest few entries: paths that change together are adjacent.
    for (std::size_t back = 0; known && back < std::min(kept_, kPathsMax); ++back) {
        KnobChange& c = ring_[(next_ + kKept - 1 - back) % kKept];
        if (c.path != path) continue;
        const bool same_way = std::isnan(c.from) || (level > c.to) == (c.to > c.from);
        if (c.reason != reason || !same_way || t_s - c.end_s > kOne_s) break;
        c.end_s = t_s;
        c.to = level;
        ++c.steps;
        return;
    }
    if (kept_ == kKept) ++forgotten_;
    ring_[next_] = {t_s, t_s, from, level, 1, static_cast<std::uint8_t>(path), reason};
    next_ = (next_ + 1) % kKept;
    kept_ = std::min(kept_ + 1, kKept);
}

const KnobChange* KnobChanges::newest(std::size_t path) const {
    return in_force(path, std::numeric_limits<double>::infinity());
}

const KnobChange* KnobChanges::in_force(std::size_t path, double t_s) const {
    for (std::size_t back = 0; back < kept_; ++back)
        if (const KnobChange& c = at(back); c.path == path && c.begin_s <= t_s) return &c;
    return nullptr;
}

std::string knob_change_text(const KnobChange& c) {
    std::string text = std::isnan(c.from)
                           ? format("to %.2f", static_cast<double>(c.to))
                           : format("%.2f to %.2f", static_cast<double>(c.from), static_cast<double>(c.to));
    if (c.steps > 1) text += format(" in %u steps", c.steps);
    return text + ": " + level_reason_text(c.reason);
}

}  // namespace tact
