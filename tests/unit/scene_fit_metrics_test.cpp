// Fit metrics against naive sums, and against cases with known results.
#include "ipc/scene/fit/fit_metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "ipc/base/error.hpp"

namespace tact::scene_fit_metrics_test {
namespace {

constexpr double kA = 1e-10;

Structure atoms(std::size_t count, unsigned seed) {
    Structure s;
    s.name = "cloud";
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0.0, 8.0 * kA);
    const std::array<std::uint8_t, 4> elements{6, 7, 8, 16};
    s.mass_u = 13.0 * static_cast<double>(count);
    for (std::size_t i = 0; i < count; ++i) {
        s.x_m.push_back(static_cast<float>(normal(random)));
        s.y_m.push_back(static_cast<float>(normal(random)));
        s.z_m.push_back(static_cast<float>(normal(random)));
        s.mass_fraction.push_back(1.0F / static_cast<float>(count));
        s.element.push_back(elements[i % 4]);
    }
    s.element[0] = 0;  // unknown element: weighted by its mass
    return s;
}

DensityGrid empty_grid() {
    DensityGrid grid;
    grid.size = {26, 24, 22};
    grid.origin_m = Vec3(-30 * kA, -28 * kA, -20 * kA);
    grid.spacing_m = Vec3(2.5 * kA, 2.4 * kA, 2.0 * kA);
    grid.values.assign(grid.count(), 0.0F);
    return grid;
}

// Every atom on every voxel, in double precision, without cut-off.
std::vector<double> slow_map(const DensityGrid& grid, const Structure& s, const Pose& pose,
                             double resolution_m) {
    std::vector<double> map(grid.count(), 0.0);
    const double sigma = 0.225 * resolution_m;
    for (std::uint32_t z = 0; z < grid.size[2]; ++z) {
        for (std::uint32_t y = 0; y < grid.size[1]; ++y) {
            for (std::uint32_t x = 0; x < grid.size[0]; ++x) {
                const Vec3 voxel = grid.origin_m + grid.spacing_m.cwiseProduct(Vec3(x, y, z));
                for (std::size_t i = 0; i < s.size(); ++i) {
                    const Vec3 atom =
                        pose * Vec3(static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]),
                                    static_cast<double>(s.z_m[i]));
                    const double weight = s.element[i] != 0 ? s.element[i] : 13.0;
                    map[(std::size_t{z} * grid.size[1] + y) * grid.size[0] + x] +=
                        weight * std::exp(-(voxel - atom).squaredNorm() / (2.0 * sigma * sigma));
                }
            }
        }
    }
    return map;
}

FitSettings settings_10a() {
    FitSettings settings;
    settings.resolution_m = 10.0 * kA;
    return settings;
}

FitMetrics fit(const DensityGrid& grid, const Structure& s, const Pose& pose, const FitSettings& settings) {
    const PlacedStructure placed{&s, pose};
    return fit_metrics(grid, {&placed, 1}, settings);
}

TEST(FitMetrics, agrees_with_the_naive_sums_within_one_percent) {
    const Structure s = atoms(60, 1);
    DensityGrid grid = empty_grid();
    std::mt19937 random(2);
    std::normal_distribution<float> noise(0.0F, 8.0F);
    const std::vector<double> truth = slow_map(grid, s, Pose{}, 10.0 * kA);
    for (std::size_t i = 0; i < truth.size(); ++i)
        grid.values[i] = static_cast<float>(truth[i]) + noise(random);
    const Pose pose{Vec3(4 * kA, -2 * kA, 3 * kA), quat_from_rotation_vector(Vec3(0.3, -0.2, 0.4))};
    const std::vector<double> simulated = slow_map(grid, s, pose, 10.0 * kA);
    const double most = *std::max_element(simulated.begin(), simulated.end());
    double n = 0, u = 0, v = 0, uu = 0, vv = 0, uv = 0;
    for (std::size_t i = 0; i < simulated.size(); ++i) {
        if (simulated[i] <= 0.05 * most) continue;
        const auto a = static_cast<double>(grid.values[i]);
        n += 1, u += a, v += simulated[i], uu += a * a, vv += simulated[i] * simulated[i],
            uv += a * simulated[i];
    }
    const FitMetrics result = fit(grid, s, pose, settings_10a());
    EXPECT_NEAR(result.cc_zero, uv / std::sqrt(uu * vv), 0.01);
    EXPECT_NEAR(result.cc_mean, (uv - u * v / n) / std::sqrt((uu - u * u / n) * (vv - v * v / n)), 0.01);
    EXPECT_NEAR(static_cast<double>(result.region_voxels), n, 0.01 * n);
    EXPECT_NEAR(result.overlap, uv, 0.01 * std::abs(uv));
}

