// The bone in which a first contact is tried.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "rt/force/drilling/drill_model.hpp"
#include "rt/force/drilling/drill_rehearsal.hpp"
#include "rt/force/drilling/trial_bone.hpp"

namespace tact::force_drill_trial_test {
namespace {

constexpr double kVoxelM = 5e-4;

struct Volume {
    BoneBricks bricks;
    std::vector<std::uint8_t> density;
    Volume(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        bricks.size = {x, y, z};
        bricks.voxel_m = kVoxelM;
        density.assign(bricks.bytes(), 0);
    }
    std::uint8_t& at(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return density[bricks.voxel(x, y, z)];
    }
};

// A hill of porous bone, its top beside the middle.
Volume hill() {
    Volume v(90, 70, 60);
    std::mt19937 random(5);
    for (std::uint32_t z = 0; z < 60; ++z)
        for (std::uint32_t y = 0; y < 70; ++y)
            for (std::uint32_t x = 0; x < 90; ++x)
                if (std::hypot(x - 52.0, y - 30.0) < 50.0 - z) v.at(x, y, z) = random() % 3 == 0 ? 0 : 200;
    return v;
}

// Least distance of bone from the middle of a ball whose lowest point is at z.
double gap_m(const TrialBone& bone, double radius_m, double lowest_m) {
    double least = 1e9;
    const auto& n = bone.bricks.size;
    for (std::uint32_t z = 0; z < n[2]; ++z)
        for (std::uint32_t y = 0; y < n[1]; ++y)
            for (std::uint32_t x = 0; x < n[0]; ++x)
                if (bone.density[bone.bricks.voxel(x, y, z)] >= 128)
                    least = std::min(
                        least,
                        (bone.bricks.to_model(Vec3(x, y, z)) - Vec3(0.0, 0.0, lowest_m + radius_m)).norm());
    return least - radius_m;
}

TEST(TrialBone, a_ball_touches_it_at_the_height_of_zero) {
    const Volume from = hill();
    for (const double radius_m : {2e-3, 5e-3, 9e-3}) {
        for (const TrialBone& bone :
             {bone_of(from.bricks, from.density, radius_m, 4e-3, kVoxelM), solid_bone(radius_m, kVoxelM)}) {
            EXPECT_NEAR(gap_m(bone, radius_m, 0.0), 0.5 * kVoxelM, 0.3 * kVoxelM) << radius_m;
            EXPECT_LT(gap_m(bone, radius_m, -2.0 * kVoxelM), -0.5 * kVoxelM) << radius_m;
        }
    }
}

TEST(TrialBone, a_copy_holds_the_densities_about_the_burr) {
    Volume from = hill();
    const double radius_m = 6e-3, depth_m = 3e-3;
    const TrialBone bone = bone_of(from.bricks, from.density, radius_m, depth_m, kVoxelM);
    // Copies are whole bricks: the one shift under which all of it fits the volume.
    int fits = 0;
    Vec3 low_voxels = Vec3::Zero();
    for (std::uint32_t bz = 0; bz < 8; ++bz)
        for (std::uint32_t by = 0; by < 9; ++by)
            for (std::uint32_t bx = 0; bx < 12; ++bx) {
                bool same = true;
                for (std::uint32_t z = 0; same && z < bone.bricks.size[2]; ++z)
                    for (std::uint32_t y = 0; same && y < bone.bricks.size[1]; ++y)
                        for (std::uint32_t x = 0; same && x < bone.bricks.size[0]; ++x) {
                            const std::uint32_t sx = 8 * bx + x, sy = 8 * by + y, sz = 8 * bz + z;
                            const bool inside = sx < 90 && sy < 70 && sz < 60;
                            same = bone.density[bone.bricks.voxel(x, y, z)] ==
                                   (inside ? from.at(sx, sy, sz) : 0);
                        }
                if (!same) continue;
                ++fits;
                low_voxels = Vec3(8.0 * bx, 8.0 * by, 8.0 * bz);
            }
    ASSERT_EQ(fits, 1);
    // The column is the one of the middle brick; all that a burr reaches is inside, where the volume has it.
    const Vec3 touch = low_voxels - bone.bricks.origin_m / kVoxelM;
    EXPECT_NEAR(touch.x(), 44.0, 8.0);
    EXPECT_NEAR(touch.y(), 36.0, 8.0);
    for (int a = 0; a < 3; ++a) {
        const double reach = radius_m / kVoxelM, deep = a == 2 ? depth_m / kVoxelM : reach;
        EXPECT_LE(low_voxels[a], std::max(touch[a] - deep, 0.0)) << a;
        EXPECT_GE(low_voxels[a] + bone.bricks.size[static_cast<std::size_t>(a)],
                  std::min(touch[a] + reach, from.bricks.size[static_cast<std::size_t>(a)] - 1.0))
            << a;
    }
}

TEST(TrialBone, without_bone_in_the_volume_it_is_solid) {
    const Volume empty(40, 40, 40);
    const TrialBone bone = bone_of(empty.bricks, empty.density, 3e-3, 2e-3, kVoxelM);
    EXPECT_EQ(bone.density, solid_bone(3e-3, kVoxelM).density);
    EXPECT_EQ(bone.density[0], 255);
}

// There is less of it to cut.
TEST(TrialBone, a_contact_with_a_thin_shell_is_foreseen_to_cost_less_than_with_solid_bone) {
    Volume shell(128, 128, 96), solid(128, 128, 96);
    for (std::uint32_t z = 0; z < 80; ++z)
        for (std::uint32_t y = 0; y < 128; ++y)
            for (std::uint32_t x = 0; x < 128; ++x) {
                solid.at(x, y, z) = 255;
                shell.at(x, y, z) = z < 77 ? 0 : 255;
            }
    DrillSettings s;
    s.tool.radius_m = 20 * kVoxelM;
    s.tool.shaft_length_m = 5e-2;
    s.burr_rad_s = s.rate_at_rad_s;
    const auto bricks_cut = [&](const Volume& v) {
        double most = 0.0;
        for (const DrillWork& work : rehearse_drill(s, v.bricks, v.density, kVoxelM, 1e-3).contact)
            most = std::max(most, work.changed);
        return most;
    };
    const double of_solid = bricks_cut(solid);
    EXPECT_GT(of_solid, 10.0);
    EXPECT_LT(bricks_cut(shell), 0.8 * of_solid);
}

}  // namespace
}  // namespace tact::force_drill_trial_test
