#include "prep/search/rotation_set.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tact {
namespace {

// count x cover^3: measured over sets of 100 to 10 000 rotations.
constexpr double kCoverVolume = 64.0;
// The positive root of x^4 = x + 4, the second frequency of the spiral.
constexpr double kPsi = 1.533751168755204288118041;

}  // namespace

std::vector<Quat> rotation_set(std::size_t count) {
    std::vector<Quat> set;
    set.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double s = static_cast<double>(i) + 0.5, t = s / static_cast<double>(count);
        const double a = 2.0 * std::numbers::pi * s / std::numbers::sqrt2,
                     b = 2.0 * std::numbers::pi * s / kPsi;
        const double r = std::sqrt(t), q = std::sqrt(1.0 - t);
        set.emplace_back(q * std::cos(b), r * std::sin(a), r * std::cos(a), q * std::sin(b));
    }
    return set;
}

std::size_t rotations_for_cover(double cover_rad) {
    return static_cast<std::size_t>(std::ceil(std::max(kCoverVolume / std::pow(cover_rad, 3.0), 1.0)));
}

double cover_of_rotations_rad(std::size_t count) {
    return std::cbrt(kCoverVolume / static_cast<double>(std::max<std::size_t>(count, 1)));
}

}  // namespace tact
