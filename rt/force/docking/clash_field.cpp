// Let g be the distance to the nearest atom on a grid of 2 A. Voxels with g >= 2.8 A that are connected to the
// outside are free. A ball of radius e = g - 2.8 A around a free voxel is free too, so the depth of an inner
// voxel x is the minimum of |x - y| - e(y) over the free voxels y, exact to a fraction of a voxel. Sweeps over
// the grid propagate the minimizing y between adjacent voxels (Danielsson 1980).
//
// The values serve as the spline's coefficients, not as its interpolation points. This smooths the field and
// keeps it from going below zero at its edge. Applying the B-spline (1/6, 4/6, 1/6 along each axis) beforehand
// cancels the interpolating prefilter of DensityMap.
#include "rt/force/docking/clash_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ipc/base/error.hpp"

namespace tact {

namespace {

constexpr double kVoxelM = 2e-10;
constexpr double kVoxelsMax = 1 << 24;  // 256^3: 510 A at 2 A; larger bodies get larger voxels
constexpr double kSideMax = 8192;
constexpr double kSpacingM = 5e-10;
constexpr std::size_t kPointsMax = 1024;
constexpr std::size_t kRun = 32;
constexpr double kWidestM = 1e-3;
constexpr double kSurfaceM = 1.5e-10;  // an atom deeper than an isolated one by this much is inside

Vec3 atom(const Structure& s, std::size_t i) {
    return {static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]), static_cast<double>(s.z_m[i])};
}

struct Grid {
    DensityGrid grid;
    double voxel_m = 0.0, border_m = 0.0;
    std::array<std::ptrdiff_t, 3> n{};
    [[nodiscard]] std::size_t index(const std::array<std::ptrdiff_t, 3>& v) const {
        return static_cast<std::size_t>((v[2] * n[1] + v[1]) * n[0] + v[0]);
    }
    [[nodiscard]] bool inside(const std::array<std::ptrdiff_t, 3>& v) const {
        return v[0] >= 0 && v[1] >= 0 && v[2] >= 0 && v[0] < n[0] && v[1] < n[1] && v[2] < n[2];
    }
    [[nodiscard]] std::array<std::ptrdiff_t, 3> at(std::size_t i) const {
        const auto k = static_cast<std::ptrdiff_t>(i);
        return {k % n[0], k / n[0] % n[1], k / (n[0] * n[1])};
    }
};

Grid empty_grid(const Structure& s) {
    if (s.size() == 0) {
        throw StartupError("preparing the clash force of '" + s.name + "'", "it has no atoms",
                           "use a structure with atoms");
    }
    Vec3 low = atom(s, 0), high = low;
    bool finite = true;
    for (std::size_t i = 0; i < s.size(); ++i) {
        low = low.cwiseMin(atom(s, i));
        high = high.cwiseMax(atom(s, i));
        finite = finite && atom(s, i).allFinite();
    }
    if (!finite || !((high - low).maxCoeff() < kWidestM)) {
        throw StartupError("preparing the clash force of '" + s.name + "'",
                           "its atom positions are not finite, or more than a millimetre apart",
                           "bake the scene again");
    }
    Grid g;
    Vec3 voxels;
    for (g.voxel_m = kVoxelM;; g.voxel_m *= 1.1) {
        g.border_m = 2.0 * g.voxel_m + ClashField::kContactM;
        voxels = ((high - low).array() + 2.0 * g.border_m) / g.voxel_m + 2.0;
        if (voxels.prod() <= kVoxelsMax && voxels.maxCoeff() <= kSideMax) break;
    }
    g.grid.origin_m = low - Vec3::Constant(g.border_m);
    g.grid.spacing_m = Vec3::Constant(g.voxel_m);
    for (std::size_t a = 0; a < 3; ++a) {
        g.grid.size[a] = static_cast<std::uint32_t>(voxels[static_cast<Eigen::Index>(a)]);
        g.n[a] = static_cast<std::ptrdiff_t>(g.grid.size[a]);
    }
    g.grid.values.assign(g.grid.count(), 0.0F);
    return g;
}

