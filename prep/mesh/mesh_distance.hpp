// Distance between two surfaces: distances of random surface points of each to the other, in metres.
//
// The nearest triangle is found in a uniform grid, in shells around the point until no nearer one is possible.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "ipc/base/random.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

struct MeshDistance {
    double rms_m = 0.0, max_m = 0.0;
};

class MeshGrid {
public:
    explicit MeshGrid(const TriangleMesh& mesh, double cells_most = 256.0) : mesh_(mesh) {
        Eigen::Vector3d high = Eigen::Vector3d::Constant(-1e300);
        low_ = -high;
        for (std::uint32_t v = 0; v < mesh.vertices(); ++v) {
            low_ = low_.cwiseMin(corner(mesh, v));
            high = high.cwiseMax(corner(mesh, v));
        }
        diagonal_m_ = (high - low_).norm();
        // A surface occupies about n² of n³ cells; this leaves a few triangles in each of them.
        const double cells = std::clamp(std::sqrt(static_cast<double>(mesh.triangles())), 4.0, cells_most);
        const double widest = (high - low_).maxCoeff();
        if (widest > 0.0) cell_ = widest / cells;  // otherwise all vertices coincide
        for (int i = 0; i < 3; ++i) size_[i] = static_cast<int>((high - low_)[i] / cell_) + 1;
        list_.resize(static_cast<std::size_t>(size_[0]) * size_[1] * size_[2]);
        for (std::uint32_t t = 0; t < mesh.triangles(); ++t) {
            Eigen::Vector3d a = at(t, 0), b = a;
            for (int i = 1; i < 3; ++i) {
                a = a.cwiseMin(at(t, i));
                b = b.cwiseMax(at(t, i));
            }
            const Eigen::Vector3i from = cell(a), to = cell(b);
            for (int z = from.z(); z <= to.z(); ++z) {
                for (int y = from.y(); y <= to.y(); ++y) {
                    for (int x = from.x(); x <= to.x(); ++x) list(x, y, z).push_back(t);
                }
            }
        }
    }

    [[nodiscard]] double diagonal_m() const { return diagonal_m_; }

    struct Nearest {
        double squared = 1e300;
        std::uint32_t triangle = UINT32_MAX;  // none
    };
    [[nodiscard]] double squared(const Eigen::Vector3d& p) const {
        return nearest(p, [](std::uint32_t) { return true; }).squared;
    }
    // The nearest of the triangles for which accept(triangle) is true.
    template <class Accept>
    [[nodiscard]] Nearest nearest(const Eigen::Vector3d& p, Accept&& accept) const {
        const Eigen::Vector3i c = cell(p);
        Nearest best;
        for (int r = 0; r <= size_.maxCoeff(); ++r) {
            if (std::sqrt(best.squared) <= (r - 1) * cell_) break;
            for (int z = std::max(0, c.z() - r); z <= std::min(size_.z() - 1, c.z() + r); ++z) {
                for (int y = std::max(0, c.y() - r); y <= std::min(size_.y() - 1, c.y() + r); ++y) {
                    const bool wall = std::abs(z - c.z()) == r || std::abs(y - c.y()) == r;
                    for (int x = c.x() - r; x <= c.x() + r; x += wall || r == 0 ? 1 : 2 * r) {
                        if (x < 0 || x >= size_.x()) continue;
                        for (const std::uint32_t t : list(x, y, z)) {
                            const double square = to_triangle(p, t);
                            if (square < best.squared && accept(t)) best = {square, t};
                        }
                    }
                }
            }
        }
        return best;
    }

