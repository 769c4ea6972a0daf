// The synthetic potential of two opposite charges, for the demo and for tests.
//
// Each charge has a Gaussian density of width s; its potential, q erf(r / (sqrt(2) s)) / r, is smooth at the centre.
// Source   textbook electrostatics; units with 1 / (4 pi epsilon_0) = 1
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
// A cube of edge 1 m about the origin with `points` points along each axis.
[[nodiscard]] DensityGrid two_charges_grid(const TwoCharges& charges, std::uint32_t points);

}  // namespace tact
