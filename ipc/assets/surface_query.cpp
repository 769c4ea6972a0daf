// Method. A leaf's four triangles are looked at together, one a lane: the nearest point of a triangle is that of
// its three edges, or the foot on its plane where that lies inside; no branch depends on which (a walk through
// the regions, one triangle after the other, mispredicts half of its branches). GCC's vector extension, so four
// lanes are two instructions' worth on every x86-64; wider ones did not pay for leaves of four.
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstring>

#include "ipc/assets/surface_mesh.hpp"

namespace tact {
namespace {

using F4 [[gnu::vector_size(16)]] = float;
using I4 [[gnu::vector_size(16)]] = std::int32_t;

struct F4x3 {
    F4 x, y, z;
};

F4 all(float value) { return F4{value, value, value, value}; }
F4 load(const std::array<float, 4>& values) {
    F4 v;
    std::memcpy(&v, values.data(), sizeof v);
    return v;
}
void store(const F4& v, std::array<float, 4>& values) { std::memcpy(values.data(), &v, sizeof v); }
F4 least(const F4& a, const F4& b) { return a < b ? a : b; }
F4 most(const F4& a, const F4& b) { return a > b ? a : b; }
F4 root(const F4& v) {
#if defined(__SSE__)
    return _mm_sqrt_ps(v);  // g++ makes four calls of the other, for the sake of errno
#else
    return F4{std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])};
#endif
}
F4 dot(const F4x3& a, const F4x3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
F4x3 minus(const F4x3& a, const F4x3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
F4x3 plus_times(const F4x3& a, const F4& s, const F4x3& b) {
    return {a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}
F4x3 times(const F4& s, const F4x3& a) { return {s * a.x, s * a.y, s * a.z}; }
F4x3 cross(const F4x3& a, const F4x3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
F4x3 choose(const I4& mask, const F4x3& a, const F4x3& b) {
    return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}

constexpr float kTiny = 1e-36F;  // of a square: below it a length is none

// Of the segment from a to a + ab, the point nearest to the origin.
F4x3 nearest_of_edge(const F4x3& a, const F4x3& ab) {
    const F4 t = -dot(a, ab) / most(dot(ab, ab), all(kTiny));
    return plus_times(a, least(most(t, all(0.0F)), all(1.0F)), ab);
}

// Squares of the distances of the four boxes.
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
    // The centre in single precision may lie off by this.
    const double radius = radius_m * (1.0 + 1e-6) + 2e-7 * (largest_m_ + centre_m.cwiseAbs().maxCoeff());
    const auto square = static_cast<float>(radius * radius * (1.0 + 1e-6));
    const F4 x = all(static_cast<float>(centre_m.x())), y = all(static_cast<float>(centre_m.y())),
             z = all(static_cast<float>(centre_m.z()));
    std::array<std::uint32_t, kStack> stack;  // filled before it is read
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const SurfaceNode& node = node_[stack[--depth]];
        const F4 squares = box_squares(node, x, y, z);
        for (std::size_t k = 0; k < 4; ++k) {
            if (!(squares[k] <= square)) continue;
            const std::uint32_t code = node.child[k];
            if (code == SurfaceNode::kNone) continue;
            if ((code & SurfaceNode::kLeaf) == 0) {
                stack[depth++] = code;
            } else {
                if (count == out.size()) return false;
                out[count++] = code;
            }
        }
    }
    return true;
}

void SurfaceMesh::look(std::uint32_t leaf, const Vec3& point_m, LeafLook& out) const noexcept {
    const std::uint32_t first = SurfaceNode::leaf_first(leaf), count = SurfaceNode::leaf_count(leaf);
    // The point as a sum of two singles: what is left of a corner near it after the first is exact.
    std::array<F4, 3> whole, rest;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double p = point_m[static_cast<Eigen::Index>(axis)];
        const auto high = static_cast<float>(p);
        whole[axis] = all(high);
        rest[axis] = all(static_cast<float>(p - static_cast<double>(high)));
    }
    const std::uint32_t* const c0 = corner_.data() + std::size_t{3} * first;
    const std::uint32_t* const c1 = c0 + (count > 1 ? 3 : 0);
    const std::uint32_t* const c2 = c1 + (count > 2 ? 3 : 0);
    const std::uint32_t* const c3 = c2 + (count > 3 ? 3 : 0);
    const auto at = [&](std::size_t k) -> F4x3 {
        const float* const p0 = position_m_.data() + std::size_t{3} * c0[k];
        const float* const p1 = position_m_.data() + std::size_t{3} * c1[k];
        const float* const p2 = position_m_.data() + std::size_t{3} * c2[k];
        const float* const p3 = position_m_.data() + std::size_t{3} * c3[k];
        const auto axis = [&](std::size_t i) {
            return (F4{p0[i], p1[i], p2[i], p3[i]} - whole[i]) - rest[i];
        };
        return {axis(0), axis(1), axis(2)};
    };
    const F4x3 a = at(0), b = at(1), c = at(2), ab = minus(b, a), bc = minus(c, b), ca = minus(a, c);
    const F4x3 on_ab = nearest_of_edge(a, ab), on_bc = nearest_of_edge(b, bc), on_ca = nearest_of_edge(c, ca);
    const F4 d_ab = dot(on_ab, on_ab), d_bc = dot(on_bc, on_bc), d_ca = dot(on_ca, on_ca);
    F4x3 q = choose(d_bc < d_ab, on_bc, on_ab);
    F4 square = least(d_ab, d_bc);
    q = choose(d_ca < square, on_ca, q);
    square = least(d_ca, square);

    // The foot on the plane is inside where it is to the left of every edge.
    const F4x3 n = cross(ab, bc);
    const F4 nn = dot(n, n);
    const F4 inverse = all(1.0F) / root(most(nn, all(kTiny)));
    const F4 height = dot(n, a) * inverse;  // of the plane over the origin, along n
    const I4 flat = nn > all(kTiny);
    const F4 none = all(0.0F);
    const I4 inside = flat & (dot(n, cross(a, ab)) >= none) & (dot(n, cross(b, bc)) >= none) &
                      (dot(n, cross(c, ca)) >= none);
    const F4x3 unit = times(inverse, n);
    const F4 side = height > none ? all(-1.0F) : all(1.0F);  // of the origin
    const F4x3 facet = times(side, unit);
    const F4 up = -side * height;

    const F4 length = root(square);
    const F4 per_length = all(-1.0F) / most(length, all(1e-18F));
    const F4x3 away = choose(inside, facet, times(per_length, q));
    const F4 distance = inside ? up : length;
    store(distance, out.distance_m);
    store(away.x, out.away[0]);
    store(away.y, out.away[1]);
    store(away.z, out.away[2]);
    const F4x3 plane = choose(flat, facet, away);
    store(plane.x, out.facet[0]);
    store(plane.y, out.facet[1]);
    store(plane.z, out.facet[2]);
    store(flat ? up : distance, out.height_m);
    store(inside ? all(1.0F) : none, out.over);
    for (std::uint32_t lane = count; lane < 4; ++lane) out.distance_m[lane] = 1e30F;
}

// By the region of the triangle's plane (Ericson, Real-Time Collision Detection, 5.1.5).
SurfacePoint SurfaceMesh::point_of(std::uint32_t triangle, const Vec3& point_m) const noexcept {
    const auto corner = corners(triangle);
    const Vec3 a = position_m(corner[0]), b = position_m(corner[1]), c = position_m(corner[2]);
    const Vec3 ab = b - a, ac = c - a, ap = point_m - a, bp = point_m - b, cp = point_m - c;
    const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp),
                 d6 = ac.dot(cp);
    const auto at = [&](double on_b, double on_c) {
        SurfacePoint found;
        found.triangle = triangle;
        found.part = {1.0 - on_b - on_c, on_b, on_c};
        found.point_m = a + on_b * ab + on_c * ac;
        found.distance_m = (point_m - found.point_m).norm();
        return found;
    };
    const auto share = [](double part, double rest) {
        return part + rest > 0.0 ? part / (part + rest) : 0.0;
    };
    if (d1 <= 0.0 && d2 <= 0.0) return at(0.0, 0.0);
    if (d3 >= 0.0 && d4 <= d3) return at(1.0, 0.0);
    if (d6 >= 0.0 && d5 <= d6) return at(0.0, 1.0);
    const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return at(share(d1, -d3), 0.0);
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return at(0.0, share(d2, -d6));
    if (va <= 0.0 && d4 >= d3 && d5 >= d6) {
        const double s = share(d4 - d3, d5 - d6);
        return at(1.0 - s, s);
    }
    const double sum = va + vb + vc;
    return at(vb / sum, vc / sum);
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
    // Boxes are compared in single precision, so a little beyond the best is still looked at.
    const double margin = 2e-7 * (largest_m_ + point_m.cwiseAbs().maxCoeff());
    const auto limit = [&] {
        const double reach = std::min(best.distance_m * (1.0 + 1e-6) + margin, 1e18);
        return static_cast<float>(reach * reach);
    };
    struct Entry {
        float square;
        std::uint32_t code;
    };
    std::array<Entry, kStack> stack;  // filled before it is read
    std::size_t depth = 0;
    stack[depth++] = {0.0F, 0};
    float square = limit();
    LeafLook seen;
    while (depth > 0) {
        const Entry entry = stack[--depth];
        if (!(entry.square <= square)) continue;
        if (visits_max-- == 0) {
            best.exhausted = true;
            break;
        }
        if ((entry.code & SurfaceNode::kLeaf) != 0) {
            look(entry.code, point_m, seen);
            const std::uint32_t first = SurfaceNode::leaf_first(entry.code);
            for (std::uint32_t lane = 0; lane < SurfaceNode::leaf_count(entry.code); ++lane) {
                if (seen.distance_m[lane] * seen.distance_m[lane] <= square) take(first + lane);
            }
            square = limit();
            continue;
        }
        const SurfaceNode& node = node_[entry.code];
        const F4 squares = box_squares(node, x, y, z);
        const std::size_t begin = depth;
        for (std::size_t k = 0; k < 4; ++k) {
            if (!(squares[k] <= square) || node.child[k] == SurfaceNode::kNone) continue;
            // The nearest one on top.
            std::size_t i = depth++;
            for (; i > begin && stack[i - 1].square < squares[k]; --i) stack[i] = stack[i - 1];
            stack[i] = {squares[k], node.child[k]};
        }
    }
    return best;
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
