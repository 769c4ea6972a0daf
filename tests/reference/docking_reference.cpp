#include "tests/reference/docking_reference.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tact::reference {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kPad = 24;

// The cubic B-spline and its derivatives at a distance in voxels.
double value(double t) {
    const double u = std::abs(t);
    if (u >= 2.0) return 0.0;
    return u < 1.0 ? 2.0 / 3.0 - u * u + u * u * u / 2.0 : std::pow(2.0 - u, 3) / 6.0;
}
double slope(double t) {
    const double u = std::abs(t), sign = t < 0.0 ? -1.0 : 1.0;
    if (u >= 2.0) return 0.0;
    return sign * (u < 1.0 ? -2.0 * u + 1.5 * u * u : -0.5 * (2.0 - u) * (2.0 - u));
}
double bend(double t) {
    const double u = std::abs(t);
    if (u >= 2.0) return 0.0;
    return u < 1.0 ? -2.0 + 3.0 * u : 2.0 - u;
}

// Solves (c[i-1] + 4 c[i] + c[i+1]) / 6 = s[i] with c = 0 outside, by elimination.
void solve(std::vector<double>& line) {
    const std::size_t n = line.size();
    std::vector<double> factor(n);
    double pivot = 4.0;
    line[0] *= 6.0 / pivot;
    for (std::size_t i = 1; i < n; ++i) {
        factor[i] = 1.0 / pivot;
        pivot = 4.0 - factor[i];
        line[i] = (6.0 * line[i] - line[i - 1]) / pivot;
    }
    for (std::size_t i = n - 1; i-- > 0;) line[i] -= factor[i + 1] * line[i + 1];
}

// Multiplies a wave cos(w x) by 1 + (1 - cos w)^3 / 54: the sixth difference of the line, times -1/8/54.
void sharpen(std::vector<double>& line) {
    const std::vector<double> s = line;
    const auto at = [&](std::ptrdiff_t i) {
        return i >= 0 && i < static_cast<std::ptrdiff_t>(s.size()) ? s[static_cast<std::size_t>(i)] : 0.0;
    };
    for (std::size_t k = 0; k < s.size(); ++k) {
        const auto i = static_cast<std::ptrdiff_t>(k);
        const double sixth = at(i - 3) - 6.0 * at(i - 2) + 15.0 * at(i - 1) - 20.0 * at(i) +
                             15.0 * at(i + 1) - 6.0 * at(i + 2) + at(i + 3);
        line[k] -= sixth / 8.0 / 54.0;
    }
}

Matrix3d cross(const Vector3d& r) {
    Matrix3d m;
    m << 0.0, -r.z(), r.y(), r.z(), 0.0, -r.x(), -r.y(), r.x(), 0.0;
    return m;
}

double norm_of(const Matrix3d& symmetric) {
    return Eigen::SelfAdjointEigenSolver<Matrix3d>(symmetric).eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace

Spline::Spline(const Grid& grid) : spacing_m_(grid.spacing_m) {
    std::array<std::size_t, 3> n{};
    for (std::size_t a = 0; a < 3; ++a) {
        size_[a] = grid.size[a] + 2 * kPad;
        n[a] = static_cast<std::size_t>(size_[a]);
    }
    origin_m_ = grid.origin_m - kPad * grid.spacing_m;
    coefficient_.assign(n[0] * n[1] * n[2], 0.0);
    std::size_t next = 0;
    for (int z = 0; z < grid.size[2]; ++z)
        for (int y = 0; y < grid.size[1]; ++y)
            for (int x = 0; x < grid.size[0]; ++x)
                coefficient_[(static_cast<std::size_t>(z + kPad) * n[1] +
                              static_cast<std::size_t>(y + kPad)) *
                                 n[0] +
                             static_cast<std::size_t>(x + kPad)] =
                    (grid.values[next++] - grid.background) / grid.sigma;
    const std::array<std::size_t, 3> stride{1, n[0], n[0] * n[1]};
    for (std::size_t a = 0; a < 3; ++a) {
        std::vector<double> line(n[a]);
        for (std::size_t i = 0; i < coefficient_.size(); ++i) {
            if (i / stride[a] % n[a] != 0) continue;
            for (std::size_t k = 0; k < n[a]; ++k) line[k] = coefficient_[i + k * stride[a]];
            sharpen(line);
            solve(line);
            for (std::size_t k = 0; k < n[a]; ++k) coefficient_[i + k * stride[a]] = line[k];
        }
    }
}

double Spline::node(int x, int y, int z) const {
    const bool inside = x >= 0 && y >= 0 && z >= 0 && x < size_[0] && y < size_[1] && z < size_[2];
    return inside ? coefficient_[static_cast<std::size_t>((z * size_[1] + y) * size_[0] + x)] : 0.0;
}

Local Spline::at(const Vector3d& point_m) const {
    const Vector3d t = (point_m - origin_m_).cwiseQuotient(spacing_m_);
    // Per axis: the first of four nodes, and the weights of value, slope and bend.
    std::array<int, 3> first{};
    double w[3][3][4];
    for (int a = 0; a < 3; ++a) {
        first[a] = static_cast<int>(std::floor(t[a])) - 1;
        for (int k = 0; k < 4; ++k) {
            const double d = t[a] - (first[a] + k), h = spacing_m_[a];
            w[a][0][k] = value(d);
            w[a][1][k] = slope(d) / h;
            w[a][2][k] = bend(d) / (h * h);
        }
    }
    // sum[i][j][l]: i times differentiated by x, j by y, l by z.
    double sum[3][3][3] = {};
    for (int z = 0; z < 4; ++z) {
        double of_xy[3][3] = {};
        for (int y = 0; y < 4; ++y) {
            double of_x[3] = {};
            for (int x = 0; x < 4; ++x) {
                const double c = node(first[0] + x, first[1] + y, first[2] + z);
                for (int i = 0; i < 3; ++i) of_x[i] += c * w[0][i][x];
            }
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3 - i; ++j) of_xy[i][j] += of_x[i] * w[1][j][y];
        }
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3 - i; ++j)
                for (int l = 0; l < 3 - i - j; ++l) sum[i][j][l] += of_xy[i][j] * w[2][l][z];
    }
    Local local;
    local.density = sum[0][0][0];
    local.gradient = {sum[1][0][0], sum[0][1][0], sum[0][0][1]};
    local.bend << sum[2][0][0], sum[1][1][0], sum[1][0][1],  //
        sum[1][1][0], sum[0][2][0], sum[0][1][1],            //
        sum[1][0][1], sum[0][1][1], sum[0][0][2];
    return local;
}

