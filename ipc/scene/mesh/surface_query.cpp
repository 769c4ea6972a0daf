// Tests a node's four boxes together with GCC's vector extension.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "ipc/base/prefetch.hpp"
#include "ipc/scene/mesh/surface_mesh.hpp"

namespace tact {
namespace {

using F4 [[gnu::vector_size(16)]] = float;

F4 all(float value) { return F4{value, value, value, value}; }
F4 load(const std::array<float, 4>& values) {
    F4 v;
    std::memcpy(&v, values.data(), sizeof v);
    return v;
}
F4 most(const F4& a, const F4& b) { return a > b ? a : b; }
// Squared distances of the four boxes.
F4 box_squares(const SurfaceNode& node, const F4& x, const F4& y, const F4& z) {
    const F4 none = all(0.0F);
    const F4 dx = most(most(load(node.low_m[0]) - x, x - load(node.high_m[0])), none);
    const F4 dy = most(most(load(node.low_m[1]) - y, y - load(node.high_m[1])), none);
    const F4 dz = most(most(load(node.low_m[2]) - z, z - load(node.high_m[2])), none);
    return dx * dx + dy * dy + dz * dz;
}

constexpr std::size_t kStack = std::size_t{3} * (SurfaceMesh::kDepthMax + 1) + 4;

}  // namespace

bool SurfaceMesh::leaves_near(const Vec3& centre_m, double radius_m, std::span<std::uint32_t> out,
                              std::size_t& count) const noexcept {
    count = 0;
    // Rounding error of the centre in single precision.
    const double radius = radius_m * (1.0 + 1e-6) + 2e-7 * (largest_m_ + centre_m.cwiseAbs().maxCoeff());
    const auto square = static_cast<float>(radius * radius * (1.0 + 1e-6));
    const F4 x = all(static_cast<float>(centre_m.x())), y = all(static_cast<float>(centre_m.y())),
             z = all(static_cast<float>(centre_m.z()));
    std::array<std::uint32_t, kStack> stack;  // written before read
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const std::uint32_t now = stack[--depth];
        if ((now & SurfaceNode::kLeaf) != 0) {
            if (count == out.size()) return false;
            out[count++] = now;
            continue;
        }
        const SurfaceNode& node = node_[now];
        const F4 squares = box_squares(node, x, y, z);
        for (std::size_t k = 4; k-- > 0;) {
            const std::uint32_t code = node.child[k];
            if (!(squares[k] <= square) || code == SurfaceNode::kNone) continue;
            stack[depth++] = code;
            if ((code & SurfaceNode::kLeaf) == 0) {
                prefetch(&node_[code]);
                prefetch(&node_[code].child);
            } else {
                prefetch(&corner_[std::size_t{3} * SurfaceNode::leaf_first(code)]);
            }
        }
    }
    return true;
}

QueryJob SurfaceMesh::query_job(const Vec3& point_m) const noexcept {
    QueryJob job{};
    job.position = position_m_.data();
    job.corner = corner_.data();
    for (int axis = 0; axis < 3; ++axis) {
        job.whole[axis] = static_cast<float>(point_m[axis]);
        job.rest[axis] = static_cast<float>(point_m[axis] - static_cast<double>(job.whole[axis]));
    }
    return job;
}

// By the region of the triangle's plane (Ericson, Real-Time Collision Detection, 5.1.5).
SurfacePoint SurfaceMesh::point_of(std::uint32_t triangle, const Vec3& point_m) const noexcept {
    const auto corner = corners(triangle);
    const Vec3 a = position_m(corner[0]), b = position_m(corner[1]), c = position_m(corner[2]);
    const Vec3 ab = b - a, ac = c - a, ap = point_m - a, bp = point_m - b, cp = point_m - c;
    const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp),
                 d6 = ac.dot(cp);
    // On a border a part is exactly zero: 1 - (1 - s) - s may not be.
    const auto at = [&](double on_a, double on_b, double on_c) {
        SurfacePoint found;
        found.triangle = triangle;
        found.part = {on_a, on_b, on_c};
        found.point_m = a + on_b * ab + on_c * ac;
        found.distance_m = (point_m - found.point_m).norm();
        return found;
    };
    const auto share = [](double part, double rest) {
        return part + rest > 0.0 ? part / (part + rest) : 0.0;
    };
    if (d1 <= 0.0 && d2 <= 0.0) return at(1.0, 0.0, 0.0);
    if (d3 >= 0.0 && d4 <= d3) return at(0.0, 1.0, 0.0);
    if (d6 >= 0.0 && d5 <= d6) return at(0.0, 0.0, 1.0);
    const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
        const double s = share(d1, -d3);
        return at(1.0 - s, s, 0.0);
    }
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
        const double s = share(d2, -d6);
        return at(1.0 - s, 0.0, s);
    }
    if (va <= 0.0 && d4 >= d3 && d5 >= d6) {
        const double s = share(d4 - d3, d5 - d6);
        return at(0.0, 1.0 - s, s);
    }
    const double sum = va + vb + vc;
    return at(1.0 - vb / sum - vc / sum, vb / sum, vc / sum);
}

