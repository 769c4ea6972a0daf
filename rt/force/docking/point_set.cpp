#include "rt/force/docking/point_set.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "ipc/base/error.hpp"

namespace tact {

namespace {

constexpr float kFarthestM = 1e-3F;  // ten million angstrom: no molecule is wider

// Interleaves twenty bits per axis.
std::uint64_t morton(const std::array<std::uint32_t, 3>& cell) {
    std::uint64_t code = 0;
    for (int bit = 19; bit >= 0; --bit) {
        for (const std::uint32_t c : cell) code = 2 * code + ((c >> bit) & 1U);
    }
    return code;
}

void check(const PointsView& p, const std::string& name) {
    const std::string attempt = "reading the points of '" + name + "'";
    const std::size_t n = p.x.size();
    if (n == 0) throw StartupError(attempt, "there are no points", "use a structure with atoms");
    if (p.y.size() != n || p.z.size() != n || p.weight.size() != n) {
        throw StartupError(attempt, "the numbers of coordinates and weights differ", "bake the scene again");
    }
    double total = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        const float farthest = std::max({std::abs(p.x[i]), std::abs(p.y[i]), std::abs(p.z[i])});
        const bool placed = std::isfinite(p.x[i]) && std::isfinite(p.y[i]) && std::isfinite(p.z[i]);
        if (!placed || farthest > kFarthestM) {
            throw StartupError(
                attempt,
                "point " + std::to_string(i) + " is not finite or farther than a millimetre from the origin",
                "bake the scene again");
        }
        if (!(p.weight[i] >= 0.0F && p.weight[i] <= 1.0F)) {
            throw StartupError(attempt, "the weight of point " + std::to_string(i) + " is not in [0, 1]",
                               "bake the scene again");
        }
        total += static_cast<double>(p.weight[i]);
    }
    if (std::abs(total - 1.0) > 1e-3) {
        throw StartupError(attempt, "the weights sum to " + std::to_string(total) + " instead of 1",
                           "bake the scene again");
    }
}

}  // namespace

PointSet make_point_set(const PointsView& points, const std::string& name) {
    check(points, name);
    const std::size_t n = points.size();
    const std::array<std::span<const float>, 3> axes{points.x, points.y, points.z};
    float low = points.x[0], high = points.x[0];
    for (const auto& axis : axes) {
        low = std::min(low, *std::min_element(axis.begin(), axis.end()));
        high = std::max(high, *std::max_element(axis.begin(), axis.end()));
    }
    const float scale = high > low ? 1048575.0F / (high - low) : 0.0F;
    std::vector<std::uint64_t> code(n);
    for (std::size_t i = 0; i < n; ++i) {
        std::array<std::uint32_t, 3> cell{};
        for (std::size_t a = 0; a < 3; ++a) {
            cell[a] = std::min(static_cast<std::uint32_t>((axes[a][i] - low) * scale), 1048575U);
        }
        code[i] = morton(cell);
    }
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return code[a] < code[b]; });
    PointSet set;
    for (const std::size_t i : order) {
        set.x_m.push_back(points.x[i]);
        set.y_m.push_back(points.y[i]);
        set.z_m.push_back(points.z[i]);
        set.weight.push_back(points.weight[i]);
        set.source.push_back(static_cast<std::uint32_t>(i));
        set.radius_m = std::max(set.radius_m,
                                std::hypot(static_cast<double>(points.x[i]), static_cast<double>(points.y[i]),
                                           static_cast<double>(points.z[i])));
    }
    return set;
}

}  // namespace tact
