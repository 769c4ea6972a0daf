// Sum of weighted squared distances to planes, stored about a point near them.
//
// q(d) = dᵀ A d + 2 bᵀ d + c for a displacement d from that point. Every plane of a vertex passes near the point, so
// b and c are as small as the error itself and single precision keeps its relative accuracy: a quadric and its vertex
// fit one cache line. About the origin (Garland, Heckbert) this would need double precision.
#pragma once

#include <Eigen/Core>

namespace tact {

struct Quadric {
    float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;  // A
    float bx = 0, by = 0, bz = 0;
    float c = 0;

    // Adds a plane through the reference point.
    void add_plane(const Eigen::Vector3f& unit_normal, float weight) {
        const Eigen::Vector3f w = weight * unit_normal;
        xx += w.x() * unit_normal.x();
        xy += w.x() * unit_normal.y();
        xz += w.x() * unit_normal.z();
        yy += w.y() * unit_normal.y();
        yz += w.y() * unit_normal.z();
        zz += w.z() * unit_normal.z();
    }
    [[nodiscard]] Eigen::Vector3f times(const Eigen::Vector3f& d) const {  // A d
        return {xx * d.x() + xy * d.y() + xz * d.z(), xy * d.x() + yy * d.y() + yz * d.z(),
                xz * d.x() + yz * d.y() + zz * d.z()};
    }
    [[nodiscard]] Eigen::Vector3f b() const { return {bx, by, bz}; }
    [[nodiscard]] float trace() const { return xx + yy + zz; }  // the sum of the weights
    [[nodiscard]] float operator()(const Eigen::Vector3f& d) const {
        const float value = d.dot(times(d) + 2.0F * b()) + c;
        return value > 0.0F ? value : 0.0F;  // negative only by rounding
    }
    // The same function about the point at `shift` from the present one.
    [[nodiscard]] Quadric about(const Eigen::Vector3f& shift) const {
        Quadric moved = *this;
        const Eigen::Vector3f b_new = times(shift) + b();
        moved.c = (*this)(shift);
        moved.bx = b_new.x();
        moved.by = b_new.y();
        moved.bz = b_new.z();
        return moved;
    }
    Quadric& operator+=(const Quadric& o) {
        xx += o.xx;
        xy += o.xy;
        xz += o.xz;
        yy += o.yy;
        yz += o.yz;
        zz += o.zz;
        bx += o.bx;
        by += o.by;
        bz += o.bz;
        c += o.c;
        return *this;
    }
};

// The displacement that minimizes q(d) + pull * trace * |d - anchor|². The pull fixes the solution in directions that
// the planes leave undetermined (flat and cylindrical regions) and hardly moves it otherwise.
inline Eigen::Vector3f minimum(const Quadric& q, const Eigen::Vector3f& anchor, float pull) {
    const double p = static_cast<double>(pull) * static_cast<double>(q.trace());
    const double xx = q.xx + p, yy = q.yy + p, zz = q.zz + p, xy = q.xy, xz = q.xz, yz = q.yz;
    const double rx = p * anchor.x() - q.bx, ry = p * anchor.y() - q.by, rz = p * anchor.z() - q.bz;
    const double c00 = yy * zz - yz * yz, c01 = xz * yz - xy * zz, c02 = xy * yz - xz * yy;
    const double c11 = xx * zz - xz * xz, c12 = xy * xz - xx * yz, c22 = xx * yy - xy * xy;
    const double det = xx * c00 + xy * c01 + xz * c02;
    const double s = 1.0 / det;
    return {static_cast<float>(s * (c00 * rx + c01 * ry + c02 * rz)),
            static_cast<float>(s * (c01 * rx + c11 * ry + c12 * rz)),
            static_cast<float>(s * (c02 * rx + c12 * ry + c22 * rz))};
}

}  // namespace tact
