// The potential of two opposite charges, made in code: for the demo, for tests, and for whoever has no file at hand.
//
// Each charge is spread as a Gaussian of width s, so that its potential, q erf(r / (sqrt(2) s)) / r, is smooth at its centre.
// Source   textbook electrostatics; in units in which 1 / (4 pi epsilon_0) is 1
#pragma once

#include <cstdint>

#include "ipc/base/pose.hpp"
#include "ipc/scene/density/density_map.hpp"

namespace tact {

struct TwoCharges {
    Vec3 positive_m{-0.25, 0.0, 0.0}, negative_m{0.25, 0.0, 0.0};
    double charge = 1.0, width_m = 0.08;
};

[[nodiscard]] double potential(const TwoCharges& charges, const Vec3& at_m);
// A cube of edge 1 m about the origin, `points` along each axis.
[[nodiscard]] DensityGrid two_charges_grid(const TwoCharges& charges, std::uint32_t points);

}  // namespace tact