TEST(FitMetrics, a_map_of_the_structure_itself_has_correlation_one) {
    const Structure s = atoms(60, 3);
    DensityGrid grid = empty_grid();
    const std::vector<double> truth = slow_map(grid, s, Pose{}, 10.0 * kA);
    for (std::size_t i = 0; i < truth.size(); ++i) grid.values[i] = static_cast<float>(5.0 + 0.1 * truth[i]);
    const FitMetrics result = fit(grid, s, Pose{}, settings_10a());
    EXPECT_NEAR(result.cc_mean, 1.0, 1e-3);  // invariant to offset and scale
    EXPECT_LT(result.cc_zero, 0.999);        // the correlation about zero is not
    EXPECT_GT(result.cc_zero, 0.8);
    EXPECT_LT(fit(grid, s, Pose{Vec3(8 * kA, 0, 0), Quat::Identity()}, settings_10a()).cc_mean, 0.8);
}

TEST(FitMetrics, several_bodies_are_simulated_together) {
    const Structure s = atoms(40, 4);
    const Pose left{Vec3(-9 * kA, 0, 0), Quat::Identity()}, right{Vec3(9 * kA, 0, 2 * kA), Quat::Identity()};
    DensityGrid grid = empty_grid();
    const std::vector<double> a = slow_map(grid, s, left, 10.0 * kA), b = slow_map(grid, s, right, 10.0 * kA);
    for (std::size_t i = 0; i < a.size(); ++i) grid.values[i] = static_cast<float>(a[i] + b[i]);
    const std::array<PlacedStructure, 2> placed{PlacedStructure{&s, left}, PlacedStructure{&s, right}};
    EXPECT_NEAR(fit_metrics(grid, placed, settings_10a()).cc_mean, 1.0, 1e-3);
}

TEST(FitMetrics, each_body_has_the_same_metrics_as_alone) {
    const Structure s = atoms(40, 8), other = atoms(25, 9);
    DensityGrid grid = empty_grid();
    std::mt19937 random(10);
    std::normal_distribution<float> noise(5.0F, 8.0F);
    for (float& v : grid.values) v = noise(random);
    const std::array<PlacedStructure, 3> placed{
        PlacedStructure{&s, {Vec3(-9 * kA, 0, 0), Quat::Identity()}},
        PlacedStructure{&other, {Vec3(9 * kA, 0, 2 * kA), Quat::Identity()}},
        PlacedStructure{&s, {Vec3(0, 1e-6, 0), Quat::Identity()}}};  // off the map
    FitSettings settings = settings_10a();
    settings.contour = 5.0;
    const FitOfBodies all = fit_of_bodies(grid, placed, settings);
    ASSERT_EQ(all.body.size(), 3U);
    double inside = 0.0, density = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const FitMetrics alone = fit_metrics(grid, {&placed[i], 1}, settings);
        EXPECT_EQ(all.body[i].cc_zero, alone.cc_zero);
        EXPECT_EQ(all.body[i].cc_mean, alone.cc_mean);
        EXPECT_EQ(all.body[i].overlap, alone.overlap);
        EXPECT_EQ(all.body[i].region_voxels, alone.region_voxels);
        EXPECT_EQ(all.body[i].mean_density, alone.mean_density);
        inside += alone.fraction_inside * static_cast<double>(alone.atoms);
        density += alone.mean_density * static_cast<double>(alone.atoms);
    }
    EXPECT_EQ(all.all.atoms, 105U);
    EXPECT_NEAR(all.all.fraction_inside, inside / 105.0, 1e-12);
    EXPECT_NEAR(all.all.mean_density, density / 105.0, 1e-9);
    EXPECT_EQ(all.body[2].region_voxels, 0U);
    EXPECT_EQ(all.body[2].cc_mean, 0.0);
}