SurfacePoint SurfaceMesh::nearest(const Vec3& point_m, double radius_m, std::uint32_t hint,
                                  std::uint32_t visits_max) const noexcept {
    SurfacePoint best;
    best.distance_m = radius_m;
    if (!point_m.allFinite() || node_.empty()) return best;
    const auto take = [&](std::uint32_t triangle) {
        const SurfacePoint found = point_of(triangle, point_m);
        if (found.distance_m < best.distance_m) best = found;
    };
    if (hint < triangles()) take(hint);
    const F4 x = all(static_cast<float>(point_m.x())), y = all(static_cast<float>(point_m.y())),
             z = all(static_cast<float>(point_m.z()));
    // Boxes are compared in single precision, so boxes slightly beyond the best are visited too.
    const double margin = 2e-7 * (largest_m_ + point_m.cwiseAbs().maxCoeff());
    const auto limit = [&] {
        const double reach = std::min(best.distance_m * (1.0 + 1e-6) + margin, 1e18);
        return static_cast<float>(reach * reach);
    };
    struct Entry {
        float square;
        std::uint32_t code;
    };
    std::array<Entry, kStack> stack;  // written before read
    std::size_t depth = 0;
    stack[depth++] = {0.0F, 0};
    float square = limit();
    QueryJob job = query_job(point_m);
    TriangleQueries seen;
    while (depth > 0) {
        const Entry entry = stack[--depth];
        if (!(entry.square <= square)) continue;
        if (visits_max-- == 0) {
            best.exhausted = true;
            break;
        }
        if ((entry.code & SurfaceNode::kLeaf) != 0) {
            const std::uint32_t first = SurfaceNode::leaf_first(entry.code);
            const std::uint32_t last = SurfaceNode::leaf_count(entry.code) - 1;
            const std::array<std::uint32_t, 4> triangle{first, first + std::min(1U, last),
                                                        first + std::min(2U, last), first + last};
            job.triangle = triangle.data();
            query_four(job, seen);
            for (std::uint32_t lane = 0; lane <= last; ++lane) {
                if (seen.distance[lane] * seen.distance[lane] <= square) take(first + lane);
            }
            square = limit();
            continue;
        }
        const SurfaceNode& node = node_[entry.code];
        const F4 squares = box_squares(node, x, y, z);
        const std::size_t begin = depth;
        for (std::size_t k = 0; k < 4; ++k) {
            if (!(squares[k] <= square) || node.child[k] == SurfaceNode::kNone) continue;
            // The nearest on top.
            std::size_t i = depth++;
            for (; i > begin && stack[i - 1].square < squares[k]; --i) stack[i] = stack[i - 1];
            stack[i] = {squares[k], node.child[k]};
        }
    }
    return best;
}

double SurfaceMesh::clearance_m(const Vec3& point_m, double at_most_m,
                                std::uint32_t visits_max) const noexcept {
    if (!point_m.allFinite() || node_.empty()) return 0.0;
    const F4 x = all(static_cast<float>(point_m.x())), y = all(static_cast<float>(point_m.y())),
             z = all(static_cast<float>(point_m.z()));
    struct Entry {
        float square;
        std::uint32_t node;
    };
    std::array<Entry, kStack> stack;  // written before read
    std::size_t depth = 0;
    stack[depth++] = {0.0F, 0};
    auto least = static_cast<float>(std::min(at_most_m * at_most_m, 1e36));
    while (depth > 0 && least > 0.0F) {
        const Entry entry = stack[--depth];
        if (!(entry.square < least)) continue;
        if (visits_max-- == 0) return 0.0;
        const SurfaceNode& node = node_[entry.node];
        const F4 squares = box_squares(node, x, y, z);
        const std::size_t begin = depth;
        for (std::size_t k = 0; k < 4; ++k) {
            if (!(squares[k] < least) || node.child[k] == SurfaceNode::kNone) continue;
            if ((node.child[k] & SurfaceNode::kLeaf) != 0) {
                least = squares[k];
                continue;
            }
            // The nearest on top.
            std::size_t i = depth++;
            for (; i > begin && stack[i - 1].square < squares[k]; --i) stack[i] = stack[i - 1];
            stack[i] = {squares[k], node.child[k]};
        }
    }
    // Rounding error of the point and the boxes in single precision.
    const double rounding = 2e-7 * (largest_m_ + point_m.cwiseAbs().maxCoeff());
    return std::max(std::sqrt(static_cast<double>(least)) * (1.0 - 1e-6) - rounding, 0.0);
}

Vec3 SurfaceMesh::normal_at(const SurfacePoint& at) const noexcept {
    const auto corner = corners(at.triangle);
    const Vec3 sum =
        at.part[0] * normal(corner[0]) + at.part[1] * normal(corner[1]) + at.part[2] * normal(corner[2]);
    const double length = sum.norm();
    return length > 1e-6 ? Vec3(sum / length) : normal(corner[0]);
}

Vec3 SurfaceMesh::facet_normal(std::uint32_t triangle) const noexcept {
    const auto corner = corners(triangle);
    const Vec3 a = position_m(corner[0]);
    const Vec3 n = (position_m(corner[1]) - a).cross(position_m(corner[2]) - a);
    const double length = n.norm();
    return length > 0.0 ? Vec3(n / length) : Vec3(Vec3::Zero());
}

}  // namespace tact
