// The arithmetic of triangle_query.hpp for TACT_LANES triangles at once. Each triangle_query_*.cpp includes
// it inside its anonymous namespace, after F and I (that many floats and int32), root(F), bits(I),
// TACT_LANE, which declares a function, and points(position, corner, triangle, x, y, z), which loads the
// vertices corner[3 * triangle] of that many triangles.
//
// Uses GCC's vector extension, which clang supports too.
// No #pragma once: each file includes it with different types.

struct Lanes3 {
    F x, y, z;
};

TACT_LANE F all(float value) { return F{} + value; }
TACT_LANE F least(const F& a, const F& b) { return a < b ? a : b; }
TACT_LANE F most(const F& a, const F& b) { return a > b ? a : b; }
TACT_LANE F dot(const Lanes3& a, const Lanes3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
TACT_LANE Lanes3 minus(const Lanes3& a, const Lanes3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
TACT_LANE Lanes3 times(const F& s, const Lanes3& a) { return {s * a.x, s * a.y, s * a.z}; }
TACT_LANE Lanes3 cross(const Lanes3& a, const Lanes3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
TACT_LANE Lanes3 choose(const I& mask, const Lanes3& a, const Lanes3& b) {
    return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}

inline constexpr float kTiny = 1e-36F;  // squared; smaller lengths count as zero
// Bound of a squared sine: the normal of a thinner triangle is mostly rounding error, so only its edges count.
inline constexpr float kNeedle = 1e-8F;

// The point of the segment from a to a + ab nearest to the origin.
TACT_LANE Lanes3 nearest_of_edge(const Lanes3& a, const Lanes3& ab) {
    const F t = least(most(-dot(a, ab) / most(dot(ab, ab), all(kTiny)), all(0.0F)), all(1.0F));
    return {a.x + t * ab.x, a.y + t * ab.y, a.z + t * ab.z};
}

TACT_LANE Lanes3 corners_from(const QueryJob& job, std::size_t corner, std::size_t first) {
    F x, y, z;
    points(job.position, job.corner + corner, job.triangle + first, x, y, z);
    return {(x - job.whole[0]) - job.rest[0], (y - job.whole[1]) - job.rest[1],
            (z - job.whole[2]) - job.rest[2]};
}

TACT_LANE void store(const F& v, float* to) { __builtin_memcpy(to, &v, sizeof v); }
TACT_LANE void store(const Lanes3& v, float (*to)[kLooks], std::size_t first) {
    store(v.x, to[0] + first);
    store(v.y, to[1] + first);
    store(v.z, to[2] + first);
}

TACT_LANE void look_at(const QueryJob& job, std::size_t first, TriangleQueries& out) {
    const Lanes3 a = corners_from(job, 0, first), b = corners_from(job, 1, first),
                 c = corners_from(job, 2, first);
    const Lanes3 ab = minus(b, a), bc = minus(c, b), ca = minus(a, c);
    const Lanes3 on_ab = nearest_of_edge(a, ab), on_bc = nearest_of_edge(b, bc),
                 on_ca = nearest_of_edge(c, ca);
    const F d_ab = dot(on_ab, on_ab), d_bc = dot(on_bc, on_bc), d_ca = dot(on_ca, on_ca);
    Lanes3 q = choose(d_bc < d_ab, on_bc, on_ab);
    F square = least(d_ab, d_bc);
    q = choose(d_ca < square, on_ca, q);
    square = least(d_ca, square);

    // The foot on the plane is inside if it is to the left of every edge.
    const Lanes3 n = cross(ab, bc);
    const F nn = dot(n, n);
    const F inverse = 1.0F / root(most(nn, all(kTiny)));
    const F height = dot(n, a) * inverse;  // signed distance of the plane from the origin, along n
    const I flat = nn > most(kNeedle * dot(ab, ab) * dot(bc, bc), all(kTiny));
    const I inside = flat & (dot(n, cross(a, ab)) >= 0.0F) & (dot(n, cross(b, bc)) >= 0.0F) &
                     (dot(n, cross(c, ca)) >= 0.0F);
    const F side = height > 0.0F ? all(-1.0F) : all(1.0F);  // of the origin
    const Lanes3 facet = times(side * inverse, n);
    const F up = -side * height;

    const F length = root(square);
    const F per_length = -1.0F / most(length, all(1e-18F));
    const Lanes3 away = choose(inside, facet, times(per_length, q));
    const F distance = inside ? up : length;
    store(distance, out.distance + first);
    store(away, out.away, first);
    store(choose(flat, facet, away), out.facet, first);
    store(flat ? up : distance, out.height + first);
    out.over |= bits(inside) << first;
    out.near |= bits(distance < job.limit) << first;
}

TACT_LANE void look_at_all(const QueryJob& job, TriangleQueries& out) {
    out.over = 0;
    out.near = 0;
    for (std::size_t first = 0; first < kLooks; first += TACT_LANES) look_at(job, first, out);
}
