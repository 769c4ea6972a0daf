// The knob of the surface: from the governor's level to a number of vertices.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "ipc/topics/levels.hpp"

namespace tact {

// The governor says what it means by items of items_max. Where it does not know the mesh (yet), or means
// another one, the level itself is the share of the vertices. Between the base mesh and all of it.
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

}  // namespace tact
