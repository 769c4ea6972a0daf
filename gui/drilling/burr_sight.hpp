// How much of a burr's head an eye sees: what flows, lies and stands between them.
//
// Rays     from the side of the head that faces the eye, five of them, to the edge of the site. A ray ends in bone, and
//          is dimmed by the particles beside it, by Beer's law with the weights of the drawing.
// Thread   any; no allocation
#pragma once

#include "gui/drilling/particles.hpp"

namespace tact {

// 0 (nothing) to 1 (all of it); 0 for what is not finite.
[[nodiscard]] double share_seen(const Particles& particles, const Vec3& head_m, double radius_m,
                                const Vec3& eye_m) noexcept;

}  // namespace tact
