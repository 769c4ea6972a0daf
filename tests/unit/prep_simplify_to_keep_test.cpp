#include "prep/mesh/simplify_to_keep.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ipc/scene/density/isosurface.hpp"
#include "prep/mesh/border_distance.hpp"
#include "prep/mesh/mesh_distance.hpp"
#include "prep/mesh/mesh_folds.hpp"
#include "tests/unit/prep_mesh_fixtures.hpp"

namespace tact::test::prep_simplify_to_keep_test {
namespace {

TEST(SimplifyToKeep, keeps_a_border_weight_that_no_other_beats_in_both_distances) {
    const TriangleMesh fine =
        sheet(14, [](float u, float v) { return 0.15F * std::sin(5.0F * u) * std::cos(4.0F * v); });
    for (const std::uint32_t n : {40U, 8U}) {
        const Kept best = simplify_to_keep(fine, {.vertices_min = n});
        EXPECT_EQ(count_folds(best.simplified.mesh), 0U);
        const double surface_m = two_sided(fine, best.simplified.mesh, 4000).rms_m;
        const double border_m = border_distance_rms_m(fine, best.simplified.mesh);
        bool tried = false;
        for (const double f : kWeightsTried) {
            const TriangleMesh other =
                simplify_to_keep(fine, {.vertices_min = n, .boundary_weight = f}).simplified.mesh;
            tried = tried || best.boundary_weight == f;
            const bool is_better = two_sided(fine, other, 4000).rms_m < 0.98 * surface_m &&
                                   border_distance_rms_m(fine, other) < 0.98 * border_m;
            EXPECT_FALSE(is_better) << n << " vertices, " << f << " instead of " << best.boundary_weight;
        }
        EXPECT_TRUE(tried);
    }
}

TEST(SimplifyToKeep, uses_the_default_weight_for_closed_meshes_or_the_given_one) {
    EXPECT_EQ(simplify_to_keep(isosurface(sampled(17, torus), -0.25), {.vertices_min = 50}).boundary_weight,
              100.0);
    const TriangleMesh open = sheet(8, [](float u, float) { return u * u; });
    EXPECT_EQ(simplify_to_keep(open, {.vertices_min = 20, .boundary_weight = 7.0}).boundary_weight, 7.0);
    TriangleMesh point = open;
    std::fill(point.position_m.begin(), point.position_m.end(), 1.0F);
    for (const float x : simplify_to_keep(point, {}).simplified.mesh.position_m) EXPECT_EQ(x, 1.0F);
}

TEST(BorderDistance, of_nested_squares_is_the_mean_over_both_borders) {
    const auto square = [](float from, float to) {
        TriangleMesh mesh;
        mesh.position_m = {from, from, 0, to, from, 0, to, to, 0, from, to, 0};
        mesh.triangle = {0, 1, 2, 0, 2, 3};
        return mesh;
    };
    // The inner border has distance d everywhere. So has the outer one, except for the last d before each corner, where the
    // nearest point is the inner corner: d^2 + s^2 for s from 0 to d, at both ends of each side.
    const double d = 0.1;
    const double outer = (4.0 * (1.0 - 2.0 * d) * d * d + 8.0 * (d * d * d + d * d * d / 3.0)) / 4.0;
    EXPECT_NEAR(border_distance_rms_m(square(0.0F, 1.0F), square(0.1F, 0.9F)),
                std::sqrt(0.5 * (d * d + outer)), 1e-4);
    EXPECT_EQ(border_distance_rms_m(square(0.0F, 1.0F), square(0.0F, 1.0F)), 0.0);
    EXPECT_EQ(border_distance_rms_m(isosurface(sampled(9, torus), -0.25), square(0.0F, 1.0F)), 0.0);
}

}  // namespace
}  // namespace tact::test::prep_simplify_to_keep_test
