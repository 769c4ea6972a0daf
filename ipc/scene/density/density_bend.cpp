// Second derivatives of the summed density. With r = x - c, g the gradient and H the second derivatives at a point, and [r]
// the matrix of r x, a shift changes the gradient by H and a small rotation dphi moves the point by dphi x r, so it changes
// r x g by
//     (dphi x r) x g + r x (H (dphi x r)) = [r g^T - (r . g) 1 - [r] H [r]] dphi.
// The sum of this over the points is symmetric only where the moment vanishes; its symmetric part is the curvature of the
// energy over rotations.
//
// A point takes longer than in the widest kernel of sum(): four floats at a time, and three times the
// weights. It is called for a few points per step (rt/force/docking/stiffness_audit.hpp).
#include <cmath>
#include <cstring>

#include "ipc/scene/density/density_layout.hpp"
#include "ipc/scene/density/density_map.hpp"

namespace tact {

namespace {

using Four = float __attribute__((vector_size(16)));
using FourInts = std::int32_t __attribute__((vector_size(16)));

struct BendWeights {
    float value[4], slope[4], bend[4];
};

// f in [0, 1) voxels past the second of four knots; per voxel.
BendWeights bend_weights(float f) noexcept {
    const float g = 1.0F - f;
    return {{g * g * g / 6.0F, f * f * (0.5F * f - 1.0F) + 2.0F / 3.0F,
             g * g * (0.5F * g - 1.0F) + 2.0F / 3.0F, f * f * f / 6.0F},
            {-0.5F * g * g, f * (1.5F * f - 2.0F), -g * (1.5F * g - 2.0F), 0.5F * f * f},
            {g, 3.0F * f - 2.0F, 1.0F - 3.0F * f, f}};
}

Four load(const float* p) noexcept {
    Four four;
    std::memcpy(&four, p, sizeof four);
    return four;
}

// Weights along x in the order of the loaded coefficients: w[(e - phase) mod 4] at e.
Four turned(const float* w, std::ptrdiff_t phase) noexcept {
    return Four{w[(4 - phase) & 3], w[(5 - phase) & 3], w[(6 - phase) & 3], w[(7 - phase) & 3]};
}

float total(Four v) noexcept { return (v[0] + v[1]) + (v[2] + v[3]); }

Eigen::Matrix3d cross_matrix(const Vec3& r) noexcept {
    Eigen::Matrix3d m;
    m << 0.0, -r.z(), r.y(), r.z(), 0.0, -r.x(), -r.y(), r.x(), 0.0;
    return m;
}

}  // namespace

DensityBends DensityMap::bends(const PointsView& points, const Pose& T_model_body) const noexcept {
    DensityBends out;
    const double norm = T_model_body.q.norm();
    if (!T_model_body.finite() || !(norm > 1e-6 && norm < 1e6)) return out;
    const Eigen::Matrix3d rotation = Quat(T_model_body.q.coeffs() / norm).toRotationMatrix();
    const bool windows = windows_.size() > 0;
    const DensityLayout layout = density_layout(padded_, windows);
    const float* const coefficients = windows ? windows_.data() : columns_.data();
    const Vec3 per_m = spacing_m_.cwiseInverse();
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 r = rotation * Vec3(static_cast<double>(points.x[i]), static_cast<double>(points.y[i]),
                                       static_cast<double>(points.z[i]));
        BendWeights w[3];
        std::ptrdiff_t cell[3];
        for (int a = 0; a < 3; ++a) {
            double t = (T_model_body.p_m[a] + r[a] - origin_m_[a]) * per_m[a] + kDensityPad;
            const double low = 1.0, high = padded_[static_cast<std::size_t>(a)] - 3;
            t = t > low ? t : low;  // also for NaN
            t = t < high ? t : high;
            const double whole = std::floor(t);
            w[a] = bend_weights(static_cast<float>(t - whole));
            cell[a] = static_cast<std::ptrdiff_t>(whole) - 1;
        }
        const std::ptrdiff_t phase = windows ? 0 : cell[0] % 4;
        const float* const patch = coefficients + cell[2] * layout.plane_stride +
                                   cell[0] / layout.step * layout.row_stride + 4 * cell[1];
        const auto p = static_cast<std::int32_t>(phase);
        const FourInts second = FourInts{0, 1, 2, 3} < FourInts{p, p, p, p};
        Four vv{}, sv{}, bv{}, vs{}, ss{}, vb{};  // first letter: weights along y, second: along z
        for (int y = 0; y < 4; ++y) {
            Four v{}, s{}, b{};
            for (int z = 0; z < 4; ++z) {
                const float* const row = patch + z * layout.plane_stride + std::ptrdiff_t{4 * y};
                const Four c = windows ? load(row) : (second ? load(row + layout.row_stride) : load(row));
                v += w[2].value[z] * c;
                s += w[2].slope[z] * c;
                b += w[2].bend[z] * c;
            }
            vv += w[1].value[y] * v;
            sv += w[1].slope[y] * v;
            bv += w[1].bend[y] * v;
            vs += w[1].value[y] * s;
            ss += w[1].slope[y] * s;
            vb += w[1].value[y] * b;
        }
        const Four x_value = turned(w[0].value, phase), x_slope = turned(w[0].slope, phase);
        const Four x_bend = turned(w[0].bend, phase);
        const auto sum = [](Four a, Four b) { return static_cast<double>(total(a * b)); };
        const Vec3 gradient = Vec3(sum(x_slope, vv), sum(x_value, sv), sum(x_value, vs)).cwiseProduct(per_m);
        const double xy = sum(x_slope, sv), xz = sum(x_slope, vs), yz = sum(x_value, ss);
        Eigen::Matrix3d h;
        h << sum(x_bend, vv), xy, xz, xy, sum(x_value, bv), yz, xz, yz, sum(x_value, vb);
        h = per_m.asDiagonal() * h * per_m.asDiagonal();
        const auto weight = static_cast<double>(points.weight[i]);
        const Eigen::Matrix3d lever = cross_matrix(r);
        const Eigen::Matrix3d outer = r * gradient.transpose();
        out.by_shift += weight * h;
        out.by_turn += weight * (0.5 * (outer + outer.transpose()) -
                                 r.dot(gradient) * Eigen::Matrix3d::Identity() - lever * h * lever);
    }
    if (!out.by_shift.allFinite() || !out.by_turn.allFinite()) return {};
    return out;
}

}  // namespace tact