// Distance to the nearest atom, limited to the width of the border.
std::vector<float> nearest_atom(const Structure& s, const Grid& g) {
    const double reach = g.border_m / g.voxel_m;
    std::vector<float> distance(g.grid.count(), static_cast<float>(g.border_m));
    for (std::size_t i = 0; i < s.size(); ++i) {
        const Vec3 p = (atom(s, i) - g.grid.origin_m) / g.voxel_m;
        std::array<std::ptrdiff_t, 3> first{}, last{};
        for (std::size_t a = 0; a < 3; ++a) {
            const auto axis = static_cast<Eigen::Index>(a);
            first[a] = std::max<std::ptrdiff_t>(0, static_cast<std::ptrdiff_t>(std::ceil(p[axis] - reach)));
            last[a] = std::min(g.n[a] - 1, static_cast<std::ptrdiff_t>(std::floor(p[axis] + reach)));
        }
        for (std::ptrdiff_t z = first[2]; z <= last[2]; ++z) {
            for (std::ptrdiff_t y = first[1]; y <= last[1]; ++y) {
                for (std::ptrdiff_t x = first[0]; x <= last[0]; ++x) {
                    const Vec3 d =
                        Vec3(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)) - p;
                    float& v = distance[g.index({x, y, z})];
                    v = std::min(v, static_cast<float>(g.voxel_m * d.norm()));
                }
            }
        }
    }
    return distance;
}

// True where free and connected to the outside; enclosed cavities are not free.
std::vector<bool> open_space(const Grid& g, const std::vector<float>& nearest) {
    const auto contact = static_cast<float>(ClashField::kContactM);
    std::vector<bool> open(nearest.size(), false);
    std::vector<std::size_t> waiting{0};  // the corner is outside: the border is wider than the contact
    open[0] = true;
    while (!waiting.empty()) {
        const auto here = g.at(waiting.back());
        waiting.pop_back();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (const std::ptrdiff_t step : {-1, 1}) {
                auto there = here;
                there[axis] += step;
                if (!g.inside(there)) continue;
                const std::size_t i = g.index(there);
                if (open[i] || nearest[i] < contact) continue;
                open[i] = true;
                waiting.push_back(i);
            }
        }
    }
    return open;
}

// Metres; zero where free.
std::vector<float> depth_of(const Grid& g, const std::vector<float>& nearest) {
    const std::vector<bool> open = open_space(g, nearest);
    constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();
    const std::size_t count = nearest.size();
    std::vector<std::uint32_t> source(count, kNone);
    std::vector<float> depth(count, std::numeric_limits<float>::max());
    const auto contact = static_cast<float>(ClashField::kContactM);
    for (std::size_t i = 0; i < count; ++i) {
        if (open[i]) source[i] = static_cast<std::uint32_t>(i), depth[i] = contact - nearest[i];
    }
    const auto sweep = [&](bool forward) {
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t i = forward ? k : count - 1 - k;
            if (open[i]) continue;
            const auto here = g.at(i);
            for (std::ptrdiff_t dz = -1; dz <= 1; ++dz) {
                for (std::ptrdiff_t dy = -1; dy <= 1; ++dy) {
                    for (std::ptrdiff_t dx = -1; dx <= 1; ++dx) {
                        const std::array<std::ptrdiff_t, 3> there{here[0] + dx, here[1] + dy, here[2] + dz};
                        if (!g.inside(there)) continue;
                        const std::uint32_t y = source[g.index(there)];
                        if (y == kNone || y == source[i]) continue;
                        const auto from = g.at(y);
                        const double d2 = std::pow(static_cast<double>(here[0] - from[0]), 2.0) +
                                          std::pow(static_cast<double>(here[1] - from[1]), 2.0) +
                                          std::pow(static_cast<double>(here[2] - from[2]), 2.0);
                        const auto d = static_cast<float>(g.voxel_m * std::sqrt(d2)) + contact - nearest[y];
                        if (d < depth[i]) depth[i] = d, source[i] = y;
                    }
                }
            }
        }
    };
    for (int round = 0; round < 2; ++round) {
        sweep(true);
        sweep(false);
    }
    for (float& d : depth) d = std::max(d, 0.0F);
    return depth;
}

// Convolves with (1/6, 4/6, 1/6) along one axis; values outside the grid are zero.
void spread(Grid& g, std::size_t axis) {
    const std::vector<float> in = g.grid.values;
    for (std::size_t i = 0; i < in.size(); ++i) {
        auto back = g.at(i), fore = back;
        --back[axis], ++fore[axis];
        const float before = g.inside(back) ? in[g.index(back)] : 0.0F;
        const float after = g.inside(fore) ? in[g.index(fore)] : 0.0F;
        g.grid.values[i] = (before + 4.0F * in[i] + after) / 6.0F;
    }
}

double depth_at(const Grid& g, const std::vector<float>& depth, const Vec3& p_m) {
    const Vec3 v = ((p_m - g.grid.origin_m) / g.voxel_m).array().round();
    return static_cast<double>(
        depth[g.index({static_cast<std::ptrdiff_t>(v.x()), static_cast<std::ptrdiff_t>(v.y()),
                       static_cast<std::ptrdiff_t>(v.z())})]);
}

