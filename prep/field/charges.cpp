#include "prep/field/charges.hpp"

#include <cmath>
#include <numbers>

namespace tact {
namespace {

double of_one(double charge, double width_m, double r_m) {
    const double u = r_m / (std::numbers::sqrt2 * width_m);
    if (u < 1e-6) return charge * std::numbers::inv_sqrtpi * std::numbers::sqrt2 / width_m;
    return charge * std::erf(u) / r_m;
}

}  // namespace

double potential(const TwoCharges& c, const Vec3& at_m) {
    return of_one(c.charge, c.width_m, (at_m - c.positive_m).norm()) -
           of_one(c.charge, c.width_m, (at_m - c.negative_m).norm());
}

DensityGrid two_charges_grid(const TwoCharges& charges, std::uint32_t points) {
    DensityGrid grid;
    grid.size = {points, points, points};
    grid.spacing_m = Vec3::Constant(1.0 / (points - 1.0));
    grid.origin_m = Vec3::Constant(-0.5);
    grid.values.reserve(grid.count());
    for (std::uint32_t z = 0; z < points; ++z)
        for (std::uint32_t y = 0; y < points; ++y)
            for (std::uint32_t x = 0; x < points; ++x)
                grid.values.push_back(static_cast<float>(
                    potential(charges, grid.origin_m + grid.spacing_m.cwiseProduct(Vec3(x, y, z)))));
    return grid;
}

}  // namespace tact
