// Visible fraction of a burr's head: fluids, dust and bone between eye and head hide it.
//
// Rays     five, from the side of the head that faces the eye to the edge of the site. A ray ends in bone; the
//          particles beside it attenuate it by Beer's law, with the weights of the rendering.
// Thread   any; no allocation
#pragma once

#include "gui/drilling/particles.hpp"

namespace tact {

// 0 (hidden) to 1 (fully visible); 0 for non-finite arguments.
[[nodiscard]] double share_seen(const Particles& particles, const Vec3& head_m, double radius_m,
                                const Vec3& eye_m) noexcept;

}  // namespace tact
