// Octree, voxel sums in a ball, forces of a burr at rest and in rotation, burr shapes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "ipc/base/error.hpp"
#include "ipc/base/random.hpp"
#include "rt/force/drilling/ball_moments.hpp"
#include "rt/force/drilling/burr_forces.hpp"
#include "rt/force/drilling/burr_shapes.hpp"
#include "tests/support/bone_block.hpp"

namespace tact::force_bone_test {
namespace {

constexpr double kPi = std::numbers::pi;

// Bone below the plane through `middle`; the density ramps from 1 to 0 across it.
auto half_space(const Vec3& middle, const Vec3& up) {
    return [=](const Vec3& p) { return std::clamp(0.5 - 3.0 * (p - middle).dot(up), 0.0, 1.0); };
}

BallMoments slow_moments(const BoneBlock& bone, const Vec3& about, std::uint32_t first[3],
                         std::uint32_t edge) {
    BallMoments sums;
    const auto& size = bone.bricks.size;
    for (std::uint32_t z = first[2]; z < std::min(first[2] + edge, size[2]); ++z) {
        for (std::uint32_t y = first[1]; y < std::min(first[1] + edge, size[1]); ++y) {
            for (std::uint32_t x = first[0]; x < std::min(first[0] + edge, size[0]); ++x) {
                const double level = bone.density[bone.bricks.voxel(x, y, z)];
                sums.m0 += level;
                sums.m1 += level * (Vec3(x, y, z) - about);
            }
        }
    }
    return sums;
}

BoneBlock noise(std::uint32_t edge, std::uint64_t seed) {
    SeededRandom random(seed);
    return BoneBlock(
        edge, 1e-3, [&](const Vec3&) { return std::max(0.0, 1.6 * random.uniform() - 0.6); }, 1);
}

void expect_octree_is_right(const BoneBlock& bone, const MomentOctree& octree) {
    for (std::uint32_t level = 0; level < octree.levels(); ++level) {
        const auto& n = octree.blocks(level);
        const std::uint32_t edge = 8U << level;
        for (std::uint32_t z = 0; z < n[2]; ++z) {
            for (std::uint32_t y = 0; y < n[1]; ++y) {
                for (std::uint32_t x = 0; x < n[0]; ++x) {
                    std::uint32_t first[3] = {x * edge, y * edge, z * edge};
                    const Vec3 centre = Vec3(first[0], first[1], first[2]) + Vec3::Constant(0.5 * edge - 0.5);
                    const BallMoments right = slow_moments(bone, centre, first, edge);
                    const std::size_t i = octree.index(level, x, y, z);
                    BlockMoments is;
                    if (level > 0) {
                        is = octree.block(level, i);
                    } else {
                        const MomentOctree::Brick& b = octree.brick(i);
                        is = {b.m0, {b.m1[0], b.m1[1], b.m1[2]}};
                    }
                    ASSERT_EQ(static_cast<double>(is.m0), right.m0);
                    for (int a = 0; a < 3; ++a)
                        ASSERT_EQ(static_cast<double>(is.m1[static_cast<std::size_t>(a)]), 2.0 * right.m1[a]);
                    if (level > 0) continue;
                    for (std::uint32_t k = 0; k < 8; ++k) {
                        std::uint32_t corner[3] = {first[0] + 4 * (k & 1U), first[1] + 4 * (k >> 1U & 1U),
                                                   first[2] + 4 * (k >> 2U)};
                        const BallMoments part = slow_moments(
                            bone, Vec3(corner[0], corner[1], corner[2]) + Vec3::Constant(1.5), corner, 4);
                        ASSERT_EQ(octree.parts(i).m0[k], part.m0);
                        for (std::size_t a = 0; a < 3; ++a)
                            ASSERT_EQ(octree.parts(i).m1[a][k], 2.0 * part.m1[static_cast<int>(a)]);
                    }
                }
            }
        }
    }
}

TEST(MomentOctree, every_block_holds_the_sums_of_its_voxels) {
    for (const std::uint32_t edge : {1U, 8U, 21U, 40U}) {
        const BoneBlock bone = noise(edge, edge);
        expect_octree_is_right(bone, MomentOctree(bone.bricks, bone.density));
    }
    BoneBlock solid(
        24, 1e-3, [](const Vec3&) { return 1.0; }, 1);  // the largest possible sums
    expect_octree_is_right(solid, MomentOctree(solid.bricks, solid.density));
}

TEST(MomentOctree, removed_mass_updates_every_octree_level_exactly) {
    BoneBlock bone = noise(40, 3);
    MomentOctree octree(bone.bricks, bone.density);
    SeededRandom random(1);
    for (int i = 0; i < 300; ++i) {
        const auto place = [&] { return static_cast<std::uint32_t>(random.below(40)); };
        const std::uint32_t x = place(), y = place(), z = place();
        std::uint8_t& level = bone.density[bone.bricks.voxel(x, y, z)];
        const int before = level;
        level = static_cast<std::uint8_t>(random.below(256));
        EXPECT_EQ(octree.refresh(x / 8, y / 8, z / 8).m0, before - level);
    }
    expect_octree_is_right(bone, octree);
}

TEST(MomentOctree, refuses_data_of_the_wrong_size) {
    BoneBlock bone = noise(16, 1);
    const auto refused = [&](const auto& spoil) {
        BoneBricks b = bone.bricks;
        spoil(b);
        EXPECT_THROW(MomentOctree(b, bone.density), StartupError);
    };
    refused([](BoneBricks& b) { b.size[1] = 17; });
    refused([](BoneBricks& b) { b.size[2] = 0; });
    refused([](BoneBricks& b) { b.size = {0xFFFFFFFFU, 0xFFFFFFFFU, 0xFFFFFFFFU}; });
    refused([](BoneBricks& b) { b.voxel_m = 0.0; });
    refused([](BoneBricks& b) { b.voxel_m = std::nan(""); });
    refused([](BoneBricks& b) { b.origin_m.x() = std::nan(""); });
}

// Sum of the voxel levels in a ball cap of height h.
double cap_m0(double r, double h) { return 255.0 * kPi * h * h * (r - h / 3.0); }
double cap_m1(double r, double h) { return 255.0 * kPi / 4.0 * h * h * (2.0 * r - h) * (2.0 * r - h); }

TEST(BallMoments, match_half_space_slab_and_ball) {
    const double r = 10.0;
    const auto check = [&](const BoneBlock& bone, const Vec3& at, double m0, const Vec3& m1, double part) {
        const MomentOctree octree(bone.bricks, bone.density);
        const BallMoments exact = ball_moments_exact(octree, at, r),
                          fast = ball_moments(octree, best_brick_kernels(), at, r, 0.1 * r);
        EXPECT_NEAR(exact.m0, m0, 0.01 * m0);
        EXPECT_NEAR(fast.m0, m0, part * m0);
        const double moment = std::max(m1.norm(), 0.02 * m0 * r);
        EXPECT_LT((exact.m1 - m1).norm(), 0.01 * moment);
        EXPECT_LT((fast.m1 - m1).norm(), part * moment);
    };
    const Vec3 at(23.3, 23.7, 30.0);
    for (const double h : {1.0, 2.0, 4.5, 10.0, 17.0}) {  // the plane lies between two voxel layers
        const double top = std::floor(at.z() - r + h) + 0.5, height = top - (at.z() - r);
        const BoneBlock half(48, 1e-3, [&](const Vec3& p) { return p.z() < top ? 1.0 : 0.0; });
        check(half, at, cap_m0(r, height), Vec3(0.0, 0.0, -cap_m1(r, height)), 0.02);
        const double bottom = top - 3.0, lower = std::max(0.0, height - 3.0);
        const BoneBlock slab(48, 1e-3,
                             [&](const Vec3& p) { return p.z() < top && p.z() > bottom ? 1.0 : 0.0; });
        check(slab, at, cap_m0(r, height) - cap_m0(r, lower),
              Vec3(0.0, 0.0, -cap_m1(r, height) + cap_m1(r, lower)), 0.02);
    }
    const double small = 4.0;
    const Vec3 off(3.0, -2.0, 1.5);
    const BoneBlock ball(
        48, 1e-3, [&](const Vec3& p) { return (p - at - off).norm() < small ? 1.0 : 0.0; }, 5);
    const double mass = 255.0 * 4.0 / 3.0 * kPi * small * small * small;
    check(ball, at, mass, mass * off, 0.02);
    const BoneBlock full(
        48, 1e-3, [](const Vec3&) { return 1.0; }, 1);
    check(full, at, 255.0 * 4.0 / 3.0 * kPi * r * r * r, Vec3::Zero(), 0.005);
}

struct Errors {
    double mean = 0.0, worst = 0.0, angle = 0.0;
};

// Errors of the elastic force against single resolution, for two radii (voxels) and depths from 0.1 R.
Errors force_errors(double level) {
    Errors e;
    int count = 0;
    SeededRandom random(7);
    for (const double r : {10.0 / 3.0, 50.0 / 3.0}) {  // 1 and 5 mm at 0.3 mm
        const auto edge = static_cast<std::uint32_t>(3.2 * r + 12.0);
        for (int shape = 0; shape < 3; ++shape) {
            const Vec3 up = random.direction(),
                       middle = Vec3::Constant(0.5 * edge) + 0.4 * random.direction();
            const auto flat = half_space(middle, up);
            const BoneBlock bone(
                edge, 3e-4,
                [&](const Vec3& p) {
                    double solid = flat(p);
                    if (shape == 1)  // trabecular
                        solid *= 0.45 + 0.3 * std::sin(5.0 * p.x() / r) * std::sin(4.0 * p.y() / r) *
                                            std::sin(4.5 * p.z() / r);
                    if (shape == 2)  // in the crater of an earlier stroke
                        solid = std::min(solid, (p - middle - 0.6 * r * up).norm() > r ? 1.0 : 0.0);
                    return solid;
                },
                2);
            const MomentOctree octree(bone.bricks, bone.density);
            for (const double depth : {0.1, 0.2, 0.35, 0.5, 0.8}) {
                const Vec3 at = middle + (1.0 - depth - (shape == 2 ? 0.4 : 0.0)) * r * up;
                const BallMoments exact = ball_moments_exact(octree, at, r, r < 5.0 ? 6 : 4),
                                  fast = ball_moments(octree, best_brick_kernels(), at, r, level * r);
                const auto force = [&](const BallMoments& m) {
                    return burr_force({}, r, m.m0 / 255.0, m.m1 / 255.0, Vec3::Zero(), Vec3::Zero())
                        .wrench.force_n;
                };
                const double error = (force(fast).norm() - force(exact).norm()) / force(exact).norm();
                e.mean += std::abs(error);
                e.worst = std::max(e.worst, std::abs(error));
                e.angle = std::max(e.angle,
                                   std::acos(std::min(1.0, fast.m1.normalized().dot(exact.m1.normalized()))));
                ++count;
            }
        }
    }
    e.mean /= count;
    return e;
}

TEST(BallMoments, the_force_matches_single_resolution_within_two_percent_at_the_default_level) {
    const Errors fine = force_errors(0.1), usual = force_errors(0.3), coarse = force_errors(0.5);
    EXPECT_LT(fine.mean, 0.01);
    EXPECT_LT(usual.mean, 0.02);
    EXPECT_LT(usual.worst, 0.05);
    EXPECT_LT(usual.angle, 0.05);
    EXPECT_LT(coarse.mean, 0.05);
    EXPECT_LE(fine.mean, usual.mean);
    EXPECT_LE(usual.mean, coarse.mean);
}

TEST(BallMoments, are_continuous_in_position_and_level) {
    const double r = 14.0;
    const BoneBlock bone(64, 1e-3, half_space(Vec3(31.2, 32.3, 32.8), Vec3(0.36, 0.48, 0.8)), 2);
    const MomentOctree octree(bone.bricks, bone.density);
    const BrickKernels& kernels = best_brick_kernels();
    const auto depth = [&](const Vec3& at, double level) {
        return penetration_of(ball_moments(octree, kernels, at, r, level * r).m0 / 255.0, r);
    };
    // Steps of a thousandth of a voxel: 0.3 um at 0.3 mm. The depth may change by that step plus rounding.
    const Vec3 way = Vec3(0.6, 0.0, 0.8);
    for (const double level : {0.1, 0.3, 0.5}) {
        for (int piece = 0; piece < 12; ++piece) {
            double before = -1.0;
            for (int i = 0; i < 60; ++i) {
                const Vec3 at = Vec3(30.0, 33.0, 42.0) + (0.37 * piece + 1e-3 * i) * way;
                const double now = depth(at, level);
                if (before >= 0.0) {
                    EXPECT_LT(std::abs(now - before) * r, 4e-3);
                }
                before = now;
            }
        }
    }
    double before = depth(Vec3(30.0, 33.0, 42.0), 0.07);
    for (double level = 0.07; level < 0.55; level += 5e-4) {
        const double now = depth(Vec3(30.0, 33.0, 42.0), level);
        EXPECT_LT(std::abs(now - before), 2e-3) << level;
        before = now;
    }
}

TEST(BrickKernels, all_instruction_sets_give_the_same_bits) {
    SeededRandom random(11);
    const BoneBlock bone = noise(40, 8);
    const auto spread = [&](double size) {
        return static_cast<float>(size * (2.0 * random.uniform() - 1.0));
    };
    for (int i = 0; i < 400; ++i) {
        const std::uint8_t* voxels =
            bone.density.data() + BoneBricks::kVoxels * random.below(bone.bricks.brick_count());
        const float r = 2.0F + 30.0F * static_cast<float>(random.uniform());
        const SumJob sum{
            {spread(r) - 3.5F, spread(r) - 3.5F, spread(r) - 3.5F}, r * r - 1.0F / 12, 0.77F / r};
        const float way = i % 3 == 0 ? 0.0F : i % 3 == 1 ? 0.1F : 2.0F * r;
        const ErodeJob erode{{sum.first[0], sum.first[1], sum.first[2]},
                             {spread(way), spread(way), spread(way)},
                             1.0F / (r * r),
                             static_cast<float>(std::pow(10.0, 4.0 * random.uniform() - 3.0)),
                             1.0F,
                             i % 2 == 0 ? 0.0F : 0.008F,
                             static_cast<std::uint32_t>(random.next())};
        CutBlocks cut{};
        for (std::size_t k = 0; k < kCuts; ++k) {
            for (auto& axis : cut.centre) axis[k] = spread(r);
            for (auto& axis : cut.m1) axis[k] = spread(1e4);
            cut.edge[k] = static_cast<float>(4 << (k % 3));
            cut.limit[k] = r;
            cut.m0[k] = 1e4F;
        }
        BrickSums sums_of_first{};
        CutBlocks cut_of_first{};
        std::vector<std::uint8_t> left_of_first;
        for (std::size_t k = 0; k < kBrickKernelCount; ++k) {
            const BrickKernels& kernels = kBrickKernels[k];
            if (!kernels.runs_here()) continue;
            BrickSums sums;
            kernels.sum(sum, voxels, sums);
            CutBlocks cuts = cut;
            kernels.cut(cuts);
            std::vector<std::uint8_t> left(voxels, voxels + BoneBricks::kVoxels);
            const std::uint32_t taken = kernels.erode(erode, left.data());
            std::uint32_t gone = 0;
            for (std::size_t v = 0; v < left.size(); ++v)
                gone += voxels[v] - static_cast<std::uint32_t>(left[v]);
            EXPECT_EQ(taken, gone) << kernels.name;
            if (left_of_first.empty()) {
                sums_of_first = sums;
                cut_of_first = cuts;
                left_of_first = left;
            }
            EXPECT_EQ(std::memcmp(&sums, &sums_of_first, sizeof sums), 0) << kernels.name;
            EXPECT_EQ(std::memcmp(&cuts, &cut_of_first, sizeof cuts), 0) << kernels.name;
            EXPECT_EQ(left, left_of_first) << kernels.name;
        }
    }
}

TEST(BurrForces, penetration_solves_its_equation) {
    double before = 0.0;
    for (double x = 1e-7; x <= 2.0; x *= 1.07) {
        const double r = 3e-3, m0 = kPi * r * r * r * x * x * (1.0 - x / 3.0);
        const double found = penetration_of(m0, r);
        EXPECT_NEAR(found, x, 1e-7 * x);
        EXPECT_GT(found, before);
        before = found;
    }
    EXPECT_EQ(penetration_of(0.0, 1e-3), 0.0);
    EXPECT_EQ(penetration_of(std::nan(""), 1e-3), 0.0);
    EXPECT_NEAR(penetration_of(4.0 / 3.0 * kPi * 1e-9, 1e-3), 2.0, 1e-7);
    EXPECT_LE(penetration_of(1.0, 1e-3), 2.0);  // more than a full ball
}

TEST(BurrForces, follow_their_equations_on_a_flat_surface) {
    BurrLaw law;
    law.friction_share = 0.0;
    const double r = 3e-3;
    for (const double x : {0.01, 0.1, 0.5, 1.0}) {
        const double h = x * r, m0 = kPi * h * h * (r - h / 3.0),
                     m1 = kPi / 4.0 * h * h * (2.0 * r - h) * (2.0 * r - h);
        const Vec3 spin(0.0, 3000.0, 0.0), velocity(0.01, 0.02, -0.03);
        const BurrForce still = burr_force(law, r, m0, Vec3(0.0, 0.0, -m1), Vec3::Zero(), Vec3::Zero());
        EXPECT_NEAR(still.wrench.force_n.z(), law.elastic_pa * r * r * std::pow(x, 1.5),
                    1e-6 * still.wrench.force_n.z());
        EXPECT_NEAR(still.normal.z(), 1.0, 1e-9);
        EXPECT_EQ(still.wrench.torque_n_m, Vec3::Zero());
        const BurrForce turning = burr_force(law, r, m0, Vec3(0.0, 0.0, -m1), Vec3::Zero(), spin);
        const Vec3 rub = turning.wrench.force_n - still.wrench.force_n;
        const Vec3 surface_m_s = spin.cross(Vec3(0.0, 0.0, -m1 / m0));  // burr surface at the contact
        EXPECT_NEAR(rub.norm(), law.friction_n_s_m3 * r * r * x * surface_m_s.norm(), 1e-9);
        EXPECT_LT(rub.dot(surface_m_s), 0.0);
        EXPECT_LT(turning.wrench.torque_n_m.dot(spin), 0.0);  // the torque brakes the burr
        const BurrForce moving = burr_force(law, r, m0, Vec3(0.0, 0.0, -m1), velocity, Vec3::Zero());
        EXPECT_LT(
            (moving.wrench.force_n - still.wrench.force_n + law.impact_n_s_m3 * r * r * x * velocity).norm(),
            1e-12);
    }
}

TEST(BurrForces, a_burr_in_a_slot_or_fully_in_bone_gets_a_steady_force) {
    const BurrLaw law;
    const double r = 3e-3, m0 = 0.8 * kPi * r * r * r;
    double before = 0.0;
    for (double lean = -1.0; lean <= 1.0; lean += 1e-3) {  // from one wall to the other
        const double m1 = 0.25 * kPi * r * r * r * r * lean;
        const double f =
            burr_force(law, r, m0, Vec3(m1, 0.0, 0.0), Vec3::Zero(), Vec3::Zero()).wrench.force_n.x();
        if (lean > -1.0) {
            EXPECT_LT(std::abs(f - before), 0.03);
        }
        before = f;
    }
    const BurrForce full =
        burr_force(law, r, 4.0 / 3.0 * kPi * r * r * r, Vec3::Zero(), Vec3::Zero(), Vec3::Zero());
    EXPECT_NEAR(full.depth, 2.0, 1e-6);
    EXPECT_EQ(full.wrench.force_n, Vec3::Zero());
    // Bone pushes a burr that presses in from above back, with a force that rises with depth.
    double least = 0.0;
    for (double x = 0.05; x <= 2.0; x += 0.01) {
        const double m = kPi * r * r * r * x * x * (1.0 - x / 3.0),
                     m1 = 0.25 * kPi * r * r * r * r * x * x * (2.0 - x) * (2.0 - x);
        const double up =
            burr_force(law, r, m, Vec3(0.0, 0.0, -m1), Vec3::Zero(), Vec3::Zero(), Vec3::UnitZ())
                .wrench.force_n.z();
        EXPECT_GT(up, least);
        least = up;
    }
}

TEST(BurrForces, friction_stays_below_its_fraction_of_the_normal_force) {
    BurrLaw law;
    law.friction_n_s_m3 = 1e6;
    const double r = 3e-3, m0 = 0.1 * kPi * r * r * r;
    const Vec3 m1(0.0, 0.0, -0.08 * kPi * r * r * r * r);
    const auto force_n = [&](double spin_rad_s) {
        return burr_force(law, r, m0, m1, Vec3::Zero(), Vec3(spin_rad_s, 0.0, 0.0)).wrench.force_n;
    };
    for (const double spin : {10.0, 1e3, 1e5})
        EXPECT_LT((force_n(spin) - force_n(0.0)).norm(), law.friction_share * force_n(0.0).norm());
    EXPECT_NEAR(elastic_for(2e-3, 1.25e-3) * 2e-3 * 2e-3 * std::pow(0.5, 1.5), 1.0,
                1e-12);  // 1 N at half the radius
    EXPECT_NEAR(elastic_for(5e-3, 1.25e-3) * 5e-3 * 5e-3 * std::pow(0.25, 1.5), 1.0, 1e-12);
}

TEST(BurrShapes, weights_count_each_part_of_the_volume_once) {
    DrillToolSettings s;
    s.shape = BurrShape::cylinder;
    s.radius_m = 2e-3;
    s.length_m = 9e-3;
    s.shaft_radius_m = 0.0;
    const DrillTool rod = make_drill_tool(s);
    double volume = 0.0;
    for (std::uint32_t i = 0; i < rod.count; ++i)
        volume += rod.ball[i].weight * 4.0 / 3.0 * kPi * std::pow(rod.ball[i].radius_m, 3);
    const double straight = s.length_m - 2.0 * s.radius_m;
    EXPECT_NEAR(volume / (kPi * s.radius_m * s.radius_m * (straight + 4.0 / 3.0 * s.radius_m)), 1.0, 0.04);
    s.shape = BurrShape::cone;
    s.shaft_radius_m = 1e-3;
    const DrillTool cone = make_drill_tool(s);
    EXPECT_NEAR(cone.ball[0].radius_m, s.tip_radius_m, 1e-12);
    EXPECT_NEAR(cone.ball[0].centre_tool_m.z() - s.tip_radius_m, -0.5 * s.length_m, 1e-12);
    for (std::uint32_t i = 1; i < cone.count; ++i)
        EXPECT_GT(cone.ball[i].centre_tool_m.z(), cone.ball[i - 1].centre_tool_m.z());
    EXPECT_TRUE(cone.ball[0].cuts);
    EXPECT_FALSE(cone.ball[cone.count - 1].cuts);  // the shaft does not cut
    s.shape = BurrShape::sphere;
    const DrillTool ball = make_drill_tool(s);
    EXPECT_EQ(ball.ball[0].weight, 1.0);
    s.radius_m = -1.0;
    EXPECT_THROW((void)make_drill_tool(s), StartupError);
    s.radius_m = 2e-3;
    s.shaft_length_m = std::nan("");
    EXPECT_THROW((void)make_drill_tool(s), StartupError);
    s.shaft_length_m = 0.19;
    s.shaft_radius_m = 1e-4;
    EXPECT_THROW((void)make_drill_tool(s), StartupError);
}

}  // namespace
}  // namespace tact::force_bone_test
