#include "prep/mesh/simplify.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "ipc/base/error.hpp"
#include "ipc/scene/density/isosurface.hpp"
#include "prep/mesh/progressive.hpp"
#include "prep/mesh/relax.hpp"
#include "prep/mesh/simplify_to_keep.hpp"
#include "tests/unit/prep_mesh_fixtures.hpp"

namespace tact::test::prep_simplify_test {
namespace {

// Loss at the outline: mean distance from a corner of the unit square to the nearest vertex.
double corner_loss(const TriangleMesh& mesh) {
    double sum = 0.0;
    for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0)}) {
        double nearest = 1e9;
        for (std::uint32_t v = 0; v < mesh.vertices(); ++v) {
            const Vec3 p = point(mesh, v);
            nearest = std::min(nearest, (Vec3(p.x(), p.y(), 0.0) - corner).norm());
        }
        sum += 0.25 * nearest;
    }
    return sum;
}

double flat_area(const TriangleMesh& mesh) {  // area of the projection on z = 0
    double sum = 0.0;
    for (std::size_t t = 0; t < mesh.triangles(); ++t) sum += 0.5 * double_area(mesh, t).z();
    return sum;
}

void expect_sound(const TriangleMesh& mesh) {
    const Topology t = topology(mesh);
    EXPECT_EQ(t.tangled_edges, 0U);
    EXPECT_EQ(t.tangled_vertices, 0U);
    EXPECT_EQ(t.flat_triangles, 0U);
}

TEST(Simplify, a_plane_loses_vertices_without_error) {
    const TriangleMesh flat = sheet(20, [](float u, float v) { return 0.5F * u - 0.25F * v; });
    const Simplified result = simplify(flat, {.vertices_min = 8});
    EXPECT_EQ(result.mesh.vertices(), 8U);
    expect_sound(result.mesh);
    for (std::uint32_t v = 0; v < result.mesh.vertices(); ++v) {
        const Vec3 p = point(result.mesh, v);
        EXPECT_NEAR(p.z(), 0.5 * p.x() - 0.25 * p.y(), 2e-6);
    }
    EXPECT_LT(result.contraction.back().error_m, 1e-4F);
    EXPECT_NEAR(flat_area(result.mesh), 1.0, 1e-3);
}

TEST(Simplify, edges_of_a_cube_are_kept) {
    // Six faces of 10 x 10 squares; the eight corners determine the whole shape.
    const DensityGrid grid = sampled(24, [](const Vec3& p) { return -p.cwiseAbs().maxCoeff(); });
    const TriangleMesh cube = isosurface(grid, -0.7);
    const TriangleMesh coarse = simplify(cube, {.vertices_min = 60}).mesh;
    EXPECT_EQ(coarse.vertices(), 60U);
    EXPECT_EQ(topology(coarse).euler, 2);
    EXPECT_NEAR(volume(coarse), volume(cube), 0.01 * volume(cube));
}

TEST(Simplify, a_sphere_keeps_its_volume_and_stays_close) {
    const TriangleMesh fine = isosurface(sampled(33, sphere), -0.7);
    const TriangleMesh coarse = simplify(fine, {.vertices_min = 100}).mesh;
    EXPECT_EQ(coarse.vertices(), 100U);
    expect_sound(coarse);
    EXPECT_EQ(topology(coarse).euler, 2);
    EXPECT_NEAR(volume(coarse), volume(fine), 0.005 * volume(fine));
    // 196 triangles on a sphere: sagitta about s²/(2 sqrt(3) r) with s² = 4 area / sqrt(3), so 3 to 5 % of r.
    for (std::uint32_t v = 0; v < coarse.vertices(); ++v) EXPECT_NEAR(point(coarse, v).norm(), 0.7, 0.035);
}

TEST(Simplify, border_planes_keep_the_border) {
    const TriangleMesh hill =
        sheet(24, [](float u, float v) { return 0.2F * std::sin(5.0F * u) * std::cos(4.0F * v); });
    const auto coarse = [&](double f, std::uint32_t n) {
        return simplify(hill, {.vertices_min = n, .boundary_weight = f}).mesh;
    };
    for (const double f : {SimplifySettings{}.boundary_weight, kPublishedBoundaryWeight}) {
        const TriangleMesh kept = coarse(f, 30);
        expect_sound(kept);
        EXPECT_EQ(topology(kept).euler, 1);
        EXPECT_LT(corner_loss(kept), 0.05) << f;
        EXPECT_GT(flat_area(kept), 0.97) << f;
    }
    const TriangleMesh lost = coarse(0.0, 30);
    EXPECT_GT(corner_loss(lost), 2.0 * corner_loss(coarse(kPublishedBoundaryWeight, 30)));
    EXPECT_LT(flat_area(lost), flat_area(coarse(kPublishedBoundaryWeight, 30)));
}

