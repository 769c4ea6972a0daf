// Fit metrics and refinement on published maps with their structures.
//
// The reference fit follows only the definitions: each atom is a sphere of 5 sigma, with one exponential per voxel,
// in double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ipc/scene/fit/fit_metrics.hpp"
#include "ipc/scene/fit/refine.hpp"
#include "prep/map/import_map.hpp"
#include "prep/map/map_statistics.hpp"
#include "prep/structure/import_structure.hpp"
#include "tests/unit/prep_samples.hpp"

namespace tact::scene_fit_real_test {
namespace {

struct Pair {
    const char* map;
    std::vector<const char*> structures;
    double resolution_a;
};

const std::vector<Pair>& pairs() {
    static const std::vector<Pair> all{
        {"emd_1080_groel_11.5A.mrc", {"1kp8A_fitted_in_emd_1080.pdb"}, 11.5},
        {"emd_5168_factin.map", {"3MFP.pdb"}, 6.6},
        {"emd_5168_factin.map", {"1J6Z_fitted_in_emd_5168.pdb"}, 6.6},
        {"emd_5778_monomer.situs.gz", {"emd_5778_native.pdb"}, 3.3},
        {"emd_5925_monomer.situs.gz", {"emd_5925_native.pdb"}, 4.0},
        {"sim_1oel_10A.mrc", {"1oel.pdb.gz"}, 10.0},
        {"sim_1z5s_20A.mrc", {"sim_1z5s.pdb"}, 20.0},
        {"sim_1gte_A_20A.mrc",
         {"sim_1gte_d1.pdb", "sim_1gte_d2.pdb", "sim_1gte_d3.pdb", "sim_1gte_d4.pdb", "sim_1gte_d5.pdb"},
         20.0},
        {"sim_2dqj_10A.mrc", {"sim_2dqj.pdb"}, 10.0},
        {"sim_1akeA_10A.mrc", {"sim_1akeA.pdb"}, 10.0},
    };
    return all;
}

Vec3 atom_m(const Structure& s, std::size_t i) {
    return {static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]), static_cast<double>(s.z_m[i])};
}

std::vector<double> naive_map(const DensityGrid& g, const std::vector<Structure>& structures,
                              const std::vector<Pose>& poses, double resolution_m) {
    std::vector<double> map(g.count(), 0.0);
    const double sigma = 0.225 * resolution_m;
    for (std::size_t b = 0; b < structures.size(); ++b) {
        for (std::size_t i = 0; i < structures[b].size(); ++i) {
            const Vec3 atom = poses[b] * atom_m(structures[b], i);
            int low[3], high[3];
            for (int a = 0; a < 3; ++a) {
                low[a] = std::max(
                    0, static_cast<int>(std::floor((atom[a] - 5 * sigma - g.origin_m[a]) / g.spacing_m[a])));
                high[a] = std::min(
                    static_cast<int>(g.size[static_cast<std::size_t>(a)]) - 1,
                    static_cast<int>(std::ceil((atom[a] + 5 * sigma - g.origin_m[a]) / g.spacing_m[a])));
            }
            for (int z = low[2]; z <= high[2]; ++z) {
                for (int y = low[1]; y <= high[1]; ++y) {
                    for (int x = low[0]; x <= high[0]; ++x) {
                        const Vec3 voxel = g.origin_m + g.spacing_m.cwiseProduct(Vec3(x, y, z));
                        const double d2 = (voxel - atom).squaredNorm() / (sigma * sigma);
                        if (d2 > 25.0) continue;
                        map[(static_cast<std::size_t>(z) * g.size[1] + static_cast<std::size_t>(y)) *
                                g.size[0] +
                            static_cast<std::size_t>(x)] += structures[b].element[i] * std::exp(-0.5 * d2);
                    }
                }
            }
        }
    }
    return map;
}

struct Naive {
    double cc_zero, cc_mean, overlap, mean_density, fraction_inside, region;
};

