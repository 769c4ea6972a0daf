// Erosion of bone, and the drill model that renders the force and cuts.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <numeric>

#include "ipc/base/error.hpp"
#include "rt/force/drilling/drill_model.hpp"
#include "tests/contract/force_model_contract.hpp"
#include "tests/support/bone_block.hpp"

namespace tact {
namespace {

constexpr double kVoxelM = 3e-4;

std::uint64_t mass_of(const BoneBlock& bone) {
    return std::accumulate(bone.density.begin(), bone.density.end(), std::uint64_t{0});
}
BoneBlock solid(std::uint32_t edge, double level = 1.0) {
    return BoneBlock(
        edge, kVoxelM, [=](const Vec3&) { return level; }, 1);
}
Vec3 along(const Vec3& from, const Vec3& to, double s) { return from + s * (to - from); }

// Mass that eq. 12 removes from solid bone in a straight stroke, by Simpson's rule along the stroke.
double removed_by_theory(const BoneBlock& bone, const Vec3& from, const Vec3& to, double radius,
                         double exposure) {
    constexpr int kParts = 100;
    double removed = 0.0;
    const auto& n = bone.bricks.size;
    for (std::uint32_t z = 0; z < n[2]; ++z) {
        for (std::uint32_t y = 0; y < n[1]; ++y) {
            for (std::uint32_t x = 0; x < n[0]; ++x) {
                double sum = 0.0;
                for (int i = 0; i <= kParts; ++i) {
                    const double weight = i == 0 || i == kParts ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
                    const double r2 =
                        (Vec3(x, y, z) - along(from, to, i / static_cast<double>(kParts))).squaredNorm();
                    sum += weight * std::max(0.0, 1.0 - r2 / (radius * radius));
                }
                if (sum > 0.0)
                    removed += bone.density[bone.bricks.voxel(x, y, z)] *
                               -std::expm1(-exposure * sum / (3.0 * kParts));
            }
        }
    }
    return removed;
}

TEST(Erosion, follows_its_equation_at_any_servo_rate_and_stroke_speed) {
    const double radius = 4.0, rate_per_s = 30.0;
    const Vec3 from(9.2, 10.1, 11.4), to(17.7, 13.9, 12.2);
    const double way_m = kVoxelM * (to - from).norm();
    for (const double speed_m_s : {5e-3, 30e-3, 200e-3}) {
        const double time_s = way_m / speed_m_s;
        const double right = removed_by_theory(solid(24), from, to, radius, rate_per_s * time_s);
        for (const double servo_hz : {500.0, 1000.0, 4000.0}) {
            BoneBlock bone = solid(24);
            MomentOctree octree(bone.bricks, bone.density);
            Erosion erosion(octree, bone.density, bone.revision, 3);
            const int steps = std::max(1, static_cast<int>(std::lround(time_s * servo_hz)));
            for (int i = 0; i < steps; ++i) {
                erosion.begin();
                erosion.cut(best_brick_kernels(),
                            {.from_voxels = along(from, to, i / static_cast<double>(steps)),
                             .to_voxels = along(from, to, (i + 1.0) / steps),
                             .radius_voxels = radius,
                             .exposure = rate_per_s * time_s / steps});
            }
            EXPECT_NEAR(static_cast<double>(erosion.removed()), right, 0.01 * right)
                << speed_m_s << " m/s at " << servo_hz << " Hz";
        }
    }
}

TEST(Erosion, alternating_groups_of_bricks_remove_the_same_mass) {
    const double radius = 13.0, exposure = 1.5;
    const Vec3 from(17.2, 20.1, 18.4), to(27.7, 23.9, 25.2);
    constexpr int kSteps = 80;
    constexpr std::uint32_t kGroups = 4;
    BoneBlock bone = solid(46);
    const double right = removed_by_theory(bone, from, to, radius, exposure);
    MomentOctree octree(bone.bricks, bone.density);
    Erosion erosion(octree, bone.density, bone.revision, 3);
    std::array<int, kGroups> last{};
    for (int i = 1; i < kSteps + static_cast<int>(kGroups); ++i) {
        const std::uint32_t group = static_cast<std::uint32_t>(i) % kGroups;
        const int now = std::min(i, kSteps);
        erosion.begin();
        erosion.cut(best_brick_kernels(),
                    {.from_voxels = along(from, to, last[group] / static_cast<double>(kSteps)),
                     .to_voxels = along(from, to, now / static_cast<double>(kSteps)),
                     .radius_voxels = radius,
                     .exposure = exposure * (now - last[group]) / kSteps,
                     .groups = kGroups,
                     .first = group});
        last[group] = now;
    }
    EXPECT_NEAR(static_cast<double>(erosion.removed()), right, 0.005 * right);
}

// Each brick is in one group; ranges of groups, also across the last one, are their sums.
TEST(Erosion, groups_are_a_partition_and_about_equal) {
    BoneBlock bone = solid(96);
    MomentOctree octree(bone.bricks, bone.density);
    Erosion erosion(octree, bone.density, bone.revision, 3);
    const auto computed = [&](std::uint32_t groups, std::uint32_t first, std::uint32_t count) {
        erosion.begin();
        erosion.cut(best_brick_kernels(), {.from_voxels = Vec3::Constant(47.5),
                                           .to_voxels = Vec3::Constant(47.5),
                                           .radius_voxels = 200.0,
                                           .exposure = 1e-9,  // so little that hardly a voxel changes
                                           .groups = groups,
                                           .first = first,
                                           .count = count});
        return erosion.pass().visited;
    };
    ASSERT_EQ(computed(1, 0, 1), 12U * 12U * 12U);
    for (const std::uint32_t groups : {8U, 16U, 32U, 64U, 128U, 256U}) {
        std::vector<std::uint32_t> bricks;
        for (std::uint32_t g = 0; g < groups; ++g) bricks.push_back(computed(groups, g, 1));
        EXPECT_EQ(std::accumulate(bricks.begin(), bricks.end(), 0U), 12U * 12U * 12U) << groups;
        const double mean = 12.0 * 12.0 * 12.0 / groups;
        EXPECT_LE(*std::max_element(bricks.begin(), bricks.end()), 1.5 * mean + 1.0) << groups;
        EXPECT_GE(*std::min_element(bricks.begin(), bricks.end()), 0.5 * mean - 1.0) << groups;
        for (const std::uint32_t first : {0U, 3U, groups / 2 + 1, groups - 2})
            for (const std::uint32_t count : {2U, 5U, groups / 4}) {
                std::uint32_t sum = 0;
                for (std::uint32_t k = 0; k < count; ++k) sum += bricks[(first + k) % groups];
                EXPECT_EQ(computed(groups, first, count), sum) << groups << ", " << first << ", " << count;
            }
        // Blocks without a brick of the group are passed over.
        static_cast<void>(computed(groups, 0, 1));
        EXPECT_LE(erosion.pass().walked, bricks[0] + 6U * 6U * 6U * std::min(8.0 / groups, 1.0) + 64.0)
            << groups;
    }
}

TEST(Erosion, rounding_is_unbiased_for_slow_cuts_and_soft_bone) {
    // Steps so small that a voxel seldom loses a level, and one step that removes nearly all.
    for (const double exposure : {1e-5, 1e-3, 0.09, 0.11, 3.0}) {
        for (const double soft : {1.0, 3.0}) {
            BoneBlock bone = solid(32, 100.0 / 255.0);
            MomentOctree octree(bone.bricks, bone.density);
            Erosion erosion(octree, bone.density, bone.revision, 5);
            const double rate = exposure * (1.0 + (soft - 1.0) * 155.0 / 255.0), radius = 14.0;
            const Vec3 at = Vec3::Constant(15.6);
            const double right = removed_by_theory(bone, at, at, radius, rate);
            erosion.begin();
            erosion.cut(best_brick_kernels(), {at, at, radius, exposure, soft});
            // Each voxel rounds by one level at most, so the sum scatters by at most the root of the sum.
            EXPECT_NEAR(static_cast<double>(erosion.removed()), right, 5.0 * std::sqrt(right) + 1e-3 * right)
                << exposure;
        }
    }
}

TEST(Erosion, no_mass_is_lost) {
    BoneBlock bone = solid(144, 0.9);
    const std::vector<std::uint8_t> before = bone.density;
    MomentOctree octree(bone.bricks, bone.density);
    const std::uint64_t mass = mass_of(bone);
    EXPECT_EQ(static_cast<std::uint64_t>(octree.total().m0), mass);
    Erosion erosion(octree, bone.density, bone.revision, 9);
    std::uint64_t listed = 0, unlisted = 0;
    const auto cut = [&](const CuttingBall& ball) {
        const std::uint64_t was = mass_of(bone);
        erosion.begin();
        EXPECT_TRUE(erosion.dust().empty());
        erosion.cut(best_brick_kernels(), ball);
        std::uint64_t of_dust = 0;
        for (const BoneDust& d : erosion.dust()) {
            of_dust += d.levels;
            const std::uint32_t n = bone.bricks.bricks()[0];
            const std::uint32_t place[3] = {d.brick % n, d.brick / n % n, d.brick / n / n};
            for (int a = 0; a < 3; ++a) {
                EXPECT_GE(d.centre_voxels[a], 8.0F * static_cast<float>(place[a]) - 1e-3F);
                EXPECT_LE(d.centre_voxels[a], 8.0F * static_cast<float>(place[a]) + 7.001F);
            }
        }
        EXPECT_EQ(of_dust + erosion.pass().unlisted, erosion.pass().removed);
        EXPECT_EQ(was - mass_of(bone), erosion.pass().removed);
        listed += of_dust;
        unlisted += erosion.pass().unlisted;
    };
    for (int i = 0; i < 20; ++i) cut({Vec3(70.0, 70.0, 140.0 - i), Vec3(70.3, 70.0, 139.0 - i), 12.5, 0.05});
    EXPECT_EQ(unlisted, 0U);
    cut({Vec3::Constant(-5.0), Vec3::Constant(150.0), 90.0, 0.4});  // more bricks than the list can hold
    EXPECT_GT(unlisted, 0U);
    cut({Vec3(-60.0, 1000.0, 3.0), Vec3(-50.0, 2000.0, 3.0), 30.0, 1.0});  // beside the volume
    EXPECT_EQ(erosion.pass().removed, 0U);
    EXPECT_EQ(listed + unlisted, erosion.removed());
    EXPECT_EQ(mass - mass_of(bone), erosion.removed());
    EXPECT_EQ(static_cast<std::uint64_t>(octree.total().m0), mass_of(bone));
    const MomentOctree anew(bone.bricks, bone.density);
    EXPECT_EQ(octree.total().m1, anew.total().m1);
    for (std::size_t i = 0; i < bone.bricks.brick_count(); ++i) {
        const auto first = static_cast<std::ptrdiff_t>(i * BoneBricks::kVoxels), last = first + 512;
        const bool same =
            std::equal(before.begin() + first, before.begin() + last, bone.density.begin() + first);
        EXPECT_EQ(same, bone.revision[i] == 0) << i;
        EXPECT_EQ(octree.brick(i).m0, anew.brick(i).m0);
    }
}

// Bone fills z < 0 of the world; the tool's shaft points up.
struct Bench {
    BoneBlock bone;
    SceneMeta meta{};
    std::unique_ptr<DrillBone> shared;
    std::unique_ptr<DrillModel> model;

