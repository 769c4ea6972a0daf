// Random numbers from a seed: identical on every machine and standard library, unlike the distributions of
// <random>.
//
// Thread   each object belongs to one; no allocation.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "ipc/base/pose.hpp"

namespace tact {

// splitmix64 (Steele, Lea, Flood 2014).
class SeededRandom {
public:
    explicit SeededRandom(std::uint64_t seed) : state_(seed) {}

    std::uint64_t next() noexcept {
        std::uint64_t z = state_ += 0x9E3779B97F4A7C15ULL;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
        return z ^ (z >> 31);
    }
    // In [0, 1).
    double uniform() noexcept { return static_cast<double>(next() >> 11) * 0x1p-53; }
    // In [0, count); count > 0. The bias is below 2^-32 for practical counts.
    std::uint64_t below(std::uint64_t count) noexcept {
        return std::min(static_cast<std::uint64_t>(uniform() * static_cast<double>(count)), count - 1);
    }
    // Uniform over the unit sphere.
    Vec3 direction() noexcept {
        const double z = 2.0 * uniform() - 1.0, angle = 2.0 * std::numbers::pi * uniform();
        const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
        return {r * std::cos(angle), r * std::sin(angle), z};
    }
    // In a random direction, with a length uniform in [0, length_max). One call, because C++ leaves the order of two calls
    // in an expression open.
    Vec3 within(double length_max) noexcept {
        const Vec3 way = direction();
        return length_max * uniform() * way;
    }
    // Uniform over all rotations (Shoemake 1992).
    Quat rotation() noexcept {
        const double u = uniform(), a = 2.0 * std::numbers::pi * uniform(),
                     b = 2.0 * std::numbers::pi * uniform();
        const double s = std::sqrt(1.0 - u), t = std::sqrt(u);
        return {t * std::cos(b), s * std::sin(a), s * std::cos(a), t * std::sin(b)};
    }

private:
    std::uint64_t state_;
};

}  // namespace tact
