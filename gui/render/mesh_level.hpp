// Detail of the surface: from the governor's level to a number of vertices, and the time per frame to get there.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "ipc/topics/levels.hpp"

namespace tact {

// With fewer vertices (a thousand, or a twelfth of all) the surfaces of a map are not recognizable, and a frame is
// hardly faster: that many cost less than a millisecond, in software too. vertices_min: of the base meshes.
[[nodiscard]] inline std::uint32_t fewest_shown(std::uint32_t vertices_min,
                                                std::uint32_t vertices_max) noexcept {
    return std::max(vertices_min, std::min(std::uint32_t{1000}, vertices_max / 12));
}

// Vertices for the governor's level: `items` if items_max matches this mesh, else the level as a fraction of all
// vertices. Clamped to vertices_min ... vertices_max.
[[nodiscard]] inline std::uint32_t vertices_for(const PathLevel& path, std::uint32_t vertices_min,
                                                std::uint32_t vertices_max) noexcept {
    double wanted = 0.0;
    if (path.items_max == vertices_max && path.items <= path.items_max && path.items > 0)
        wanted = path.items;
    else
        wanted = std::round(static_cast<double>(path.level) * vertices_max);
    return static_cast<std::uint32_t>(
        std::clamp(wanted, static_cast<double>(vertices_min), static_cast<double>(vertices_max)));
}

// Time per frame to adapt and upload a surface too large to follow at once (Contours): a quarter of the last frame,
// because a frame that is late anyway should reach its new level soon. At least 2 ms, which is enough to rebuild a
// surface of 100,000 vertices; at most 50 ms.
[[nodiscard]] inline double adapt_budget_s(double frame_s) noexcept {
    return frame_s > 0.008 ? std::min(0.25 * frame_s, 0.05) : 0.002;
}

}  // namespace tact
