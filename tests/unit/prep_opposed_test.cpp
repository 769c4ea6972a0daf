#include "prep/mesh/opposed.hpp"

#include <gtest/gtest.h>

namespace tact::test::prep_opposed_test {
namespace {

// Two squares, 0.5 apart, facing away from each other: upwards at z = 0.5 (vertices 0 to 3), downwards at z = 0 (4 to 7).
TriangleMesh plates() {
    TriangleMesh mesh;
    for (const float z : {0.5F, 0.0F})
        mesh.position_m.insert(mesh.position_m.end(), {0, 0, z, 1, 0, z, 1, 1, z, 0, 1, z});
    mesh.triangle = {0, 1, 2, 0, 2, 3, 4, 6, 5, 4, 7, 6};
    return mesh;
}

Opposed::Face face(const std::array<std::uint32_t, 3>& vertex, double z, bool up) {
    const Eigen::Vector3d a(0.2, 0.2, z), b(0.8, 0.2, z), c(0.8, 0.8, z);
    if (up) return {vertex, {a, b, c}};
    return {{vertex[0], vertex[2], vertex[1]}, {a, c, b}};
}

TEST(Opposed, is_zero_for_a_triangle_that_faces_as_its_part_does) {
    const TriangleMesh mesh = plates();
    Opposed opposed(mesh);
    EXPECT_EQ(opposed.opposed_m(face({0, 1, 2}, 0.5, true), 0.0), 0.0);
    EXPECT_EQ(opposed.opposed_m(face({0, 1, 2}, 0.6, true), 0.0), 0.0);
    EXPECT_EQ(opposed.opposed_m(face({4, 5, 6}, 0.0, false), 0.0), 0.0);
}

TEST(Opposed, has_no_limit_where_nothing_in_the_part_faces_its_way) {
    const TriangleMesh mesh = plates();
    Opposed opposed(mesh);
    EXPECT_GE(opposed.opposed_m(face({0, 1, 2}, 0.5, false), 0.0), Opposed::kNowhere - 1e20);
}

TEST(Opposed, is_the_additional_distance_to_what_faces_its_way_once_that_is_joined) {
    const TriangleMesh mesh = plates();
    Opposed opposed(mesh);
    opposed.join(0, 4);
    opposed.join(1, 5);
    opposed.join(2, 6);
    // 0.4 from the plate that faces down, 0.1 from the one that faces up
    EXPECT_NEAR(opposed.opposed_m(face({0, 1, 2}, 0.4, false), 0.0), 0.3, 1e-6);
    EXPECT_EQ(opposed.opposed_m(face({0, 1, 2}, 0.1, false), 0.0), 0.0);
    EXPECT_LE(opposed.opposed_m(face({0, 1, 2}, 0.4, false), 0.45), 0.45);
    opposed.join(2, 6);  // a second time parts them
    opposed.join(1, 5);
    opposed.join(0, 4);
    EXPECT_GE(opposed.opposed_m(face({0, 1, 2}, 0.4, false), 0.0), Opposed::kNowhere - 1e20);
}

}  // namespace
}  // namespace tact::test::prep_opposed_test