Naive naive_fit(const DensityGrid& g, const std::vector<Structure>& structures,
                const std::vector<Pose>& poses, double resolution_m, double contour, double background) {
    const std::vector<double> v = naive_map(g, structures, poses, resolution_m);
    const double most = *std::max_element(v.begin(), v.end());
    std::vector<std::size_t> region;
    for (std::size_t i = 0; i < v.size(); ++i)
        if (v[i] > 0.05 * most) region.push_back(i);
    const auto n = static_cast<double>(region.size());
    double mean_u = 0, mean_v = 0, uu = 0, vv = 0, uv = 0, du2 = 0, dv2 = 0, dudv = 0;
    for (const std::size_t i : region) {
        const auto u = static_cast<double>(g.values[i]);
        mean_u += u / n, mean_v += v[i] / n;
        uu += u * u, vv += v[i] * v[i], uv += u * v[i];
    }
    for (const std::size_t i : region) {
        const double du = static_cast<double>(g.values[i]) - mean_u, dv = v[i] - mean_v;
        du2 += du * du, dv2 += dv * dv, dudv += du * dv;
    }
    double density = 0, inside = 0, atoms = 0;
    for (std::size_t b = 0; b < structures.size(); ++b) {
        for (std::size_t i = 0; i < structures[b].size(); ++i) {
            const Vec3 at = (poses[b] * atom_m(structures[b], i) - g.origin_m).cwiseQuotient(g.spacing_m);
            double value = 0.0;
            for (int c = 0; c < 8; ++c) {
                double w = 1.0;
                bool in = true;
                std::uint32_t k[3] = {};
                for (int a = 0; a < 3; ++a) {
                    const double low = std::floor(at[a]), side = low + (c >> a & 1);
                    w *= (c >> a & 1) != 0 ? at[a] - low : 1.0 - (at[a] - low);
                    in = in && side >= 0.0 && side < g.size[static_cast<std::size_t>(a)];
                    k[a] = in ? static_cast<std::uint32_t>(side) : 0;
                }
                value += w * (in ? static_cast<double>(g.at(k[0], k[1], k[2])) : background);
            }
            density += value;
            inside += value > contour ? 1.0 : 0.0;
            atoms += 1.0;
        }
    }
    return {uv / std::sqrt(uu * vv), dudv / std::sqrt(du2 * dv2), uv, density / atoms, inside / atoms, n};
}

struct Loaded {
    DensityGrid grid;
    MapStatistics statistics;
    double contour = 0.0;
    std::vector<Structure> structures;
    std::vector<Pose> homes;
};

Loaded load(const std::filesystem::path& folder, const Pair& pair) {
    Loaded l;
    l.grid = import_map(folder / pair.map).grid;
    l.statistics = map_statistics(l.grid);
    l.contour = choose_contour(l.grid, l.statistics).level;
    for (const char* name : pair.structures) {
        l.structures.push_back(import_structure(folder / name).structure);
        l.homes.push_back(l.structures.back().home());
    }
    return l;
}

void expect_same(const FitMetrics& a, const Naive& b) {
    // A correlation near zero is a difference of large sums: the tolerance is 1 % of at least 0.1.
    EXPECT_NEAR(a.cc_zero, b.cc_zero, 0.01 * std::max(0.1, std::abs(b.cc_zero)));
    EXPECT_NEAR(a.cc_mean, b.cc_mean, 0.01 * std::max(0.1, std::abs(b.cc_mean)));
    EXPECT_NEAR(a.overlap, b.overlap, 0.01 * std::abs(b.overlap));
    EXPECT_NEAR(a.mean_density, b.mean_density, 0.01 * std::abs(b.mean_density));
    EXPECT_NEAR(a.fraction_inside, b.fraction_inside, 0.01 * b.fraction_inside);
    EXPECT_NEAR(static_cast<double>(a.region_voxels), b.region, 0.01 * b.region);
}