struct Spread {
    std::vector<std::size_t> atoms;
    double weight = 1.0;
};

// Selects surface atoms by farthest-point sampling, until none is farther than the spacing from a selected one or the
// limit is reached. In the second case each point represents a larger piece of the surface (weight).
Spread spread_atoms(const Structure& s, const Grid& g, const std::vector<float>& depth) {
    std::vector<std::size_t> surface;
    for (std::size_t i = 0; i < s.size(); ++i) {
        if (depth_at(g, depth, atom(s, i)) < ClashField::kContactM + kSurfaceM) surface.push_back(i);
    }
    if (surface.empty()) surface.push_back(0);
    std::vector<double> away2(surface.size(), std::numeric_limits<double>::max());
    Spread out;
    std::size_t next = 0;
    while (true) {
        const Vec3 p = atom(s, surface[next]);
        out.atoms.push_back(surface[next]);
        for (std::size_t k = 0; k < surface.size(); ++k) {
            away2[k] = std::min(away2[k], (atom(s, surface[k]) - p).squaredNorm());
        }
        next = static_cast<std::size_t>(std::max_element(away2.begin(), away2.end()) - away2.begin());
        if (!(away2[next] > kSpacingM * kSpacingM)) return out;
        if (out.atoms.size() == kPointsMax) break;
    }
    out.weight = away2[next] / (kSpacingM * kSpacingM);
    return out;
}

}  // namespace

struct ClashField::Made {
    DensityMap map;
    PointSet points;
    std::vector<Run> runs;
    double point_weight;
    Vec3 low_m, high_m;
    double radius_m;
};

ClashField::Made ClashField::make(const Structure& structure) {
    Grid g = empty_grid(structure);
    const std::vector<float> nearest = nearest_atom(structure, g);
    const std::vector<float> depth = depth_of(g, nearest);
    double radius2 = 0.0;
    for (std::size_t i = 0; i < depth.size(); ++i) {
        g.grid.values[i] = static_cast<float>(std::pow(static_cast<double>(depth[i]) / kUnitM, kPower));
        if (!(depth[i] > 0.0F)) continue;
        const auto v = g.at(i);
        const Vec3 p =
            g.grid.origin_m +
            g.voxel_m * Vec3(static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2]));
        radius2 = std::max(radius2, p.squaredNorm());
    }
    for (std::size_t axis = 0; axis < 3; ++axis) spread(g, axis);
    const Spread spread_out = spread_atoms(structure, g, depth);
    const std::vector<std::size_t>& taken = spread_out.atoms;
    std::vector<float> x, y, z;
    const std::vector<float> w(taken.size(), 1.0F / static_cast<float>(taken.size()));
    for (const std::size_t i : taken) {
        x.push_back(structure.x_m[i]);
        y.push_back(structure.y_m[i]);
        z.push_back(structure.z_m[i]);
    }
    PointSet points = make_point_set({x, y, z, w}, structure.name);
    std::vector<Run> runs;
    for (std::size_t begin = 0; begin < points.size(); begin += kRun) {
        Run run{begin, std::min(kRun, points.size() - begin), Vec3::Zero(), 0.0};
        const auto point = [&](std::size_t i) {
            return Vec3(static_cast<double>(points.x_m[i]), static_cast<double>(points.y_m[i]),
                        static_cast<double>(points.z_m[i]));
        };
        for (std::size_t i = begin; i < begin + run.count; ++i) {
            run.middle_m += point(i) / static_cast<double>(run.count);
        }
        for (std::size_t i = begin; i < begin + run.count; ++i) {
            run.radius_m = std::max(run.radius_m, (point(i) - run.middle_m).norm());
        }
        runs.push_back(run);
    }
    const Vec3 width_m = g.voxel_m * Vec3(static_cast<double>(g.n[0] - 1), static_cast<double>(g.n[1] - 1),
                                          static_cast<double>(g.n[2] - 1));
    // A spline ends two voxels beyond its last coefficient that is not zero; three, for the corners.
    return {DensityMap(g.grid, 0.0, 1.0, {.interpolating = true}),
            std::move(points),
            std::move(runs),
            spread_out.weight,
            g.grid.origin_m,
            g.grid.origin_m + width_m,
            std::sqrt(radius2) + 4.0 * g.voxel_m};
}

ClashField::ClashField(const Structure& structure) : ClashField(make(structure)) {}

ClashField::ClashField(Made&& made)
    : map_(std::move(made.map)),
      points_(std::move(made.points)),
      runs_(std::move(made.runs)),
      point_weight_(made.point_weight),
      low_m_(made.low_m),
      high_m_(made.high_m),
      radius_m_(made.radius_m) {}

}  // namespace tact
