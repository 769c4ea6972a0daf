// Contour levels and fractions, and the file with a surface at another level.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "ipc/base/error.hpp"
#include "ipc/scene/density/contour_mesh.hpp"
#include "ipc/scene/density/contour_scale.hpp"
#include "tests/unit/prep_mesh_fixtures.hpp"

namespace tact::test::scene_contour_test {
namespace {

TEST(ContourScale, fractions_match_counted_voxels) {
    DensityGrid grid;
    grid.size = {40, 30, 20};
    grid.spacing_m = Vec3(1e-10, 2e-10, 3e-10);
    std::mt19937 random(3);
    std::lognormal_distribution<float> value(0.0F, 0.6F);
    for (std::size_t i = 0; i < grid.count(); ++i) grid.values.push_back(value(random));
    const ContourScale scale(grid, 1.2, 0.5);
    for (const double level : {-1.0, 0.2, 0.7, 1.0, 1.9, 3.3, 100.0}) {
        std::size_t above = 0;
        for (const float v : grid.values) above += static_cast<double>(v) > level ? 1U : 0U;
        const double expected = static_cast<double>(above) / static_cast<double>(grid.count());
        EXPECT_NEAR(scale.fraction_inside(level), expected, 2e-3) << level;
        EXPECT_NEAR(scale.volume_m3(level), expected * 24000.0 * 6e-30, 24000.0 * 6e-30 * 2e-3);
    }
    EXPECT_DOUBLE_EQ(scale.sigma_of(2.2), 2.0);
    EXPECT_DOUBLE_EQ(scale.level_of_sigma(2.0), 2.2);
}

TEST(ContourScale, level_and_fraction_are_inverse) {
    const DensityGrid grid = sampled(25, [](const Vec3& p) { return -p.norm(); });
    const ContourScale scale(grid, 0.0, 1.0);
    double last = INFINITY;
    for (double fraction = 0.0; fraction <= 1.0; fraction += 0.01) {
        const double level = scale.level_of_fraction(fraction);
        EXPECT_LE(level, last);
        last = level;
        EXPECT_NEAR(scale.fraction_inside(level), fraction, 1e-3);
    }
    // A ball of radius 1/2 in a cube of side 2; the outermost samples add half a voxel.
    const double ball = std::numbers::pi / 6.0 / std::pow(2.0 + 2.0 / 24.0, 3);
    EXPECT_NEAR(scale.fraction_inside(-0.5), ball, 0.05 * ball);
}

TEST(ContourScale, histograms_hold_every_voxel_once) {
    const DensityGrid grid = sampled(17, [](const Vec3& p) { return p.x() * p.y() + p.z(); });
    const ContourScale scale(grid, 0.0, 1.0);
    for (const std::size_t bins : {std::size_t{1}, std::size_t{128}, ContourScale::kBins}) {
        std::uint64_t sum = 0;
        for (const std::uint64_t n : scale.histogram(bins)) sum += n;
        EXPECT_EQ(sum, grid.count());
    }
}

TEST(ContourScale, bad_maps_give_zeros) {
    DensityGrid grid;
    EXPECT_EQ(ContourScale(grid, 0.0, 1.0).fraction_inside(0.5), 0.0);
    EXPECT_EQ(ContourScale().level_of_fraction(0.5), 0.0);
    grid.size = {2, 2, 2};
    grid.values.assign(8, 4.0F);  // constant
    const ContourScale flat(grid, 4.0, 0.0);
    EXPECT_EQ(flat.fraction_inside(3.0), 1.0);
    EXPECT_EQ(flat.fraction_inside(4.0), 0.0);
    EXPECT_EQ(flat.sigma_of(9.0), 0.0);
    EXPECT_EQ(flat.level_of_fraction(0.5), 4.0);
    grid.values.assign(8, NAN);
    grid.values[3] = 1.0F;
    EXPECT_EQ(ContourScale(grid, 0.0, 1.0).voxels(), 1U);
}

ProgressiveMeshData triangle() {
    ProgressiveMeshData mesh;
    mesh.base_vertices = 3;
    mesh.vertex = {{{0.0F, 0.0F, 0.0F}, {0, 0, 32767, 0}},
                   {{1.0F, 0.0F, 0.0F}, {0, 0, 32767, 0}},
                   {{0.0F, 1.0F, 0.0F}, {0, 0, 32767, 0}}};
    mesh.error_m = {0.0F};
    mesh.triangle = {0, 1, 2};
    mesh.triangle_count = {1};
    return mesh;
}

TEST(ContourMesh, reads_back_and_is_refused_for_another_scene_or_level) {
    SceneWriter out;
    write_contour(out, {77, 0.25}, triangle());
    const auto bytes = out.to_bytes();
    const SceneFile file = SceneFile::from_bytes(bytes, "c.tact");
    EXPECT_EQ(read_contour(file, {77, 0.25})->vertices(), 3U);
    EXPECT_THROW((void)read_contour(file, {78, 0.25}), StartupError);
    EXPECT_THROW((void)read_contour(file, {77, 0.26}), StartupError);
    SceneWriter other;
    write_mesh(other, 0, triangle());
    const auto none = other.to_bytes();
    EXPECT_THROW((void)read_contour(SceneFile::from_bytes(none, "m.tact"), {77, 0.25}), StartupError);
}

}  // namespace
}  // namespace tact::test::scene_contour_test