TEST(RealFit, metrics_match_the_definitions_within_one_percent) {
    const auto folder = sample::em_folder();
    if (folder.empty()) GTEST_SKIP() << "the folder of real data is absent (set TACT_SHARED)";
    for (const Pair& pair : pairs()) {
        SCOPED_TRACE(pair.structures.front());
        const Loaded l = load(folder, pair);
        const double resolution_m = pair.resolution_a * kAngstromM;
        FitSettings settings{.resolution_m = resolution_m,
                             .contour = l.contour,
                             .background = l.statistics.background,
                             .sigma = l.statistics.sigma};
        std::vector<PlacedStructure> placed;
        for (std::size_t i = 0; i < l.structures.size(); ++i)
            placed.push_back({&l.structures[i], l.homes[i]});
        const FitOfBodies fit = fit_of_bodies(l.grid, placed, settings);
        std::printf("%-32s cc zero %.4f, about mean %.4f, density %.2f sigma, inside %.3f\n",
                    pair.structures.front(), fit.all.cc_zero, fit.all.cc_mean, fit.all.mean_density_sigma,
                    fit.all.fraction_inside);
        expect_same(fit.all, naive_fit(l.grid, l.structures, l.homes, resolution_m, l.contour,
                                       l.statistics.background));
        if (l.structures.size() > 1)
            expect_same(fit.body[0], naive_fit(l.grid, {l.structures[0]}, {l.homes[0]}, resolution_m,
                                               l.contour, l.statistics.background));
        // Also away from its home, with up to half of it outside the box.
        const Pose away{l.homes[0].p_m + Vec3(14.0, -9.0, 4.0) * kAngstromM,
                        quat_from_rotation_vector(Vec3(0.4, 0.2, -0.3))};
        placed = {{&l.structures[0], away}};
        const FitMetrics moved = fit_metrics(l.grid, placed, settings);
        expect_same(moved, naive_fit(l.grid, {l.structures[0]}, {away}, resolution_m, l.contour,
                                     l.statistics.background));
        EXPECT_LT(moved.cc_mean, fit.body[0].cc_mean);
    }
}

TEST(RealFit, refinement_recovers_from_two_angstrom_and_ten_degrees) {
    const auto folder = sample::em_folder();
    if (folder.empty()) GTEST_SKIP() << "the folder of real data is absent (set TACT_SHARED)";
    for (const Pair& pair : pairs()) {
        SCOPED_TRACE(pair.structures.front());
        const Loaded l = load(folder, pair);
        const DensityMap map(l.grid, l.statistics.background, l.statistics.sigma);
        const Structure& s = l.structures.front();
        const Pose start{l.homes[0].p_m + Vec3(1.2, -1.2, 1.06) * kAngstromM,
                         quat_from_rotation_vector(10.0 * kDegreeRad * Vec3(2.0, 1.0, -2.0) / 3.0)};
        for (const RefineGoal goal : {RefineGoal::mean_density, RefineGoal::correlation_mean}) {
            RefineSettings settings;
            settings.goal = goal;
            settings.resolution_m = pair.resolution_a * kAngstromM;
            const RefineResult from_home = refine(map, s, l.homes[0], settings);
            const RefineResult r = refine(map, s, start, settings);
            const auto away = [&](const Pose& a, const Pose& b) {
                return std::pair((a.p_m - b.p_m).norm() / kAngstromM, a.q.angularDistance(b.q) / kDegreeRad);
            };
            const auto [d, angle] = away(r.T_model_body, from_home.T_model_body);
            // The nearest maximum to the home in the file, from either start.
            EXPECT_EQ(r.end, RefineEnd::converged);
            EXPECT_LT(d, 0.1);
            EXPECT_LT(angle, 0.1);
            EXPECT_GT(r.score, r.score_start);
            EXPECT_GE(from_home.score, from_home.score_start);
            std::printf("%-32s goal %d: %2u steps, %.4f -> %.4f; %.3f A, %.3f deg from the same maximum\n",
                        pair.structures.front(), static_cast<int>(goal), r.iterations, r.score_start, r.score,
                        d, angle);
        }
    }
}

}  // namespace
}  // namespace tact::scene_fit_real_test