    explicit Bench(const DrillSettings& settings, std::uint32_t edge = 56)
        : bone(
              edge, kVoxelM, [=](const Vec3& p) { return p.z() < 0.5 * edge - 0.5 ? 1.0 : 0.0; }, 1) {
        meta.kind = SceneKind::drilling;
        meta.world_per_model = 1.0;
        bone.bricks.origin_m = -kVoxelM * Vec3::Constant(0.5 * edge - 0.5);
        shared = std::make_unique<DrillBone>(bone.bricks, bone.density, bone.revision);
        model = std::make_unique<DrillModel>(meta, *shared, settings);
    }
    static ToolState at(double x_m, double y_m, double z_m) {
        ToolState tool;
        tool.T_world_tool.p_m = Vec3(x_m, y_m, z_m);
        return tool;
    }
    StepResult step(const ToolState& tool, Instant deadline = Instant::max(), float fidelity = 0.32F) {
        Budget budget;
        budget.fidelity = fidelity;
        budget.deadline = deadline;
        return model->step(tool, budget);
    }
};

DrillSettings burr(double radius_m = 2e-3) {
    DrillSettings s;
    s.tool.radius_m = radius_m;
    return s;
}
constexpr double kFullRadS = 6283.0;

TEST(DrillModel, a_scripted_stroke_repeats_bit_by_bit) {
    const auto run = [](std::uint64_t seed, std::vector<Vec3>& forces) {
        DrillSettings s = burr();
        s.seed = seed;
        s.vibration = 0.1;
        Bench b(s);
        b.model->turn_burr({kFullRadS, 1e-3});
        b.model->reset(Bench::at(0.0, 0.0, 3e-3));
        for (int i = 0; i < 700; ++i) {
            const double t = 1e-3 * i;
            ToolState tool = Bench::at(2e-3 * std::sin(20.0 * t), 1e-3 * std::sin(13.0 * t),
                                       std::max(1e-3, 3e-3 - 5e-3 * t));
            tool.T_world_tool.q = Quat(Eigen::AngleAxisd(0.3 * std::sin(5.0 * t), Vec3::UnitX()));
            forces.push_back(b.step(tool).wrench_world.force_n);
        }
        EXPECT_GT(b.model->removed_levels(), 255U * 50U);
        return b.bone.density;
    };
    std::vector<Vec3> first, again, other;
    const auto left = run(4, first), left_again = run(4, again), left_other = run(5, other);
    EXPECT_EQ(left, left_again);
    EXPECT_EQ(first, again);
    EXPECT_NE(left, left_other);
}

TEST(DrillModel, the_force_is_continuous_while_bone_is_removed) {
    for (const auto shape : {BurrShape::sphere, BurrShape::cylinder}) {
        DrillSettings s = burr();
        s.tool.shape = shape;
        Bench b(s);
        const double z_m = (shape == BurrShape::sphere ? 2e-3 : 4e-3) - 6e-4;  // 0.6 mm deep
        b.model->reset(Bench::at(0.0, 0.0, z_m));
        StepResult before{};
        for (int i = 0; i < 400; ++i) before = b.step(Bench::at(0.0, 0.0, z_m));
        const double pressed_n = before.wrench_world.force_n.z();
        EXPECT_GT(pressed_n, 0.1);
        b.model->turn_burr({0.5 * kFullRadS, 1e-3});
        double turning_n = 0.0;
        for (int i = 0; i < 1500; ++i) {
            const StepResult now = b.step(Bench::at(0.0, 0.0, z_m));
            // The first step with the burr on adds friction, which acts sideways.
            if (i == 0) turning_n = now.wrench_world.force_n.z();
            EXPECT_NEAR(now.wrench_world.force_n.z(), i == 0 ? turning_n : before.wrench_world.force_n.z(),
                        0.03 * pressed_n)
                << i;
            before = now;
        }
        EXPECT_LT(before.wrench_world.force_n.z(), 0.5 * pressed_n);  // eq. 12 erodes slowly at the rim
    }
}

TEST(DrillModel, late_steps_are_cut_later) {
    const auto removed = [](int late_every, double radius_m) {
        Bench b(burr(radius_m));
        const double z_m = radius_m - 8e-4;
        b.model->reset(Bench::at(-6e-3, 0.0, z_m));
        for (int i = 0; i < 300; ++i) (void)b.step(Bench::at(-6e-3, 0.0, z_m));
        b.model->turn_burr({kFullRadS, 1e-3});
        for (int i = 0; i <= 200; ++i) {
            const bool late = late_every > 0 && i % late_every != 0;
            const StepResult r = b.step(Bench::at(-6e-3 + 6e-5 * i, 0.0, z_m),
                                        late ? instant_from_ns(0) : Instant::max(), 1.0F);
            EXPECT_EQ(r.status, late ? StepStatus::out_of_time : StepStatus::ok);
        }
        // What waits is cut also when the burr stands again.
        b.model->turn_burr({0.0, 1e-3});
        for (int i = 0; i < 16; ++i)
            (void)b.step(Bench::at(-6e-3 + 6e-5 * 200, 0.0, z_m), Instant::max(), 1.0F);
        if (late_every > 0) {
            EXPECT_GT(b.model->postponed(), 100U);
        }
        return static_cast<double>(b.model->removed_levels());
    };
    for (const double radius_m : {2e-3, 5e-3}) {  // one and two groups of bricks
        const double on_time = removed(0, radius_m);
        EXPECT_GT(on_time, 255.0 * 20.0);
        EXPECT_NEAR(removed(4, radius_m), on_time, 0.03 * on_time);
    }
}

TEST(DrillModel, only_a_rotating_head_cuts_and_not_while_the_clutch_is_held) {
    Bench b(burr());
    const ToolState in = Bench::at(0.0, 0.0, 1.2e-3);
    const std::uint64_t mass = mass_of(b.bone);
    b.model->turn_burr({kFullRadS, 1e-3});
    for (int i = 0; i < 100; ++i) (void)b.step(in);  // before a reset
    EXPECT_EQ(mass_of(b.bone), mass);
    b.model->reset(in);
    for (const BurrDrive& drive : {BurrDrive{0.0, 1e-3}, BurrDrive{std::nan(""), 1e-3}, BurrDrive{-5.0, 1e-3},
                                   BurrDrive{kFullRadS, -1.0}, BurrDrive{kFullRadS, std::nan("")}}) {
        b.model->turn_burr(drive);
        for (int i = 0; i < 300; ++i) (void)b.step(in);
        EXPECT_EQ(mass_of(b.bone), mass);
    }
    b.model->turn_burr({kFullRadS, 1e-3});
    ToolState held = in;
    held.buttons = 1;
    for (int i = 0; i < 300; ++i) (void)b.step(held);
    EXPECT_EQ(mass_of(b.bone), mass);
    // Upside down, the shaft is in the bone and the head is outside.
    ToolState turned = Bench::at(0.0, 0.0, 2.6e-3);
    turned.T_world_tool.q = Quat(0.0, 1.0, 0.0, 0.0);
    b.model->reset(turned);
    StepResult felt;
    for (int i = 0; i < 300; ++i) felt = b.step(turned);
    EXPECT_GT(felt.wrench_world.force_n.norm(), 0.1);
    EXPECT_EQ(mass_of(b.bone), mass);
    b.model->reset(in);
    for (int i = 0; i < 300; ++i) (void)b.step(in);
    EXPECT_LT(mass_of(b.bone), mass);
    EXPECT_EQ(mass - mass_of(b.bone), b.model->removed_levels());
}

TEST(DrillModel, a_jump_cuts_nothing_on_its_path) {
    Bench b(burr());
    b.model->turn_burr({kFullRadS, 1e-3});
    b.model->reset(Bench::at(-20e-3, 0.0, 0.0));
    for (int i = 0; i < 300; ++i) (void)b.step(Bench::at(-20e-3, 0.0, 0.0));
    (void)b.step(Bench::at(20e-3, 0.0, 0.0));
    EXPECT_EQ(b.model->jumps(), 1U);
    EXPECT_EQ(b.model->removed_levels(), 0U);
}

TEST(DrillModel, vibration_stays_within_its_fraction_of_the_force_and_keeps_the_mean) {
    DrillSettings s = burr();
    s.rate_per_s = 0.0;
    s.law.friction_n_s_m3 = 0.0;
    Bench still(s);
    s.vibration = 0.2;
    Bench shaken(s);
    const ToolState in = Bench::at(0.0, 0.0, 1.3e-3);
    Vec3 sum = Vec3::Zero(), before = Vec3::Zero(), calm = Vec3::Zero();
    for (Bench* b : {&still, &shaken}) {
        b->model->turn_burr({kFullRadS, 1e-3});
        b->model->reset(in);
        for (int i = 0; i < 400; ++i) before = b->step(in).wrench_world.force_n;
        if (b == &still) calm = before;
    }
    for (int i = 0; i < 1000; ++i) {
        const Vec3 now = shaken.step(in).wrench_world.force_n;
        EXPECT_LT((now - calm).norm(), 0.21 * calm.norm());
        EXPECT_LT((now - before).norm(),
                  0.2 * 0.66 * calm.norm());  // at most a tenth of a revolution per step
        sum += now;
        before = now;
    }
    EXPECT_LT((sum / 1000.0 - calm).norm(), 0.01 * calm.norm());
    EXPECT_GT(calm.norm(), 0.1);
}

TEST(DrillModel, refuses_settings_that_it_cannot_render) {
    const auto refused = [](const auto& spoil) {
        DrillSettings s = burr();
        spoil(s);
        EXPECT_THROW(Bench{s}, StartupError);
    };
    refused([](DrillSettings& s) { s.tool.radius_m = 2e-4; });  // below a voxel
    refused([](DrillSettings& s) { s.tool.shaft_radius_m = 2e-4; });
    refused([](DrillSettings& s) { s.law.elastic_pa = -1.0; });
    refused([](DrillSettings& s) { s.rate_per_s = std::nan(""); });
    refused([](DrillSettings& s) { s.force_n_max = 0.0; });
    refused([](DrillSettings& s) { s.vibration = 2.0; });
    Bench b(burr());
    std::vector<std::uint32_t> few(3);
    EXPECT_THROW(Erosion(b.shared->octree, b.bone.density, few, 1), StartupError);
}

// A model that owns its bone, for the suite of the model contract.
class OwnBone final : public ForceModel {
public:
    explicit OwnBone(const DrillSettings& s) : bench_(s) {}
    KnobSpec knob() const noexcept override { return bench_.model->knob(); }
    std::uint32_t items(float f) const noexcept override { return bench_.model->items(f); }
    PathLoad predict(float f) const noexcept override { return bench_.model->predict(f); }
    void reset(const ToolState& t) noexcept override { bench_.model->reset(t); }
    void drive(const ToolDrive& d) noexcept override { bench_.model->drive(d); }
    StepResult step(const ToolState& t, const Budget& b) noexcept override {
        return bench_.model->step(t, b);
    }
    ModelBodies bodies() const noexcept override { return bench_.model->bodies(); }

private:
    Bench bench_;
};

// Of 17 voxels: a smaller ball is summed voxel by voxel at any level. Pressed by 1.2 mm.
ForceModelCase contract_case(const char* name, BurrShape shape, double radius_m) {
    ForceModelCase c;
    c.name = name;
    DrillSettings s = burr(radius_m);
    s.tool.shape = shape;
    c.make = [s] { return std::make_unique<OwnBone>(s); };
    const double z_m = radius_m - 1.2e-3;
    c.grip.p_m = Vec3(0.0, 0.0, z_m + 3e-3);
    c.touch.p_m = Vec3(1e-4, 2e-4, z_m);
    c.touch.q = Quat(Eigen::AngleAxisd(0.4, Vec3(0.6, 0.8, 0.0)));
    c.force_n_min = 0.1;
    c.items_tolerance = 0.3;  // blocks of another level are expected from the surface that is touched
    return c;
}
INSTANTIATE_TEST_SUITE_P(Drilling, ForceModelContract,
                         testing::Values(contract_case("sphere", BurrShape::sphere, 5e-3)),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace tact
