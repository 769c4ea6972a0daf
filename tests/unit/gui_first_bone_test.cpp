// Where a line of sight first meets bone, against cubes and a fine march of its own.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "gui/drilling/first_bone.hpp"

namespace tact::gui_first_bone_test {
namespace {

struct Block {
    BoneBricks bricks;
    std::vector<std::uint8_t> density;
    BoneVolumeView volume;

    Block() {
        bricks.size = {40, 33, 27};
        bricks.voxel_m = 5e-4;
        bricks.origin_m = Vec3(-1e-3, 2e-3, 7e-3);
        density.assign(bricks.bytes(), 0);
        for (std::uint32_t z = 10; z < 20; ++z)
            for (std::uint32_t y = 8; y < 25; ++y)
                for (std::uint32_t x = 12; x < 30; ++x) density[bricks.voxel(x, y, z)] = 200;
        density[bricks.voxel(20, 15, 25)] = 100;  // too soft to be a surface
        volume.bricks = bricks;
        volume.density = density;
    }
    [[nodiscard]] Vec3 place(double x, double y, double z) const { return bricks.to_model(Vec3(x, y, z)); }
};

TEST(FirstBone, is_the_near_face_from_every_side) {
    const Block b;
    const struct {
        Vec3 from, to, face;
    } rows[] = {{{20, 15, 60}, {20, 15, 0}, {20, 15, 19.5}},  {{20, 15, -40}, {20, 15, 0}, {20, 15, 9.5}},
                {{-30, 15, 15}, {0, 15, 15}, {11.5, 15, 15}}, {{90, 15, 15}, {0, 15, 15}, {29.5, 15, 15}},
                {{20, -50, 15}, {20, 0, 15}, {20, 7.5, 15}},  {{20, 80, 15}, {20, 0, 15}, {20, 24.5, 15}},
                {{20, 15, 15}, {21, 15, 15}, {20, 15, 15}}};  // from within
    for (const auto& row : rows) {
        const Vec3 from = b.place(row.from.x(), row.from.y(), row.from.z());
        const Vec3 to = b.place(row.to.x(), row.to.y(), row.to.z());
        const auto found = first_bone(b.volume, from, to - from);
        ASSERT_TRUE(found.has_value());
        EXPECT_LT((*found - b.place(row.face.x(), row.face.y(), row.face.z())).norm(),
                  0.6 * b.bricks.voxel_m);
    }
}

TEST(FirstBone, there_is_none_where_the_line_misses_or_is_no_line) {
    const Block b;
    const Vec3 above = b.place(20, 15, 60), nan = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    EXPECT_FALSE(first_bone(b.volume, above, Vec3(0, 0, 1)).has_value());  // away from it
    EXPECT_FALSE(first_bone(b.volume, above, Vec3(1, 0, 0)).has_value());
    EXPECT_FALSE(first_bone(b.volume, b.place(2, 2, 60), Vec3(0, 0, -1)).has_value());  // beside it
    EXPECT_FALSE(first_bone(b.volume, above, Vec3::Zero()).has_value());
    EXPECT_FALSE(first_bone(b.volume, nan, Vec3(0, 0, -1)).has_value());
    EXPECT_FALSE(first_bone(b.volume, above, nan).has_value());
}

TEST(FirstBone, agrees_with_a_fine_march_on_random_lines) {
    const Block b;
    std::mt19937 random(4);
    std::uniform_real_distribution<double> of(-1.0, 1.0);
    int hits = 0;
    for (int i = 0; i < 500; ++i) {
        const Vec3 from = b.place(20 + 60 * of(random), 15 + 60 * of(random), 13 + 60 * of(random));
        const Vec3 way =
            (b.place(20 + 15 * of(random), 15 + 15 * of(random), 13 + 12 * of(random)) - from).normalized();
        const auto found = first_bone(b.volume, from, way);
        double first = -1.0;
        for (double t = 0.0; t < 0.08 && first < 0.0; t += 0.02 * b.bricks.voxel_m) {
            const Vec3 v = b.bricks.to_voxels(from + t * way);
            if (v.x() > 11.5 && v.x() < 29.5 && v.y() > 7.5 && v.y() < 24.5 && v.z() > 9.5 && v.z() < 19.5)
                first = t;
        }
        if (first < 0.0) {
            EXPECT_FALSE(found.has_value()) << i;
            continue;
        }
        // A line that only grazes an edge may pass between two steps.
        const Vec3 deeper = b.bricks.to_voxels(from + (first + 0.6 * b.bricks.voxel_m) * way);
        const bool grazes = !(deeper.x() > 11.5 && deeper.x() < 29.5 && deeper.y() > 7.5 &&
                              deeper.y() < 24.5 && deeper.z() > 9.5 && deeper.z() < 19.5);
        if (grazes && !found) continue;
        ASSERT_TRUE(found.has_value()) << i;
        ++hits;
        EXPECT_NEAR((*found - from).norm(), first, 0.6 * b.bricks.voxel_m) << i;
    }
    EXPECT_GT(hits, 200);
}

}  // namespace
}  // namespace tact::gui_first_bone_test
