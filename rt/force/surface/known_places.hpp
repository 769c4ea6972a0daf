// Places whose distance from a surface is known: a bound for any place near them.
//
// Bound    A place at s from one at least d from the surface is at least d - s from it: true of every entry that the table may
//          hold, whatever place it was stored for, so entries that share a cell replace each other and need no key.
// Order    The order of calls alone decides what is in the table, so a replay finds the same.
// Unit     metres of the model.  Thread  constructed anywhere (allocates); then servo, TACT_RT.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

class KnownPlaces {
public:
    // cell_m: edge of the cells, > 0; one place is kept in each.
    explicit KnownPlaces(double cell_m) : per_m_(1.0 / cell_m), known_(std::size_t{1} << kBits) {}

    void remember(const Vec3& place_m, double distance_m) noexcept TACT_RT {
        known_[cell(place_m)] = {place_m.cast<float>(), static_cast<float>(distance_m)};
    }
    // A lower bound; negative if nothing is known.
    [[nodiscard]] double distance_m(const Vec3& place_m) const noexcept TACT_RT {
        const Known& k = known_[cell(place_m)];
        return static_cast<double>(k.distance_m) - (place_m - k.place_m.cast<double>()).norm() -
               kRounding * place_m.cwiseAbs().maxCoeff();
    }

private:
    struct Known {
        Eigen::Vector3f place_m = Eigen::Vector3f::Zero();
        float distance_m = -1.0F;
    };
    static constexpr std::size_t kBits = 14;
    static constexpr double kRounding = 4e-7;  // relative, of a stored place

    [[nodiscard]] std::size_t cell(const Vec3& place_m) const noexcept TACT_RT {
        const Eigen::Vector3i at = (per_m_ * place_m).array().floor().cast<int>();
        const auto mix = [](int n, std::uint32_t by) { return static_cast<std::uint32_t>(n) * by; };
        const std::uint32_t sum = mix(at.x(), 73856093U) ^ mix(at.y(), 19349663U) ^ mix(at.z(), 83492791U);
        return (sum * 2654435769U) >> (32 - kBits);
    }

    double per_m_;
    std::vector<Known> known_;
};

}  // namespace tact
