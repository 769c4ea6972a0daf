#include "rt/force/docking/flexible_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "ipc/scene/density/vector_grid.hpp"

namespace tact {
namespace {

constexpr double kLinkMostM = 8e-10;  // longer gaps in a chain do not hold

std::vector<Vec3> centres_of(const Structure& s, const NormalModes& modes) {
    std::vector<Vec3> at(modes.nodes(), Vec3::Zero());
    std::vector<double> atoms(modes.nodes(), 0.0);
    for (std::size_t i = 0; i < s.size(); ++i) {
        at[modes.node[i]] += Eigen::Vector3f(s.x_m[i], s.y_m[i], s.z_m[i]).cast<double>();
        atoms[modes.node[i]] += 1.0;
    }
    for (std::size_t n = 0; n < at.size(); ++n) at[n] /= atoms[n];
    return at;
}

std::vector<std::uint32_t> nearest_nodes(const PointSet& points, const VectorGrid& centres) {
    std::vector<std::uint32_t> node;
    for (std::size_t i = 0; i < points.size(); ++i) {
        std::array<VectorGrid::Near, 1> near{};
        static_cast<void>(centres.nearest(
            Eigen::Vector3f(points.x_m[i], points.y_m[i], points.z_m[i]).cast<double>(), near));
        node.push_back(near[0].index);
    }
    return node;
}

}  // namespace

FlexibleParts make_flexible_parts(const Structure& s, const std::vector<PointSet>& levels,
                                  NormalModes modes) {
    FlexibleParts parts;
    if (modes.count() == 0) return parts;
    parts.modes = std::move(modes);
    const NormalModes& m = parts.modes;
    const std::vector<Vec3> centre = centres_of(s, m);
    Vec3 low = centre.front(), high = centre.front();
    for (const Vec3& c : centre) {
        low = low.cwiseMin(c);
        high = high.cwiseMax(c);
    }
    const VectorGrid grid(centre, low, high);
    for (const PointSet& level : levels) {
        parts.node.push_back(nearest_nodes(level, grid));
        if (&level != &levels.back()) continue;
        for (std::size_t i = 0; i < level.size(); ++i) parts.node.back()[i] = m.node[level.source[i]];
    }
    std::vector<std::uint16_t> chain(m.nodes());
    for (std::size_t i = 0; i < s.size(); ++i) chain[m.node[i]] = s.chain[i];
    for (std::uint32_t n = 1; n < m.nodes(); ++n) {
        const Vec3 rest = centre[n] - centre[n - 1];
        if (chain[n] == chain[n - 1] && rest.norm() > 0.0 && rest.norm() <= kLinkMostM)
            parts.links.push_back({n - 1, n, rest});
    }
    for (std::size_t k = 0; k < m.count(); ++k) {
        double most = 0.0;
        for (const FlexibleParts::Link& link : parts.links)
            most = std::max(most,
                            (m.unit_shift(k, link.b) - m.unit_shift(k, link.a)).norm() / link.rest_m.norm());
        parts.strain_per_m.push_back(most);
        parts.spring.push_back(3.0 * static_cast<double>(m.stiffness[k]) /
                               static_cast<double>(m.stiffness[m.count() / 2]));
    }
    // Of all amplitudes with the same RMSD, the one that moves a node farthest is in the direction of its row of displacements; the
    // norm of the row bounds it.
    for (std::size_t n = 0; n < m.nodes(); ++n) {
        double square = 0.0;
        for (std::size_t k = 0; k < m.count(); ++k) square += m.unit_shift(k, n).squaredNorm();
        parts.shift_per_m = std::max(parts.shift_per_m, std::sqrt(square));
    }
    return parts;
}

}  // namespace tact