TEST(Simplify, topology_never_changes_at_any_level) {
    const TriangleMesh fine = isosurface(sampled(25, torus), -0.25);
    const Simplified result = simplify(fine, {.vertices_min = 0});
    expect_sound(result.mesh);
    EXPECT_EQ(topology(result.mesh).euler, 0);
    EXPECT_LT(result.mesh.vertices(), 40U);
    EXPECT_GE(result.mesh.vertices(), 7U);  // the minimum for a torus
}

TEST(Simplify, repeats_exactly_and_its_error_never_decreases) {
    const TriangleMesh fine = isosurface(sampled(25, torus), -0.25);
    const Simplified a = simplify(fine, {}), b = simplify(fine, {});
    ASSERT_EQ(a.contraction.size(), b.contraction.size());
    float error_m = 0.0F;
    for (std::size_t i = 0; i < a.contraction.size(); ++i) {
        EXPECT_EQ(a.contraction[i].kept, b.contraction[i].kept);
        EXPECT_EQ(a.contraction[i].gone, b.contraction[i].gone);
        EXPECT_EQ(a.contraction[i].position_m, b.contraction[i].position_m);
        EXPECT_GE(a.contraction[i].error_m, error_m);
        error_m = a.contraction[i].error_m;
    }
}

TEST(Simplify, the_result_does_not_depend_on_the_size_of_the_mesh) {
    const TriangleMesh metres = isosurface(sampled(17, torus), -0.25);
    TriangleMesh tiny = metres;
    for (float& x : tiny.position_m) x *= 1.1920929e-07F;  // 2^-23: exact
    const Simplified a = simplify(metres, {.vertices_min = 50}), b = simplify(tiny, {.vertices_min = 50});
    ASSERT_EQ(a.contraction.size(), b.contraction.size());
    for (std::size_t i = 0; i < a.contraction.size(); ++i)
        ASSERT_EQ(a.contraction[i].gone, b.contraction[i].gone) << i;
}

TEST(Simplify, any_triangle_soup_is_handled) {
    rc::check([] {
        TriangleMesh soup;
        const auto n = *rc::gen::inRange<std::uint32_t>(3, 30);
        soup.position_m = *rc::gen::container<std::vector<float>>(
            3 * n,
            rc::gen::map(rc::gen::inRange(-4, 5), [](int i) { return 0.25F * static_cast<float>(i); }));
        const auto t = *rc::gen::inRange<std::size_t>(0, 80);
        soup.triangle = *rc::gen::container<std::vector<std::uint32_t>>(3 * t, rc::gen::inRange(0U, n));
        const SimplifySettings settings{.pair_distance = *rc::gen::element(0.0, 0.5, 3.0)};
        Simplified direct = simplify(soup, settings);
        relax(soup, direct, 1);
        for (const float x : direct.mesh.position_m) RC_ASSERT(std::isfinite(x));
        if (n % 8 == 0) {  // takes many iterations
            const Kept kept = simplify_to_keep(soup, {.pair_distance = settings.pair_distance});
            for (const float x : kept.simplified.mesh.position_m) RC_ASSERT(std::isfinite(x));
        }
        if (cleaned(soup).triangles() == 0) return;
        // The bake checks every level for triangles with equal corners.
        const ProgressiveMesh baked(make_progressive(soup, settings));
        RC_ASSERT(baked.vertices() == cleaned(soup).vertices());
    });
}

TEST(Simplify, refuses_invalid_meshes) {
    TriangleMesh bad = sheet(3, [](float, float) { return 0.0F; });
    bad.triangle[4] = 99;
    EXPECT_THROW(simplify(bad, {}), StartupError);
    EXPECT_THROW(make_progressive(bad), StartupError);
    bad = sheet(3, [](float, float) { return std::nanf(""); });
    EXPECT_THROW(simplify(bad, {}), StartupError);
    EXPECT_THROW(make_progressive(TriangleMesh{}), StartupError);
}

TEST(Simplify, can_be_cancelled) {
    const TriangleMesh fine = sheet(20, [](float u, float) { return u * u; });
    EXPECT_THROW(simplify(fine, {}, [](double, const char*) { return false; }), Cancelled);
}

}  // namespace
}  // namespace tact::test::prep_simplify_test