    // Adds the distances of `count` points, spread over `mesh` by area.
    template <class Add>
    static void sample(const TriangleMesh& mesh, std::size_t count, Add&& add) {
        std::vector<double> until;
        double sum = 0.0;
        for (std::size_t t = 0; t < mesh.triangles(); ++t) {
            const Eigen::Vector3d a = corner(mesh, mesh.triangle[3 * t]);
            sum += (corner(mesh, mesh.triangle[3 * t + 1]) - a)
                       .cross(corner(mesh, mesh.triangle[3 * t + 2]) - a)
                       .norm();
            until.push_back(sum);
        }
        SeededRandom random(1);
        for (std::size_t i = 0; i < count; ++i) {
            const double where =
                (static_cast<double>(i) + random.uniform()) / static_cast<double>(count) * sum;
            const auto t = std::min<std::size_t>(
                static_cast<std::size_t>(std::lower_bound(until.begin(), until.end(), where) - until.begin()),
                until.size() - 1);
            const double r = std::sqrt(random.uniform()), s = random.uniform();
            add(Eigen::Vector3d((1.0 - r) * corner(mesh, mesh.triangle[3 * t]) +
                                r * (1.0 - s) * corner(mesh, mesh.triangle[3 * t + 1]) +
                                r * s * corner(mesh, mesh.triangle[3 * t + 2])));
        }
    }

private:
    static Eigen::Vector3d corner(const TriangleMesh& mesh, std::uint32_t v) {
        const float* p = &mesh.position_m[3 * std::size_t{v}];
        return {p[0], p[1], p[2]};
    }
    [[nodiscard]] Eigen::Vector3d at(std::uint32_t t, int i) const {
        return corner(mesh_, mesh_.triangle[3 * t + static_cast<std::uint32_t>(i)]);
    }
    [[nodiscard]] Eigen::Vector3i cell(const Eigen::Vector3d& p) const {
        Eigen::Vector3i c;
        for (int i = 0; i < 3; ++i)
            c[i] = std::clamp(static_cast<int>(std::floor((p[i] - low_[i]) / cell_)), 0, size_[i] - 1);
        return c;
    }
    [[nodiscard]] std::size_t number(int x, int y, int z) const {
        return (static_cast<std::size_t>(z) * size_[1] + y) * size_[0] + x;
    }
    [[nodiscard]] const std::vector<std::uint32_t>& list(int x, int y, int z) const {
        return list_[number(x, y, z)];
    }
    std::vector<std::uint32_t>& list(int x, int y, int z) { return list_[number(x, y, z)]; }

    // Ericson, Real-Time Collision Detection, 5.1.5: selects the Voronoi region in the triangle's plane.
    [[nodiscard]] double to_triangle(const Eigen::Vector3d& p, std::uint32_t t) const {
        const Eigen::Vector3d a = at(t, 0), b = at(t, 1), c = at(t, 2);
        const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
        const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp),
                     d6 = ac.dot(cp);
        if (d1 <= 0 && d2 <= 0) return ap.squaredNorm();
        if (d3 >= 0 && d4 <= d3) return bp.squaredNorm();
        if (d6 >= 0 && d5 <= d6) return cp.squaredNorm();
        const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
        if (vc <= 0 && d1 >= 0 && d3 <= 0) return (ap - d1 / (d1 - d3) * ab).squaredNorm();
        if (vb <= 0 && d2 >= 0 && d6 <= 0) return (ap - d2 / (d2 - d6) * ac).squaredNorm();
        if (va <= 0 && d4 >= d3 && d5 >= d6)
            return (bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b)).squaredNorm();
        return (ap - ab * (vb / (va + vb + vc)) - ac * (vc / (va + vb + vc))).squaredNorm();
    }

    const TriangleMesh& mesh_;
    Eigen::Vector3d low_;
    Eigen::Vector3i size_;
    double cell_ = 1.0, diagonal_m_ = 0.0;
    std::vector<std::vector<std::uint32_t>> list_;
};

// Both directions; rms over all points of both.
inline MeshDistance two_sided(const TriangleMesh& a, const TriangleMesh& b, std::size_t points = 50000) {
    MeshDistance d;
    const auto one_way = [&](const TriangleMesh& from, const TriangleMesh& to) {
        const MeshGrid grid(to);
        MeshGrid::sample(from, points, [&](const Eigen::Vector3d& p) {
            const double squared = grid.squared(p);
            d.rms_m += squared;
            d.max_m = std::max(d.max_m, std::sqrt(squared));
        });
    };
    one_way(a, b);
    one_way(b, a);
    d.rms_m = std::sqrt(d.rms_m / (2.0 * static_cast<double>(points)));
    return d;
}

}  // namespace tact
