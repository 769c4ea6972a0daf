// Surfaces with known properties and manifold statistics, for mesh tests.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact::test {

// A cube of n^3 samples over [-1, 1]^3 m with values f(point).
template <class Field>
DensityGrid sampled(std::uint32_t n, Field&& f) {
    DensityGrid grid;
    grid.size = {n, n, n};
    grid.origin_m = Vec3::Constant(-1.0);
    grid.spacing_m = Vec3::Constant(2.0 / (n - 1));
    for (std::uint32_t z = 0; z < n; ++z) {
        for (std::uint32_t y = 0; y < n; ++y) {
            for (std::uint32_t x = 0; x < n; ++x)
                grid.values.push_back(
                    static_cast<float>(f(Vec3(grid.origin_m + grid.spacing_m.cwiseProduct(Vec3(x, y, z))))));
        }
    }
    return grid;
}
inline double sphere(const Vec3& p) { return -p.norm(); }  // level -r: radius r
inline double torus(const Vec3& p) {                       // level -r: tube of radius r about a ring of 0.6
    return -std::hypot(std::hypot(p.x(), p.y()) - 0.6, p.z());
}

inline Vec3 point(const TriangleMesh& mesh, std::uint32_t v) {
    return {mesh.position_m[3 * v], mesh.position_m[3 * v + 1], mesh.position_m[3 * v + 2]};
}
inline Vec3 double_area(const TriangleMesh& mesh, std::size_t t) {
    const Vec3 a = point(mesh, mesh.triangle[3 * t]);
    return (point(mesh, mesh.triangle[3 * t + 1]) - a).cross(point(mesh, mesh.triangle[3 * t + 2]) - a);
}
inline double area(const TriangleMesh& mesh) {
    double sum = 0.0;
    for (std::size_t t = 0; t < mesh.triangles(); ++t) sum += 0.5 * double_area(mesh, t).norm();
    return sum;
}
inline double volume(const TriangleMesh& mesh) {  // positive if closed and oriented outward
    double sum = 0.0;
    for (std::size_t t = 0; t < mesh.triangles(); ++t)
        sum += point(mesh, mesh.triangle[3 * t]).dot(double_area(mesh, t)) / 6.0;
    return sum;
}

struct Topology {
    long euler = 0;                    // V - E + F of the used vertices
    std::size_t border_edges = 0;      // one triangle
    std::size_t tangled_edges = 0;     // more than two triangles, or two with inconsistent orientation
    std::size_t tangled_vertices = 0;  // the triangles around it form more than one fan
    std::size_t flat_triangles = 0;    // no area, or two equal corners
    double sharpest = 1.0;             // smallest cosine between triangles at an edge
};

inline Topology topology(const TriangleMesh& mesh) {
    Topology result;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::pair<std::size_t, bool>>> edge;
    std::map<std::uint32_t, std::vector<std::pair<std::uint32_t, std::uint32_t>>> link;
    for (std::size_t t = 0; t < mesh.triangles(); ++t) {
        const std::uint32_t* v = &mesh.triangle[3 * t];
        if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0] || !(double_area(mesh, t).norm() > 0.0))
            ++result.flat_triangles;
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t a = v[i], b = v[(i + 1) % 3];
            edge[std::minmax(a, b)].push_back({t, a < b});
            link[a].push_back({b, v[(i + 2) % 3]});
        }
    }
    for (const auto& [ends, sides] : edge) {
        if (sides.size() == 1) ++result.border_edges;
        if (sides.size() > 2 || (sides.size() == 2 && sides[0].second == sides[1].second))
            ++result.tangled_edges;
        if (sides.size() == 2) {
            const Vec3 m = double_area(mesh, sides[0].first), n = double_area(mesh, sides[1].first);
            result.sharpest = std::min(result.sharpest, m.dot(n) / (m.norm() * n.norm()));
        }
    }
    for (const auto& [v, pairs] : link) {
        std::map<std::uint32_t, std::uint32_t> group;  // adjacent vertex -> representative
        const auto find = [&](std::uint32_t x) {
            while (group[x] != x) x = group[x];
            return x;
        };
        for (const auto& [a, b] : pairs) {
            group.try_emplace(a, a);
            group.try_emplace(b, b);
            group[find(a)] = find(b);
        }
        std::set<std::uint32_t> fans;
        for (const auto& [neighbour, unused] : group) fans.insert(find(neighbour));
        if (fans.size() > 1) ++result.tangled_vertices;
    }
    result.euler =
        static_cast<long>(link.size()) - static_cast<long>(edge.size()) + static_cast<long>(mesh.triangles());
    return result;
}

// A sheet of n x n squares over [0, 1]² with height f(x, y).
template <class Height>
TriangleMesh sheet(std::uint32_t n, Height&& f) {
    TriangleMesh mesh;
    for (std::uint32_t y = 0; y <= n; ++y) {
        for (std::uint32_t x = 0; x <= n; ++x) {
            const float u = static_cast<float>(x) / static_cast<float>(n);
            const float v = static_cast<float>(y) / static_cast<float>(n);
            mesh.position_m.insert(mesh.position_m.end(), {u, v, f(u, v)});
        }
    }
    for (std::uint32_t y = 0; y < n; ++y) {
        for (std::uint32_t x = 0; x < n; ++x) {
            const std::uint32_t a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
            mesh.triangle.insert(mesh.triangle.end(), {a, b, d, a, d, c});
        }
    }
    return mesh;
}

}  // namespace tact::test