TEST(FitMetrics, clashes_between_bodies_are_counted) {
    Structure s = atoms(2, 11);
    s.x_m = {0.0F, static_cast<float>(20.0 * kA)};
    s.y_m = s.z_m = {0.0F, 0.0F};
    s.element = {6, 6};
    const auto placed = [&](double x_a) {
        return PlacedStructure{&s, {Vec3(x_a * kA, 0, 0), Quat::Identity()}};
    };
    // Carbon radii are 1.7 A: pairs 2 A apart clash, pairs 3 A apart do not.
    const std::array<PlacedStructure, 3> three{placed(0.0), placed(2.0), placed(5.0)};
    const FitOfBodies fit = fit_of_bodies(empty_grid(), three, settings_10a());
    EXPECT_EQ(fit.all.clashes, 2U);
    EXPECT_EQ(fit.body[0].clashes, 2U);
    EXPECT_EQ(fit.body[1].clashes, 2U);
    EXPECT_EQ(fit.body[2].clashes, 0U);
}

TEST(FitMetrics, mean_density_and_fraction_inside_match_the_atoms) {
    DensityGrid grid = empty_grid();
    for (std::uint32_t z = 0; z < grid.size[2]; ++z) {
        for (std::uint32_t y = 0; y < grid.size[1]; ++y) {
            for (std::uint32_t x = 0; x < grid.size[0]; ++x) {  // linear: interpolated exactly
                grid.values[(std::size_t{z} * grid.size[1] + y) * grid.size[0] + x] = static_cast<float>(x);
            }
        }
    }
    Structure s = atoms(2, 5);
    s.x_m = {static_cast<float>(-2.5 * kA), static_cast<float>(5.0 * kA)};  // voxels 11 and 14
    s.y_m = s.z_m = {0.0F, 0.0F};
    s.mass_fraction = {0.25F, 0.75F};
    FitSettings settings = settings_10a();
    settings.background = 3.0;
    settings.sigma = 2.0;
    settings.contour = 12.0;
    const FitMetrics result = fit(grid, s, Pose{}, settings);
    EXPECT_NEAR(result.mean_density, 12.5, 1e-5);
    EXPECT_NEAR(result.mean_density_sigma, (12.5 - 3.0) / 2.0, 1e-5);
    EXPECT_EQ(result.atoms, 2U);
    EXPECT_EQ(result.fraction_inside, 0.5);
    settings.sigma = 0.0;  // uses the grid's own mean 12.5 and deviation sqrt((26^2 - 1) / 12)
    s.x_m[0] = s.x_m[1];
    EXPECT_NEAR(fit(grid, s, Pose{}, settings).mean_density_sigma, (14.0 - 12.5) / std::sqrt(675.0 / 12.0),
                1e-5);
}

TEST(FitMetrics, outside_the_map_the_fit_is_zero) {
    const Structure s = atoms(20, 6);
    DensityGrid grid = empty_grid();
    grid.values[500] = 1.0F;
    FitSettings settings = settings_10a();
    settings.sigma = 1.0;
    for (const double far : {1e-6, -1e300, std::nan(""), HUGE_VAL}) {
        const FitMetrics result = fit(grid, s, Pose{Vec3(0, far, 0), Quat::Identity()}, settings);
        EXPECT_EQ(result.region_voxels, 0U);
        EXPECT_EQ(result.cc_zero, 0.0);
        EXPECT_EQ(result.mean_density_sigma, 0.0);
        EXPECT_EQ(result.fraction_inside, 0.0);
    }
    EXPECT_EQ(fit_metrics(grid, {}, settings).region_voxels, 0U);
}

TEST(FitMetrics, an_unknown_resolution_is_refused) {
    const Structure s = atoms(3, 7);
    EXPECT_THROW(fit(empty_grid(), s, Pose{}, FitSettings{}), StartupError);
}

}  // namespace
}  // namespace tact::scene_fit_metrics_test
