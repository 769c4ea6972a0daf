// Another burr in the hand: what is asked for, that no force makes a step, and that the new tool is the one asked for.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include "ipc/base/error.hpp"
#include "ipc/topics/command.hpp"
#include "ipc/topics/drill.hpp"
#include "rt/force/drilling/drill_model.hpp"
#include "rt/force/drilling/drill_publisher.hpp"
#include "tests/support/bone_block.hpp"

namespace tact::burr_exchange_test {
namespace {

constexpr double kVoxelM = 3e-4, kStepS = 1e-3, kFullRadS = 6283.0;
constexpr std::uint32_t kEdge = 64;
const Vec3 kAbove(0.0, 0.0, 6e-3);

ModelOrder burr_order(DrillShape shape, DrillGrit grit, double diameter_m, double length_m = 0.0) {
    ModelOrder o;
    o.kind = ModelOrder::Kind::setting;
    o.command = static_cast<std::uint8_t>(CommandKind::set_burr);
    o.body = static_cast<std::uint32_t>(shape) | static_cast<std::uint32_t>(grit) << 8U;
    o.value = diameter_m;
    o.T_model_body.p_m = Vec3(length_m, 0.0, 0.0);
    return o;
}
ModelOrder drive_order(CommandKind command, double value) {
    ModelOrder o;
    o.kind = ModelOrder::Kind::setting;
    o.command = static_cast<std::uint8_t>(command);
    o.value = value;
    return o;
}
DrillSettings settings(double radius_m = 2e-3, bool cuts = true) {
    DrillSettings s;
    s.tool.radius_m = radius_m;
    s.tool.shaft_radius_m = 0.6e-3;
    s.tool.cuts = cuts;
    s.burr_rad_s = kFullRadS;
    return s;
}

// A burr over a block whose upper half is empty, its force and its published numbers.
struct Site {
    BoneBlock bone{kEdge, kVoxelM, [](const Vec3& p) { return p.z() < 0.5 * kEdge - 0.5 ? 1.0 : 0.0; }, 1};
    SceneMeta meta{};
    std::unique_ptr<DrillBone> shared;
    std::unique_ptr<ForceModel> model;
    Latest<DrillTopic> drill;
    Latest<TouchTopic> touch;
    DrillPublisher publisher{drill, touch, {.irrigation_m3_s = 3e-7, .suction_m3_s = 1e-4}};
    Vec3 force_n = Vec3::Zero();
    double largest_step_n = 0.0;
    bool turns = true;
    std::uint64_t mass_before;

