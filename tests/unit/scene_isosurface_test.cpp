#include "ipc/scene/density/isosurface.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "ipc/base/error.hpp"
#include "tests/unit/prep_mesh_fixtures.hpp"

namespace tact::test::scene_isosurface_test {
namespace {

void expect_manifold(const TriangleMesh& mesh) {
    const Topology t = topology(mesh);
    EXPECT_EQ(t.tangled_edges, 0U);
    EXPECT_EQ(t.tangled_vertices, 0U);
    EXPECT_EQ(t.flat_triangles, 0U);
}

TEST(Isosurface, sphere_is_closed_with_outward_normals_and_the_right_size) {
    const TriangleMesh mesh = isosurface(sampled(41, sphere), -0.7);
    expect_manifold(mesh);
    EXPECT_EQ(topology(mesh).euler, 2);
    EXPECT_EQ(topology(mesh).border_edges, 0U);
    // Chords of voxels h = 0.05 lie inside the sphere by about h²/8r: 0.1 % of the radius.
    EXPECT_NEAR(area(mesh), 4.0 * std::numbers::pi * 0.49, 0.01 * 4.0 * std::numbers::pi * 0.49);
    EXPECT_NEAR(volume(mesh), 4.0 / 3.0 * std::numbers::pi * 0.343,
                0.006 * 4.0 / 3.0 * std::numbers::pi * 0.343);
    for (std::uint32_t v = 0; v < mesh.vertices(); ++v) EXPECT_NEAR(point(mesh, v).norm(), 0.7, 0.002);
}

TEST(Isosurface, torus_has_one_handle) {
    const TriangleMesh mesh = isosurface(sampled(49, torus), -0.25);
    expect_manifold(mesh);
    EXPECT_EQ(topology(mesh).euler, 0);
    EXPECT_EQ(topology(mesh).border_edges, 0U);
    const double exact = 2.0 * std::numbers::pi * std::numbers::pi * 0.6 * 0.25 * 0.25;
    EXPECT_NEAR(volume(mesh), exact, 0.02 * exact);
}

TEST(Isosurface, vertices_follow_anisotropic_voxels_and_the_origin) {
    DensityGrid grid;
    grid.size = {3, 4, 5};
    grid.origin_m = Vec3(10.0, 20.0, 30.0);
    grid.spacing_m = Vec3(0.5, 2.0, 4.0);
    for (int z = 0; z < 5; ++z) {
        for (int i = 0; i < 12; ++i) grid.values.push_back(static_cast<float>(-z));
    }
    const TriangleMesh mesh = isosurface(grid, -1.25);  // inside below z = 30 + 1.25 * 4
    ASSERT_EQ(mesh.vertices(), 12U);
    for (std::uint32_t v = 0; v < mesh.vertices(); ++v) EXPECT_FLOAT_EQ(mesh.position_m[3 * v + 2], 35.0F);
    EXPECT_DOUBLE_EQ(area(mesh), 1.0 * 6.0);
    for (std::size_t t = 0; t < mesh.triangles(); ++t) EXPECT_GT(double_area(mesh, t).z(), 0.0);
}

TEST(Isosurface, each_of_the_256_cells_is_a_manifold) {
    for (unsigned inside = 1; inside < 255; ++inside) {
        DensityGrid grid;
        grid.size = {4, 4, 4};
        grid.values.assign(64, -1.0F);  // padding closes the surface around the cell
        for (unsigned c = 0; c < 8; ++c) {
            if ((inside >> c & 1U) != 0)
                grid.values[((c >> 2U) + 1) * 16 + ((c >> 1U & 1U) + 1) * 4 + (c & 1U) + 1] = 1.0F;
        }
        const TriangleMesh mesh = isosurface(grid, 0.0);
        expect_manifold(mesh);
        EXPECT_EQ(topology(mesh).border_edges, 0U) << inside;
        EXPECT_GT(volume(mesh), 0.0) << inside;
    }
}

TEST(Isosurface, noise_gives_a_watertight_manifold) {
    std::mt19937 random(7);
    for (int round = 0; round < 20; ++round) {
        DensityGrid grid;
        grid.size = {12, 11, 10};
        for (std::size_t i = 0; i < grid.count(); ++i) {
            const std::size_t x = i % 12, y = i / 12 % 11, z = i / 132;
            const bool rim = x == 0 || y == 0 || z == 0 || x == 11 || y == 10 || z == 9;
            // Few distinct values put many samples exactly on the level.
            grid.values.push_back(rim ? -2.0F : static_cast<float>(static_cast<int>(random() % 5) - 2));
        }
        const TriangleMesh mesh = isosurface(grid, 0.0);
        expect_manifold(mesh);
        EXPECT_EQ(topology(mesh).border_edges, 0U);
        EXPECT_GT(volume(mesh), 0.0);
    }
}

TEST(Isosurface, stays_open_at_the_border_of_the_box) {
    const TriangleMesh mesh =
        isosurface(sampled(21, [](const Vec3& p) { return -p.z() - 0.2 * p.x(); }), 0.0123);
    expect_manifold(mesh);
    EXPECT_EQ(topology(mesh).euler, 1);  // a disk
    EXPECT_GT(topology(mesh).border_edges, 0U);
}

TEST(Isosurface, handles_non_finite_values_and_refuses_invalid_grids) {
    DensityGrid grid = sampled(9, sphere);
    std::mt19937 random(3);
    for (float& value : grid.values) {
        if (random() % 7 == 0) value = std::numeric_limits<float>::quiet_NaN();
        if (random() % 11 == 0) value = std::numeric_limits<float>::infinity();
        if (random() % 13 == 0) value = std::numeric_limits<float>::lowest();
    }
    const TriangleMesh mesh = isosurface(grid, -0.6);
    ASSERT_GT(mesh.triangles(), 0U);
    for (const float x : mesh.position_m) EXPECT_TRUE(std::isfinite(x) && std::abs(x) <= 1.0F);
    EXPECT_EQ(topology(mesh).tangled_edges, 0U);
    EXPECT_EQ(isosurface(sampled(9, sphere), 5.0).triangles(), 0U);
    EXPECT_THROW(isosurface(grid, std::nan("")), StartupError);
    grid.values.pop_back();
    EXPECT_THROW(isosurface(grid, -0.6), StartupError);
}

}  // namespace
}  // namespace tact::test::scene_isosurface_test
