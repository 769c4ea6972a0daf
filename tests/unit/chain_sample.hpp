// A folded chain of atoms like those of a protein, and the map of Gaussians around it, for the product and the reference.
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "ipc/base/random.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"
#include "tests/reference/docking_reference.hpp"

namespace tact::chain {

inline constexpr double kA = 1e-10;

// Atoms 1.5 A apart along a walk that stays in an ellipsoid with a lobe, at least 2.5 A from all but the last few.
inline Structure structure(std::size_t atoms, std::uint64_t seed = 1) {
    SeededRandom random(seed);
    const double size = 1.9 * std::cbrt(static_cast<double>(atoms)) * kA;
    std::vector<Vec3> at{Vec3::Zero()};
    const auto inside = [&](const Vec3& p) {
        const Vec3 body = p.cwiseQuotient(Vec3(1.3, 0.9, 0.7) * size);
        const Vec3 lobe = (p - Vec3(1.0, 0.7, 0.1) * size) / (0.6 * size);
        return body.norm() < 1.0 || lobe.norm() < 1.0;
    };
    Vec3 way = random.direction();
    while (at.size() < atoms) {
        Vec3 next = at.back();
        for (int tries = 0; tries < 60; ++tries) {
            const Vec3 turn = (way + 1.2 * random.direction()).normalized();
            const Vec3 p = at.back() + 1.5 * kA * turn;
            bool good = inside(p) || tries > 40;
            for (std::size_t i = 0; good && i + 4 < at.size(); ++i)
                good = (at[i] - p).norm() > (tries < 30 ? 2.5 : 1.4) * kA;
            if (!good) continue;
            next = p, way = turn;
            break;
        }
        if (next == at.back()) next += 1.5 * kA * (way = random.direction());
        at.push_back(next);
    }
    Structure s;
    s.name = "chain";
    Vec3 com = Vec3::Zero();
    std::vector<double> mass;
    for (const Vec3& p : at) {
        mass.push_back(random.uniform() < 0.65 ? 12.0 : 15.0);
        s.mass_u += mass.back();
        com += mass.back() * p;
    }
    com /= s.mass_u;
    for (std::size_t i = 0; i < atoms; ++i) {
        const Vec3 p = at[i] - com;
        s.x_m.push_back(static_cast<float>(p.x()));
        s.y_m.push_back(static_cast<float>(p.y()));
        s.z_m.push_back(static_cast<float>(p.z()));
        s.mass_fraction.push_back(static_cast<float>(mass[i] / s.mass_u));
    }
    return s;
}

inline reference::Atoms atoms_of(const PointsView& p) {
    reference::Atoms atoms;
    for (std::size_t i = 0; i < p.size(); ++i) {
        atoms.at_m.emplace_back(static_cast<double>(p.x[i]), static_cast<double>(p.y[i]),
                                static_cast<double>(p.z[i]));
        atoms.weight.push_back(static_cast<double>(p.weight[i]));
    }
    return atoms;
}
inline reference::Atoms atoms_of(const Structure& s) {
    return atoms_of(PointsView{s.x_m, s.y_m, s.z_m, s.mass_fraction});
}

inline reference::Place place_of(const Pose& pose) { return {pose.p_m, pose.q}; }

// The map of the structure at `home` as a sum of Gaussians of sigma_m, computed atom by atom; also sets the home.
inline DensityGrid map_of(Structure& s, double sigma_m, double voxel_m) {
    Vec3 low = Vec3::Constant(1.0), high = -low;
    for (std::size_t i = 0; i < s.size(); ++i) {
        const Vec3 p(static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]),
                     static_cast<double>(s.z_m[i]));
        low = low.cwiseMin(p), high = high.cwiseMax(p);
    }
    const double margin_m = 8.0 * sigma_m;
    s.home_com_model_m = Vec3::Constant(margin_m) - low + Vec3(0.3, 0.4, 0.1) * voxel_m;
    DensityGrid grid;
    grid.spacing_m = Vec3::Constant(voxel_m);
    for (int a = 0; a < 3; ++a)
        grid.size[static_cast<std::size_t>(a)] =
            static_cast<std::uint32_t>(std::ceil(((high - low)[a] + 2.0 * margin_m) / voxel_m)) + 1;
    std::vector<double> values(grid.count(), 0.0);
    const auto reach = static_cast<std::ptrdiff_t>(std::ceil(7.0 * sigma_m / voxel_m));
    const auto w = static_cast<std::size_t>(2 * reach + 1);
    std::vector<double> table[3] = {std::vector<double>(w), std::vector<double>(w), std::vector<double>(w)};
    for (std::size_t i = 0; i < s.size(); ++i) {
        const Vec3 p = s.home_com_model_m + Vec3(static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]),
                                                 static_cast<double>(s.z_m[i]));
        std::ptrdiff_t first[3];
        for (int a = 0; a < 3; ++a) {
            first[a] = static_cast<std::ptrdiff_t>(std::floor(p[a] / voxel_m)) - reach;
            for (std::size_t k = 0; k < w; ++k) {
                const double d =
                    static_cast<double>(first[a] + static_cast<std::ptrdiff_t>(k)) * voxel_m - p[a];
                table[a][k] = std::exp(-0.5 * d * d / (sigma_m * sigma_m));
            }
        }
        for (std::size_t z = 0; z < w; ++z)
            for (std::size_t y = 0; y < w; ++y)
                for (std::size_t x = 0; x < w; ++x) {
                    const std::ptrdiff_t at[3] = {first[0] + static_cast<std::ptrdiff_t>(x),
                                                  first[1] + static_cast<std::ptrdiff_t>(y),
                                                  first[2] + static_cast<std::ptrdiff_t>(z)};
                    bool inside = true;
                    for (std::size_t a = 0; a < 3; ++a)
                        inside = inside && at[a] >= 0 && at[a] < static_cast<std::ptrdiff_t>(grid.size[a]);
                    if (!inside) continue;
                    const auto index =
                        (static_cast<std::size_t>(at[2]) * grid.size[1] + static_cast<std::size_t>(at[1])) *
                            grid.size[0] +
                        static_cast<std::size_t>(at[0]);
                    values[index] +=
                        static_cast<double>(s.mass_fraction[i]) * table[0][x] * table[1][y] * table[2][z];
                }
    }
    for (const double v : values) grid.values.push_back(static_cast<float>(v));
    return grid;
}

inline double sigma_of(const DensityGrid& grid) {
    double sum = 0.0, squares = 0.0;
    for (const float v : grid.values) {
        sum += static_cast<double>(v);
        squares += static_cast<double>(v) * static_cast<double>(v);
    }
    const auto n = static_cast<double>(grid.count());
    return std::sqrt(squares / n - sum / n * sum / n);
}

inline reference::Grid grid_of(const DensityGrid& grid, double background, double sigma) {
    reference::Grid out;
    for (std::size_t a = 0; a < 3; ++a) out.size[a] = static_cast<int>(grid.size[a]);
    out.origin_m = grid.origin_m;
    out.spacing_m = grid.spacing_m;
    out.values.assign(grid.values.begin(), grid.values.end());
    out.background = background;
    out.sigma = sigma;
    return out;
}

}  // namespace tact::chain