Sums sum(const Spline& spline, const Atoms& atoms, const Place& body) {
    Sums sums;
    for (std::size_t i = 0; i < atoms.at_m.size(); ++i) {
        const Vector3d r = body.q * atoms.at_m[i];
        const double w = atoms.weight[i];
        const Local l = spline.at(body.p_m + r);
        sums.density += w * l.density;
        sums.gradient += w * l.gradient;
        sums.moment += w * r.cross(l.gradient);
        sums.by_shift += w * l.bend;
        // A rotation dphi moves the atom by dphi x r = -[r] dphi: d(r x g) = (dphi x r) x g + r x (H (dphi x r)).
        const Matrix3d turn = l.gradient.dot(r) * Matrix3d::Identity() -
                              0.5 * (r * l.gradient.transpose() + l.gradient * r.transpose()) +
                              cross(r) * l.bend * cross(r);
        sums.by_turn -= w * turn;
    }
    return sums;
}

Wrench wrench(const Sums& sums, const Gain& gain) {
    return {gain.energy_j_per_sigma / gain.world_per_model * sums.gradient,
            gain.energy_j_per_sigma * sums.moment};
}

Stiffness stiffness(const Sums& sums, const Gain& gain) {
    const double per_m = gain.energy_j_per_sigma / (gain.world_per_model * gain.world_per_model);
    return {per_m * norm_of(sums.by_shift), gain.energy_j_per_sigma * norm_of(sums.by_turn)};
}

Local gaussians(const Atoms& atoms, const Place& body, double sigma_m, const Vector3d& point_m) {
    Local local;
    const double s2 = sigma_m * sigma_m;
    for (std::size_t i = 0; i < atoms.at_m.size(); ++i) {
        const Vector3d d = point_m - (body.p_m + body.q * atoms.at_m[i]);
        const double e = atoms.weight[i] * std::exp(-0.5 * d.squaredNorm() / s2);
        local.density += e;
        local.gradient -= e / s2 * d;
        local.bend += e / s2 * (d * d.transpose() / s2 - Matrix3d::Identity());
    }
    return local;
}

Place climbed(const Spline& spline, const Atoms& atoms, Place body) {
    double gyration_2 = 0.0;
    for (std::size_t i = 0; i < atoms.at_m.size(); ++i)
        gyration_2 += atoms.weight[i] * atoms.at_m[i].squaredNorm();
    const double radius_m = std::sqrt(std::max(gyration_2, 1e-30));
    Sums here = sum(spline, atoms, body);
    for (double step_m = 1e-10; step_m > 1e-14;) {
        const Vector3d turn = here.moment / radius_m;
        const double steep = std::sqrt(here.gradient.squaredNorm() + turn.squaredNorm());
        if (!(steep > 0.0)) break;
        const Vector3d angle = step_m / (steep * radius_m) * turn;
        Place next = body;
        next.p_m += step_m / steep * here.gradient;
        if (angle.norm() > 0.0)
            next.q = Eigen::Quaterniond(Eigen::AngleAxisd(angle.norm(), angle.normalized())) * body.q;
        const Sums there = sum(spline, atoms, next);
        if (there.density > here.density) {
            body = next, here = there;
            step_m *= 1.5;
        } else {
            step_m *= 0.5;
        }
    }
    return body;
}

}  // namespace tact::reference
