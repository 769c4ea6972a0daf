// Which body a person points at.
//
// Atoms     the body whose atoms the line of sight meets first; an atom counts as a ball of kPickRadiusM, or of kPickPx pixels if that is more,
//           so that thin tubes are as easy to hit as spheres. A bent body counts as the straight one.
// Cost      one pass over all atoms of the bodies shown, 0.2 ms for 27 000.  Thread  any
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "gui/docking/body_list.hpp"
#include "gui/system/scene_system.hpp"
#include "ipc/scene/density/structure.hpp"

namespace tact {

inline constexpr double kPickRadiusM = 2e-10, kPickPx = 5.0;

// Index in `bodies`; none: no body is there.
[[nodiscard]] std::optional<std::size_t> body_along(const Sight& sight, std::span<const ShownBody> bodies,
                                                    const std::vector<Structure>& structures);

}  // namespace tact
