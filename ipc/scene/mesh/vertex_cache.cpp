// "Tipsify": P. Sander, D. Nehab, J. Barczak, "Fast triangle reordering for vertex locality and reduced
// overdraw", 2007. Draws the fan of one vertex after the other; the next one is the vertex of the last fan
// that has been in the cache longest and will still be there when its fan is complete. Linear in the
// triangles.
#include "ipc/scene/mesh/vertex_cache.hpp"

#include <algorithm>

namespace tact {
namespace {

constexpr std::uint32_t kCache = 20;  // vertices; smaller than most caches, so that it suits all
constexpr std::uint32_t kNone = UINT32_MAX;

}  // namespace

std::span<const std::uint16_t> CacheOrder::run(std::span<const std::uint16_t> corner, std::size_t vertices) {
    const std::size_t triangles = corner.size() / 3;
    first_.assign(vertices + 1, 0);
    for (const std::uint16_t v : corner) ++first_[v + 1U];
    live_.resize(vertices);
    for (std::size_t v = 0; v < vertices; ++v) {
        live_[v] = static_cast<std::uint16_t>(first_[v + 1]);
        first_[v + 1] += first_[v];
    }
    triangle_.resize(corner.size());
    stamp_.assign(first_.begin(), first_.end() - 1);  // first used as fill positions
    for (std::size_t c = 0; c < corner.size(); ++c)
        triangle_[stamp_[corner[c]]++] = static_cast<std::uint16_t>(c / 3);
    stamp_.assign(vertices, 0);
    taken_.assign(triangles, 0);
    dead_end_.clear();
    order_.clear();
    time_ = kCache + 1;
    cursor_ = 0;
    ring_.clear();
    for (std::uint32_t fan = next_fan(vertices); fan != kNone; fan = next_fan(vertices)) {
        ring_.clear();
        for (std::uint32_t i = first_[fan]; i < first_[fan + 1]; ++i) {
            const std::uint16_t t = triangle_[i];
            if (taken_[t] != 0) continue;
            taken_[t] = 1;
            order_.push_back(t);
            for (std::size_t c = 3 * std::size_t{t}; c < 3 * std::size_t{t} + 3; ++c) {
                const std::uint16_t v = corner[c];
                ring_.push_back(v);
                dead_end_.push_back(v);
                --live_[v];
                if (time_ - stamp_[v] > kCache) stamp_[v] = time_++;
            }
        }
    }
    return order_;
}

std::uint32_t CacheOrder::next_fan(std::size_t vertices) {
    std::uint32_t best = kNone, oldest = 0;
    for (const std::uint16_t v : ring_) {
        if (live_[v] == 0) continue;
        const std::uint32_t age = time_ - stamp_[v];
        const std::uint32_t rank = age + 2U * live_[v] <= kCache ? age : 0U;
        if (best == kNone || rank > oldest) best = v, oldest = rank;
    }
    if (best != kNone) return best;
    while (!dead_end_.empty()) {
        const std::uint16_t v = dead_end_.back();
        dead_end_.pop_back();
        if (live_[v] > 0) return v;
    }
    for (; cursor_ < vertices; ++cursor_)
        if (live_[cursor_] > 0) return cursor_;
    return kNone;
}

}  // namespace tact
