#include "prep/mesh/border_distance.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "prep/mesh/mesh_stars.hpp"

namespace tact {
namespace {

constexpr double kPoints = 2000.0;  // sample points over the whole border

using Vec = Eigen::Vector3d;
using Edge = std::array<Vec, 2>;

std::vector<Edge> border_edges(const TriangleMesh& mesh) {
    const auto at = [&](std::uint32_t v) {
        const float* p = &mesh.position_m[3 * std::size_t{v}];
        return Vec(p[0], p[1], p[2]);
    };
    const MeshStars star(mesh);
    std::vector<Edge> edges;
    for (std::uint32_t v = 0; v < mesh.vertices(); ++v) {
        const std::uint32_t w = star.border()[v];
        if (w != UINT32_MAX && at(v) != at(w)) edges.push_back({at(v), at(w)});
    }
    return edges;
}

double mean_square(const std::vector<Edge>& from, const std::vector<Edge>& to) {
    double whole = 0.0, sum = 0.0;
    for (const auto& [a, b] : from) whole += (b - a).norm();
    for (const auto& [a, b] : from) {
        const double length = (b - a).norm();
        const double points = std::max(1.0, std::ceil(kPoints * length / whole));
        for (double i = 0.5; i < points; i += 1.0) {
            const Vec p = a + i / points * (b - a);
            double best = 1e300;
            for (const auto& [c, d] : to) {
                const Vec along = d - c;
                const double s = std::clamp((p - c).dot(along) / along.squaredNorm(), 0.0, 1.0);
                best = std::min(best, (p - c - s * along).squaredNorm());
            }
            sum += best * length / points;
        }
    }
    return sum / whole;
}

}  // namespace

double border_distance_rms_m(const TriangleMesh& a, const TriangleMesh& b) {
    const std::vector<Edge> of_a = border_edges(a), of_b = border_edges(b);
    if (of_a.empty() || of_b.empty()) return 0.0;
    return std::sqrt(0.5 * (mean_square(of_a, of_b) + mean_square(of_b, of_a)));
}

}  // namespace tact