    explicit Site(const DrillSettings& s = settings()) {
        meta.kind = SceneKind::drilling;
        meta.world_per_model = 1.0;
        bone.bricks.origin_m = -kVoxelM * Vec3::Constant(0.5 * kEdge - 0.5);
        shared = std::make_unique<DrillBone>(bone.bricks, bone.density, bone.revision);
        auto made = std::make_unique<DrillModel>(meta, *shared, s);
        made->publish_to(publisher);
        model = std::move(made);
        model->reset(tool_at(kAbove));
        mass_before = mass();
    }
    static ToolState tool_at(const Vec3& p_m) {
        ToolState tool;
        tool.T_world_tool.p_m = p_m;
        return tool;
    }
    [[nodiscard]] DrillModel& drilling() const { return dynamic_cast<DrillModel&>(*model); }
    [[nodiscard]] std::uint64_t mass() const {
        return std::accumulate(bone.density.begin(), bone.density.end(), std::uint64_t{0});
    }
    void step(const Vec3& p_m) {
        model->drive({.enabled = true, .on = turns, .step_s = kStepS});
        Budget budget;
        budget.fidelity = 1.0F;
        budget.deadline = Deadline(Instant::max());
        const StepResult r = model->step(tool_at(p_m), budget);
        model->publish({.now = {}, .cycle = 1, .hand = 0, .step = r});
        largest_step_n = std::max(largest_step_n, (r.wrench_world.force_n - force_n).norm());
        force_n = r.wrench_world.force_n;
    }
    void steps(int n, const Vec3& p_m) {
        for (int i = 0; i < n; ++i) step(p_m);
    }
    [[nodiscard]] DrillTopic topic() const {
        DrillTopic t{};
        EXPECT_TRUE(drill.read(t));
        return t;
    }
    // As the builder and the servo do.
    void exchange() {
        ASSERT_TRUE(model->stale());
        std::unique_ptr<ForceModel> made = model->rebuild(model->bodies());
        ASSERT_NE(made, nullptr);
        ASSERT_TRUE(made->adopt(*model));
        model = std::move(made);
        ASSERT_FALSE(model->stale());
    }
};

TEST(BurrExchange, the_new_burr_is_the_one_that_was_asked_for) {
    Site s;
    s.turns = false;
    s.steps(2, kAbove);
    const ModelBodies before = s.model->bodies();
    ASSERT_TRUE(s.model->order(burr_order(DrillShape::sphere, DrillGrit::diamond, 6e-3)));
    s.step(kAbove);
    EXPECT_EQ(s.topic().changing_burr, 1);
    EXPECT_FLOAT_EQ(s.topic().hand[0].radius_m, 2e-3F);
    s.exchange();
    s.step(kAbove);
    const DrillTopic t = s.topic();
    EXPECT_EQ(t.changing_burr, 0);
    EXPECT_FLOAT_EQ(t.hand[0].radius_m, 3e-3F);
    EXPECT_EQ(t.hand[0].shape, DrillShape::sphere);
    EXPECT_EQ(t.hand[0].grit, DrillGrit::diamond);
    EXPECT_EQ(s.model->bodies().tools, before.tools + 1);  // another cost: the governor begins anew
    EXPECT_EQ(s.model->bodies().grips, before.grips);
    // The same force as a model that began with this burr.
    Site other(settings(3e-3));
    other.turns = false;
    const Vec3 in(0.2e-3, -0.1e-3, 1.9e-3);
    s.steps(400, in);
    other.steps(400, in);
    ASSERT_GT(other.force_n.norm(), 0.3);
    EXPECT_EQ(s.force_n, other.force_n);
    EXPECT_EQ(s.model->stiffness().force_n_m, other.model->stiffness().force_n_m);
    EXPECT_EQ(s.model->predict(0.5F).cost_predicted, other.model->predict(0.5F).cost_predicted);
}

// The governor needs the cost of the new tool before its first contact. Without a loop nothing is tried.
TEST(BurrExchange, the_new_burr_is_tried_as_the_first_one_was) {
    for (const bool tried : {false, true}) {
        Site s;
        if (tried) s.drilling().foresee(rehearse_drill(settings(), kVoxelM, kStepS));
        const Duration first = s.model->predict(1.0F).cost_foreseen;
        ASSERT_TRUE(s.model->order(burr_order(DrillShape::sphere, DrillGrit::cutting, 6e-3)));
        s.exchange();
        const Duration now = s.model->predict(1.0F).cost_foreseen;
        EXPECT_EQ(first.count() > 0, tried);
        EXPECT_EQ(now.count() > 0, tried);
        EXPECT_EQ(now != first, tried);
    }
}

TEST(BurrExchange, heads_have_their_length_and_a_small_one_a_thin_shaft_and_a_large_one_the_first_again) {
    Site s;
    ASSERT_TRUE(s.model->order(burr_order(DrillShape::cylinder, DrillGrit::cutting, 4e-3, 7e-3)));
    s.exchange();
    s.step(kAbove);
    EXPECT_EQ(s.topic().hand[0].shape, DrillShape::cylinder);
    EXPECT_FLOAT_EQ(s.topic().hand[0].length_m, 7e-3F);
    EXPECT_FLOAT_EQ(s.topic().hand[0].shaft_radius_m, 0.6e-3F);
    ASSERT_TRUE(s.model->order(burr_order(DrillShape::sphere, DrillGrit::cutting, 1e-3)));
    s.exchange();
    s.step(kAbove);
    EXPECT_FLOAT_EQ(s.topic().hand[0].shaft_radius_m, 0.4e-3F);
    ASSERT_TRUE(s.model->order(burr_order(DrillShape::sphere, DrillGrit::cutting, 5e-3)));
    s.exchange();
    s.step(kAbove);
    EXPECT_FLOAT_EQ(s.topic().hand[0].shaft_radius_m, 0.6e-3F);
    // One as thin as a voxel: its shaft has a voxel's radius too, or there is none.
    ASSERT_TRUE(s.model->order(burr_order(DrillShape::sphere, DrillGrit::cutting, 2.0 * kVoxelM)));
    s.exchange();
    s.steps(3, kAbove);
}

TEST(BurrExchange, what_no_tool_can_be_is_refused_and_changes_nothing) {
    Site s;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto refused = [&](const ModelOrder& o) { return !s.model->order(o) && !s.model->stale(); };
    using enum DrillShape;
    using enum DrillGrit;
    EXPECT_TRUE(refused(burr_order(sphere, cutting, nan)));
    EXPECT_TRUE(refused(burr_order(sphere, cutting, -1.0)));
    EXPECT_TRUE(refused(burr_order(sphere, cutting, 0.0)));
    EXPECT_TRUE(refused(burr_order(sphere, cutting, 1.9 * kVoxelM)));  // below a voxel of radius
    EXPECT_TRUE(refused(burr_order(sphere, cutting, 41e-3)));
    EXPECT_TRUE(refused(burr_order(cylinder, cutting, 4e-3)));  // without a length
    EXPECT_TRUE(refused(burr_order(cylinder, cutting, 4e-3, 3e-3)));
    EXPECT_TRUE(refused(burr_order(cone, cutting, 4e-3, nan)));
    EXPECT_TRUE(refused(burr_order(static_cast<DrillShape>(3), cutting, 4e-3)));
    EXPECT_TRUE(refused(burr_order(sphere, static_cast<DrillGrit>(2), 4e-3)));
    for (const CommandKind kind :
         {CommandKind::set_burr_speed, CommandKind::set_irrigation, CommandKind::set_suction})
        for (const double value : {nan, -1e-9, 1e6}) EXPECT_TRUE(refused(drive_order(kind, value)));
    EXPECT_FALSE(s.model->order(drive_order(CommandKind::set_clash, 1.0)));
    // One at a time: the builder reads what was asked for.
    ASSERT_TRUE(s.model->order(burr_order(sphere, cutting, 4e-3)));
    EXPECT_FALSE(s.model->order(burr_order(sphere, cutting, 5e-3)));
    s.exchange();
    EXPECT_DOUBLE_EQ(s.drilling().head_radius_m(), 2e-3);
    // A suction tube is no burr.
    DrillModel tube(s.meta, *s.shared, settings(1e-3, false));
    EXPECT_FALSE(tube.order(burr_order(sphere, cutting, 4e-3)));
    EXPECT_FALSE(tube.order(drive_order(CommandKind::set_burr_speed, 100.0)));
}

// In bone, pressed, turning: the force goes down to zero before the other burr pushes, and nothing is cut meanwhile.
TEST(BurrExchange, the_force_makes_no_step_and_nothing_is_cut_until_the_new_burr_pushes) {
    Site s;
    for (int i = 0; i < 600; ++i) s.step({0.0, 0.0, 4e-3 - 4e-6 * i});
    const Vec3 in(0.0, 0.0, 1.6e-3);
    s.turns = false;
    s.steps(200, in);
    ASSERT_GT(s.force_n.norm(), 0.2);
    s.largest_step_n = 0.0;
    const double before_n = s.force_n.norm();
    s.turns = true;
    const std::uint64_t removed = s.drilling().removed_levels();
    ASSERT_TRUE(s.model->order(burr_order(DrillShape::sphere, DrillGrit::cutting, 6e-3)));
    s.steps(30, in);  // a builder's time
    EXPECT_LT(s.force_n.norm(), before_n);
    s.exchange();
    double least_n = s.force_n.norm();
    for (int i = 0; i < 100; ++i) {
        s.step(in);
        if (s.force_n.norm() > least_n) break;
        least_n = s.force_n.norm();
        ASSERT_EQ(s.drilling().removed_levels(), removed) << i;
    }
    EXPECT_LT(least_n, 1e-3);
    s.steps(400, in);
    EXPECT_GT(s.force_n.norm(), 0.2);
    EXPECT_LT(s.largest_step_n, 0.06);
    EXPECT_GT(s.drilling().removed_levels(), removed);
    // All that went is counted, by both burrs.
    EXPECT_EQ(s.drilling().removed_levels(), s.mass_before - s.mass());
    EXPECT_EQ(s.topic().hand[0].removed_levels, s.mass_before - s.mass());
}

TEST(BurrExchange, one_that_cannot_be_built_leaves_the_old_burr_and_its_force_returns) {
    Site s;
    s.turns = false;
    const Vec3 in(0.0, 0.0, 1.5e-3);
    s.steps(400, in);
    const Vec3 before_n = s.force_n;
    ASSERT_GT(before_n.norm(), 0.2);
    // 40 mm of balls of 0.5 mm: more than a tool may have.
    ASSERT_TRUE(s.model->order(burr_order(DrillShape::cylinder, DrillGrit::cutting, 1e-3, 40e-3)));
    s.steps(300, in);
    EXPECT_EQ(s.force_n, Vec3::Zero());
    EXPECT_THROW(static_cast<void>(s.model->rebuild(s.model->bodies())), StartupError);
    s.model->give_up();
    s.largest_step_n = 0.0;
    s.steps(400, in);
    EXPECT_LT((s.force_n - before_n).norm(), 1e-12);
    EXPECT_LT(s.largest_step_n, 0.06);
    EXPECT_DOUBLE_EQ(s.drilling().head_radius_m(), 2e-3);
}

// eq. 12 with a tenth of a second's exposure or less is linear: a diamond burr takes its share of what a cutting one does.
TEST(BurrExchange, a_diamond_burr_takes_its_share) {
    const auto removed = [](BurrGrit grit) {
        DrillSettings s = settings(5e-3);
        s.grit = grit;
        s.diamond_share = 0.25;
        s.rate_per_s = 2.0;
        Site site(s);
        site.turns = false;
        site.steps(300, Vec3(0.0, 0.0, 2.5e-3));
        site.turns = true;
        site.steps(50, Vec3(0.0, 0.0, 2.5e-3));
        return static_cast<double>(site.mass_before - site.mass());
    };
    const double cutting = removed(BurrGrit::cutting), diamond = removed(BurrGrit::diamond);
    ASSERT_GT(cutting, 1000.0);
    EXPECT_NEAR(diamond / cutting, 0.25, 0.02);
}

TEST(BurrExchange, speed_water_and_suction_follow_their_orders) {
    Site s;
    s.step(kAbove);
    EXPECT_NEAR(s.topic().hand[0].burr_rad_s, kFullRadS, 1e-3);
    ASSERT_TRUE(s.model->order(drive_order(CommandKind::set_burr_speed, 1000.0)));
    ASSERT_TRUE(s.model->order(drive_order(CommandKind::set_irrigation, 1e-6)));
    ASSERT_TRUE(s.model->order(drive_order(CommandKind::set_suction, 2e-4)));
    s.step(kAbove);
    DrillTopic t = s.topic();
    EXPECT_FLOAT_EQ(t.burr_rad_s_most, 1000.0F);
    EXPECT_FLOAT_EQ(t.irrigation_m3_s_most, 1e-6F);
    EXPECT_FLOAT_EQ(t.suction_m3_s_most, 2e-4F);
    // As a drive does: kSpinRadS2.
    EXPECT_NEAR(t.hand[0].burr_rad_s, kFullRadS - 20.0, 0.5);
    s.steps(300, kAbove);
    EXPECT_FLOAT_EQ(s.topic().hand[0].burr_rad_s, 1000.0F);
    ASSERT_TRUE(s.model->order(drive_order(CommandKind::set_burr_speed, 0.0)));
    ASSERT_TRUE(s.model->order(drive_order(CommandKind::set_irrigation, 0.0)));
    s.steps(100, kAbove);
    t = s.topic();
    EXPECT_EQ(t.hand[0].burr_rad_s, 0.0F);
    EXPECT_EQ(t.hand[0].irrigation, 0.0F);
    // The speed stays with the drive when the burr is changed.
    ASSERT_TRUE(s.model->order(drive_order(CommandKind::set_burr_speed, 500.0)));
    ASSERT_TRUE(s.model->order(burr_order(DrillShape::sphere, DrillGrit::cutting, 5e-3)));
    s.exchange();
    s.steps(100, kAbove);
    EXPECT_FLOAT_EQ(s.topic().hand[0].burr_rad_s, 500.0F);
}

// The next random numbers follow those of the burr before: else two burrs one after the other would round alike.
TEST(BurrExchange, the_clutch_and_a_tool_that_is_put_down_are_kept) {
    Site s;
    ASSERT_TRUE(s.model->order(burr_order(DrillShape::sphere, DrillGrit::cutting, 5e-3)));
    s.exchange();
    ToolState held = Site::tool_at({0.0, 0.0, 1.2e-3});
    held.buttons = 1;
    Budget budget;
    budget.deadline = Deadline(Instant::max());
    s.model->drive({.enabled = true, .on = true, .step_s = kStepS});
    for (int i = 0; i < 300; ++i) static_cast<void>(s.model->step(held, budget));
    EXPECT_EQ(s.mass(), s.mass_before);
    EXPECT_EQ(s.shared->pushing, 0U);  // bricks may be exchanged: no tool is felt
    s.steps(300, {0.0, 0.0, 1.2e-3});
    EXPECT_NE(s.shared->pushing, 0U);
    EXPECT_LT(s.mass(), s.mass_before);
}

}  // namespace
}  // namespace tact::burr_exchange_test
