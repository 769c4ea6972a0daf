#include "prep/mesh/mesh_folds.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace tact {

std::size_t count_folds(const TriangleMesh& mesh) {
    struct Side {
        std::uint64_t edge;  // both ends, the smaller first
        std::uint32_t triangle;
        bool forward;
    };
    std::vector<Side> side;
    side.reserve(mesh.triangle.size());
    std::vector<Eigen::Vector3f> unit(mesh.triangles());
    for (std::uint32_t t = 0; t < mesh.triangles(); ++t) {
        const std::uint32_t* v = &mesh.triangle[3 * std::size_t{t}];
        const auto at = [&](std::uint32_t i) {
            const float* p = &mesh.position_m[3 * std::size_t{i}];
            return Eigen::Vector3d(p[0], p[1], p[2]);
        };
        const Eigen::Vector3d area = (at(v[1]) - at(v[0])).cross(at(v[2]) - at(v[0]));
        const double length = area.norm();
        unit[t] = (area * (length > 0.0 ? 1.0 / length : 0.0)).cast<float>();
        for (int i = 0; i < 3; ++i) {
            const std::uint64_t a = v[i], b = v[(i + 1) % 3];
            side.push_back({a < b ? a << 32U | b : b << 32U | a, t, a < b});
        }
    }
    std::sort(side.begin(), side.end(), [](const Side& a, const Side& b) { return a.edge < b.edge; });
    std::size_t folds = 0;
    for (std::size_t i = 0, end = 0; i < side.size(); i = end) {
        while (end < side.size() && side[end].edge == side[i].edge) ++end;
        if (end - i != 2) continue;
        // Neighbours that use the edge in the same direction face opposite sides.
        const float sign = side[i].forward == side[i + 1].forward ? -1.0F : 1.0F;
        const Eigen::Vector3f &m = unit[side[i].triangle], &n = unit[side[i + 1].triangle];
        if (sign * m.dot(n) < -0.866F || m.isZero() || n.isZero()) ++folds;
    }
    return folds;
}

}  // namespace tact
