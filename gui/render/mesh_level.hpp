// The knob of the surface: from the governor's level to a number of vertices, and how fast to go there.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "ipc/topics/levels.hpp"

namespace tact {

// With fewer than these in all, a thousand or a twelfth, the surfaces of a map are not recognized any more, and a
// picture is hardly sooner ready: so many cost less than a millisecond, in software too. vertices_min: of the
// base meshes.
[[nodiscard]] inline std::uint32_t fewest_shown(std::uint32_t vertices_min,
                                                std::uint32_t vertices_max) noexcept {
    return std::max(vertices_min, std::min(std::uint32_t{1000}, vertices_max / 12));
}

// The governor says what it means by items of items_max. Where it does not know the mesh (yet), or means
// another one, the level itself is the share of the vertices. Between vertices_min and all of them.
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

// What adapting and uploading a surface that is too large to follow at once (Contours) may take of a frame: a quarter of a frame as long as the last one,
// since a picture that is late anyway had better reach its new level soon; never less than 2 ms. A rebuild of
// a surface of 100,000 vertices fits that. In a slow or interrupted frame the budget stays below 50 ms.
[[nodiscard]] inline double adapt_budget_s(double frame_s) noexcept {
    return frame_s > 0.008 ? std::min(0.25 * frame_s, 0.05) : 0.002;
}

}  // namespace tact
