// With cells of variance s_c^2 along each axis (the second moment of the atoms minus that of the vectors, a third of it), the
// density of the atoms is that of the vectors smoothed by s_c, up to the third order. Measured as RMS error of the force
// against all atoms in the map itself, over 40 poses within 15 A and 30 degrees of the answer, bare vectors and smoothed by
// s_c (simulated maps): N = 200, 10 A: 1AKE 16 and 6 %, a chain of 1OEL 29 and 10 %; 20 A: 1AKE 3.7 and 0.8 %; N = 800, 10 A: 2.6
// and 1.0 %, 8.1 and 2.5 %. More smoothing makes this error larger again (by 1.5 s_c: 15 and 22 % at N = 200, 10 A), although
// the level then agrees better with all atoms in a map that is smoother by the same amount (3 %).
//
// A Gaussian 1.06 times as wide would fit cells of real proteins better, because they are compact (30 poses within 4 A, splines of
// a script, N = 200, 2026-11-28: 1AKE at 10 A 5.2 and 4.5 %, 1KP8 in EMD-1080 at 11.5 A 5.1 and 4.4 %, 2DQJ 2.2 and 1.8 %, 20 A 0.5 %
// with both), but runs of atoms along a chain worse, by a third.
//
// Where the cells are wider than the map resolves, a level cannot have the force of all atoms, which is mostly detail. There it
// must at least not show detail that is none: like any sampling, vectors a distance h apart represent waves longer than 2 h. With
// h = sqrt(12) s_c, a map whose total width is kWidth s_c has 2 exp(-2 pi^2 kWidth^2 / 12) = 2 % of them left. 3MFP at
// 6.6 A, N = 200 (s_c 1.7 A, map 1.5 A): bare 47 %; smoothed by s_c 51 % off all atoms, and as much off all atoms in any
// smoother map; by 1.5 s_c 64 % off all atoms, and 6 % off all atoms in a map smoothed by 1.1 s_c. On a synthetic chain of 800 atoms at 9 A the
// force of 25 and 50 vectors (runs of atoms) is off by 1.8 and 2.1 times as much as that of bare ones, of 200 and 400 by 0.37 and 0.2.
//
// Also possible, and not done: anisotropic second moments per vector need third derivatives of the map in the inner loop; weights
// fitted to the force of sampled poses fit only those poses, and cannot restore a width; levels of more vectors are what the
// knob offers anyway.
#include "ipc/scene/density/level_maps.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/scene/density/density_layout.hpp"
#include "ipc/scene/density/simulated_map.hpp"
#include "ipc/scene/density/smoothed_map.hpp"

namespace tact {

namespace {

constexpr double kWidth = 1.7;
constexpr double kNegligible = 0.12;     // smoothing, in widths of the map: less than 1 % of the force
constexpr double kNearlyEqual = 1.05;    // ratio of smoothings that share a map
constexpr double kVoxelsPerSigma = 0.9;  // four voxels per resolution, at 0.225 of it

double second_moment(const PointsView& p) {
    double sum = 0.0, weight = 0.0;
    Vec3 first = Vec3::Zero();
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec3 at(static_cast<double>(p.x[i]), static_cast<double>(p.y[i]), static_cast<double>(p.z[i]));
        const auto w = static_cast<double>(p.weight[i]);
        sum += w * at.squaredNorm(), first += w * at, weight += w;
    }
    return weight > 0.0 ? sum / weight - (first / weight).squaredNorm() : 0.0;
}

struct Rung {
    double smoothing_m;
    std::uint32_t every;
};

Rung rung_of(const DensityGrid& grid, double smoothing_m) {
    const double voxels = smoothing_m / (kVoxelsPerSigma * grid.spacing_m.maxCoeff());
    return {smoothing_m, static_cast<std::uint32_t>(std::max(1.0, std::floor(voxels)))};
}

// Of the coefficients, with the border of the smoothing and the padding.
std::size_t bytes_of(const DensityGrid& grid, const Rung& rung) {
    double count = 1.0;
    for (std::size_t a = 0; a < 3; ++a) {
        const double border = 3.0 * rung.smoothing_m / grid.spacing_m[static_cast<Eigen::Index>(a)];
        count *= (grid.size[a] + 2.0 * border) / rung.every + 2.0 * kDensityPad;
    }
    return static_cast<std::size_t>(count) * sizeof(float);
}

}  // namespace

double level_smoothing_m(const PointsView& level, const PointsView& atoms, double resolution_m) {
    const double cell_2 = (second_moment(atoms) - second_moment(level)) / 3.0;
    if (!(cell_2 > 0.0)) return 0.0;
    const double map_m = kSigmaPerResolution * std::max(resolution_m, 0.0);
    const double smoothing_m = std::sqrt(std::max(cell_2, kWidth * kWidth * cell_2 - map_m * map_m));
    return smoothing_m > kNegligible * map_m ? smoothing_m : 0.0;
}

std::vector<std::vector<double>> level_smoothings_m(std::span<const Structure> structures,
                                                    std::span<const Codebook> codebooks,
                                                    double resolution_m) {
    std::vector<std::vector<double>> out;
    for (std::size_t i = 0; i < structures.size() && i < codebooks.size(); ++i) {
        const Structure& s = structures[i];
        out.emplace_back();
        for (const Codebook::Level& level : codebooks[i].levels)
            out.back().push_back(
                level_smoothing_m(level.view(), {s.x_m, s.y_m, s.z_m, s.mass_fraction}, resolution_m));
    }
    return out;
}

LevelMaps make_level_maps(const DensityGrid& grid, double background, double sigma, double resolution_m,
                          const std::vector<std::vector<double>>& smoothing_m, std::size_t bytes_max) {
    std::vector<double> wanted_m;
    for (const auto& levels : smoothing_m)
        for (const double s : levels)
            if (s > kNegligible * kSigmaPerResolution * resolution_m) wanted_m.push_back(s);
    std::sort(wanted_m.begin(), wanted_m.end());
    std::vector<Rung> rungs;
    for (std::size_t i = 0; i < wanted_m.size();) {
        std::size_t end = i;
        double squares = 0.0;
        while (end < wanted_m.size() && wanted_m[end] <= kNearlyEqual * wanted_m[i]) {
            squares += wanted_m[end] * wanted_m[end];
            ++end;
        }
        rungs.push_back(rung_of(grid, std::sqrt(squares / static_cast<double>(end - i))));
        i = end;
    }
    LevelMaps out;
    out.maps.emplace_back(grid, background, sigma);
    out.smoothing_m.push_back(0.0);
    const auto too_large = [&] {
        std::size_t bytes = 0;
        for (const Rung& rung : rungs) bytes += bytes_of(grid, rung);
        return bytes > std::max(bytes_max, bytes_of(grid, {0.0, 1}));
    };
    while (rungs.size() > 1 && too_large()) {
        std::size_t nearest = 0;
        const auto ratio = [&](std::size_t i) { return rungs[i + 1].smoothing_m / rungs[i].smoothing_m; };
        for (std::size_t i = 1; i + 1 < rungs.size(); ++i)
            if (ratio(i) < ratio(nearest)) nearest = i;
        rungs.erase(rungs.begin() + static_cast<std::ptrdiff_t>(nearest));
    }
    for (const Rung& rung : rungs) {
        out.maps.emplace_back(smoothed_map(grid, background, rung.smoothing_m, rung.every), background,
                              sigma);
        out.smoothing_m.push_back(rung.smoothing_m);
    }
    // The nearest one; where maps were left out to save memory, a smoother one rather than a sharper one.
    for (const auto& levels : smoothing_m) {
        out.map_of.emplace_back();
        for (const double s : levels) {
            std::size_t map = 0;
            if (s > kNegligible * kSigmaPerResolution * resolution_m && out.maps.size() > 1) {
                map = 1;
                while (map + 1 < out.maps.size() && out.smoothing_m[map] * kNearlyEqual < s) ++map;
                const auto off = [&](std::size_t m) { return std::abs(std::log(out.smoothing_m[m] / s)); };
                if (map + 1 < out.maps.size() && off(map + 1) < off(map)) ++map;
            }
            out.map_of.back().push_back(map);
        }
    }
    return out;
}

}  // namespace tact
