// Drilling in the whole loop, in lockstep: when and how much is cut, two hands on one bone, pedals, published data.
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <numeric>

#include "hal/sim/sim_lines.hpp"
#include "rt/force/drilling/drill_model.hpp"
#include "rt/force/drilling/drill_publisher.hpp"
#include "rt/threads/model_builder.hpp"
#include "tests/scenario/lockstep.hpp"
#include "tests/support/bone_block.hpp"

namespace tact::drill_scenario_test {
namespace {

// A wall of bone about 5 mm from the hand at rest, and a hand that presses a burr into it.
struct DrillScenario {
    BoneBlock block{64, 5e-4, [](const Vec3& v) { return v.z() < 22.0 ? 1.0 : 0.0; }, 1};
    DrillBone bone{block.bricks, block.density, block.revision};
    DrillModel model{meta(), bone, burr()};
    Lockstep loop;
    DrillPublisher publisher{loop.region_->drill, loop.region_->touch, {.irrigation_m3_s = 3e-7}};

    explicit DrillScenario(bool pedal)
        : loop({}, sim(), nullptr, &model, {},
               {pedal ? DriveSwitch::always : DriveSwitch::button, kLineBurr}) {
        model.publish_to(publisher);
    }

    static SceneMeta meta() {
        SceneMeta m{};
        m.kind = SceneKind::drilling;
        m.world_per_model = 1.0;
        for (double& c : m.centre_model_m) c = 0.016;
        return m;
    }
    static DrillSettings burr() {
        DrillSettings s;
        s.tool.radius_m = 2e-3;
        s.tool.shaft_radius_m = 0.0;
        s.burr_rad_s = 6283.0;
        return s;
    }
    static SimSettings sim() {
        SimSettings s;
        s.hand.script = "drill";
        s.hand.press_m = 0.012;
        return s;
    }
};

TEST(DrillScenario, bone_is_cut_only_while_the_force_is_on) {
    DrillScenario drill(true);
    drill.loop.cycles(2000);  // the hand is in the bone by then
    EXPECT_EQ(drill.loop.state(), RunState::ready);
    EXPECT_EQ(drill.model.removed_levels(), 0U);
    drill.loop.order(CommandKind::arm);
    drill.loop.cycles(2000);
    EXPECT_EQ(drill.loop.state(), RunState::active);
    const std::uint64_t cut = drill.model.removed_levels();
    EXPECT_GT(cut, 255U * 20U);
    drill.loop.order(CommandKind::disarm);
    drill.loop.cycles(2);
    const std::uint64_t then = drill.model.removed_levels();
    drill.loop.cycles(1000);
    EXPECT_EQ(drill.model.removed_levels(), then);
}

TEST(DrillScenario, without_the_pedal_the_burr_is_still_and_the_bone_stops_the_hand) {
    DrillScenario drill(false);
    drill.loop.active();
    drill.loop.cycles(3000);
    EXPECT_EQ(drill.model.removed_levels(), 0U);
    EXPECT_GT(drill.loop.shown_n(), 0.2);
    EXPECT_GT(drill.loop.tool().pos_world_m[2],
              -6.5e-3);  // the wall is at -5.25 mm, the burr's radius is 2 mm
    EXPECT_LT(drill.loop.tool().pos_world_m[2], -3.25e-3);
}

TEST(DrillScenario, the_tool_and_the_removed_bone_are_published) {
    DrillScenario drill(true);
    drill.loop.active();
    drill.loop.cycles(2000);
    const DrillTopic t = drill.loop.drill();
    EXPECT_EQ(t.cycle, drill.loop.tool().cycle);
    EXPECT_EQ(t.removed_levels, drill.model.removed_levels());
    EXPECT_NEAR(t.level_m3 * static_cast<double>(t.removed_levels), drill.model.removed_m3(), 1e-15);
    const DrillHand& burr = t.hand[0];
    EXPECT_EQ(burr.kind, DrillKind::burr);
    EXPECT_EQ(burr.shape, DrillShape::sphere);
    EXPECT_FLOAT_EQ(burr.radius_m, 2e-3F);
    EXPECT_FLOAT_EQ(burr.length_m, 4e-3F);
    EXPECT_FLOAT_EQ(burr.burr_rad_s, 6283.0F);
    EXPECT_EQ(burr.irrigation, 1.0F);
    EXPECT_EQ(burr.removed_levels, t.removed_levels);
    EXPECT_EQ(burr.cut_levels, drill.model.cut().removed);
    EXPECT_GT(burr.depth, 0.0F);
    EXPECT_GT(burr.elastic_n, 0.0F);
    EXPECT_NEAR(burr.pos_model_m[2], drill.loop.tool().pos_world_m[2] + 0.016, 1e-12);
    EXPECT_EQ(t.hand[1].kind, DrillKind::none);
    drill.loop.order(CommandKind::disarm);
    drill.loop.cycles(2);
    EXPECT_EQ(drill.loop.drill().hand[0].burr_rad_s, 0.0F);
    EXPECT_EQ(drill.loop.drill().hand[0].irrigation, 0.0F);
}

TEST(DrillScenario, the_same_run_leaves_the_same_bone) {
    const auto run = [] {
        DrillScenario drill(true);
        drill.loop.active();
        drill.loop.cycles(2000);
        return std::pair(drill.block.density, drill.loop.tool().pos_world_m[2]);
    };
    EXPECT_EQ(run(), run());
}

// An emulated surgeon and the hand with the suction tube at the same block of bone.
struct TwoHands {
    BoneBlock block{96, 5e-4, [](const Vec3& v) { return v.z() < 40.0 ? 1.0 : 0.0; }, 1};
    DrillBone bone{block.bricks, block.density, block.revision};
    DrillModel burr{meta(), bone, turning()}, suction_tube{meta(), bone, tube()};
    SimLines lines;
    Lockstep loop;
    DrillPublisher publisher{loop.region_->drill, loop.region_->touch, {.suction_m3_s = 3e-4}};

    explicit TwoHands(DriveSwitch burr_switch = DriveSwitch::button,
                      DriveSwitch suction_switch = DriveSwitch::button)
        : loop({}, hand("surgeon"), opened(), &burr,
               {hand("suction-tube"), &suction_tube, {suction_switch, kLineSuction}},
               {burr_switch, kLineBurr}) {
        burr.publish_to(publisher);
        suction_tube.publish_to(publisher);
    }

    Lines* opened() {
        static_cast<void>(lines.open());
        return &lines;
    }
    static SceneMeta meta() {  // the wall is 10 mm from the hands at rest
        SceneMeta m{};
        m.kind = SceneKind::drilling;
        m.world_per_model = 1.0;
        m.centre_model_m[0] = m.centre_model_m[1] = 0.024;
        m.centre_model_m[2] = 0.030;
        return m;
    }
    static DrillSettings tube() {
        DrillSettings s;
        s.tool.cuts = false;
        s.tool.radius_m = s.tool.shaft_radius_m = 1e-3;
        return s;
    }
    static SimSettings hand(const char* script) {
        SimSettings s;
        s.hand.script = script;
        return s;
    }
    static DrillSettings turning() {
        DrillSettings s;
        s.burr_rad_s = 6283.0;
        return s;
    }
    [[nodiscard]] std::uint64_t mass() const {
        return std::accumulate(block.density.begin(), block.density.end(), std::uint64_t{0});
    }
    // Holds the hands until the lines have 30 samples.
    void active() {
        loop.cycles(60);
        loop.active();
    }
};

TEST(TwoHandsScenario, the_burr_cuts_the_suction_tube_does_not_and_each_has_its_own_force) {
    TwoHands t;
    const std::uint64_t whole = t.mass();
    t.active();
    double pressed_n = 0.0, suction_tube_n = 0.0;
    bool lifted = false, sucked = false;
    for (int i = 0; i < 14000; ++i) {
        t.loop.cycles(1);
        const DrillTopic d = t.loop.drill();
        ASSERT_EQ(d.hand[0].kind, DrillKind::burr);
        ASSERT_EQ(d.hand[1].kind, DrillKind::suction_tube);
        ASSERT_EQ(d.hand[1].burr_rad_s, 0.0F);
        ASSERT_EQ(d.hand[0].suction, 0.0F);
        pressed_n = std::max(pressed_n, t.loop.device_.shown_dev().force_n.norm());
        suction_tube_n = std::max(suction_tube_n, t.loop.device2_.shown_dev().force_n.norm());
        sucked = sucked || d.hand[1].suction == 1.0F;
        lifted = lifted || (d.removed_levels > 0 && d.hand[0].burr_rad_s == 0.0F && d.hand[0].depth == 0.0F);
    }
    EXPECT_EQ(t.loop.state(), RunState::active);
    EXPECT_GT(pressed_n, 0.3);
    EXPECT_LT(pressed_n, 3.0);
    EXPECT_GT(suction_tube_n, 0.05);
    EXPECT_LT(suction_tube_n, 1.0);
    EXPECT_TRUE(sucked);
    EXPECT_TRUE(lifted);
    EXPECT_GT(t.burr.removed_m3(), 20e-9);
    EXPECT_EQ(t.suction_tube.removed_levels(), 0U);
    EXPECT_EQ(t.loop.drill().removed_levels, t.burr.removed_levels());
    EXPECT_EQ(t.mass() + t.burr.removed_levels(), whole);
}

TEST(TwoHandsScenario, the_same_seed_leaves_the_same_bone) {
    const auto run = [] {
        TwoHands t;
        t.active();
        t.loop.cycles(6000);
        return std::pair(t.block.density, t.loop.device2_.hand_pose().p_m);
    };
    EXPECT_EQ(run(), run());
}

TEST(TwoHandsScenario, one_foot_pedal_drives_the_burr_and_another_one_the_suction) {
    TwoHands t(DriveSwitch::line, DriveSwitch::line);
    t.active();
    t.loop.cycles(500);
    EXPECT_EQ(t.loop.drill().hand[0].burr_rad_s, 0.0F);
    EXPECT_EQ(t.loop.drill().hand[1].suction, 0.0F);
    t.lines.board().press(kLineBurr);
    t.loop.cycles(3);
    EXPECT_GT(t.loop.drill().hand[0].burr_rad_s, 6000.0F);
    EXPECT_EQ(t.loop.drill().hand[1].suction, 0.0F);
    t.lines.board().press(kLineSuction);
    t.loop.cycles(3);
    EXPECT_EQ(t.loop.drill().hand[0].burr_rad_s, 0.0F);
    EXPECT_EQ(t.loop.drill().hand[1].suction, 1.0F);
    t.lines.board().press(kLineBurr | kLineSuction);
    t.loop.cycles(3);
    EXPECT_EQ(t.loop.state(), RunState::active);
    // An unreadable board: pedals count as released, in addition to its other effects.
    t.lines.inject(LinesFault::unplugged);
    t.loop.cycles(3);
    EXPECT_EQ(t.loop.drill().hand[0].burr_rad_s, 0.0F);
    EXPECT_EQ(t.loop.drill().hand[1].suction, 0.0F);
}

TEST(TwoHandsScenario, a_lost_suction_tube_stops_both_hands) {
    TwoHands t;
    t.active();
    t.loop.cycles(6000);
    ASSERT_GT(t.burr.removed_levels(), 0U);
    t.loop.device2_.inject(SimFault::unplugged);
    t.loop.cycles(200);
    EXPECT_EQ(t.loop.state(), RunState::fault);
    EXPECT_EQ(t.loop.drill().hand[0].burr_rad_s, 0.0F);
    EXPECT_EQ(t.loop.shown_n(), 0.0);
}

// An order to the servo, a model from the builder's thread: another burr, at the level that fits it, in a run that goes on.
TEST(DrillScenario, another_burr_is_built_aside_and_taken_while_the_hand_drills) {
    BoneBlock block{64, 5e-4, [](const Vec3& v) { return v.z() < 22.0 ? 1.0 : 0.0; }, 1};
    DrillBone bone{block.bricks, block.density, block.revision};
    auto first = std::make_unique<DrillModel>(DrillScenario::meta(), bone, DrillScenario::burr());
    DrillModel* const burr = first.get();
    Lockstep loop({}, DrillScenario::sim(), nullptr, burr, {}, {DriveSwitch::always, kLineBurr});
    DrillPublisher publisher{loop.region_->drill, loop.region_->touch, {}};
    burr->publish_to(publisher);
    ModelBuilder builder(loop.mailbox_, gettid());
    loop.active();
    loop.cycles(1500);
    const std::uint64_t removed = loop.drill().removed_levels, levels = loop.levels().sequence;
    ASSERT_GT(removed, 0U);
    const auto order = [&](double diameter_m) {
        loop.mailbox_.orders.push({.sequence = ++loop.sequence_,
                                   .value = diameter_m,
                                   .kind = static_cast<std::uint32_t>(CommandKind::set_burr),
                                   .index = 0,
                                   .body = 256U * static_cast<std::uint32_t>(DrillGrit::diamond)});
        loop.cycles(1);
        return static_cast<CommandResult>(loop.health().command_result & 0xFFFFU);
    };
    EXPECT_EQ(order(0.5e-3), CommandResult::refused_value);  // below a voxel
    EXPECT_EQ(order(6e-3), CommandResult::done);
    EXPECT_EQ(loop.drill().changing_burr, 1);
    EXPECT_EQ(order(5e-3), CommandResult::refused_value);  // one at a time
    for (int i = 0; i < 20000 && loop.drill().changing_burr == 1; ++i) {
        builder.poll();
        static_cast<void>(first.release());  // the servo gave it back, and collect() frees it
        loop.mailbox_.model.collect().reset();
        loop.cycles(2);
        ::poll(nullptr, 0, 1);
    }
    DrillTopic t = loop.drill();
    EXPECT_FLOAT_EQ(t.hand[0].radius_m, 3e-3F);
    EXPECT_EQ(t.hand[0].grit, DrillGrit::diamond);
    EXPECT_EQ(loop.said(EventCode::model_swapped), 1);
    EXPECT_GT(loop.levels().sequence, levels);  // the governor knows the new cost
    loop.cycles(2000);
    loop.mailbox_.model.collect().reset();
    EXPECT_EQ(loop.state(), RunState::active);
    t = loop.drill();
    EXPECT_GT(t.removed_levels, removed);
    // Every level that is missing was published, whichever burr took it.
    const auto whole = std::uint64_t{255} * 64 * 64 * 22;
    EXPECT_EQ(t.removed_levels,
              whole - std::accumulate(block.density.begin(), block.density.end(), std::uint64_t{0}));
    // The last model is the servo's, until the loop ends.
    const std::unique_ptr<ForceModel> last(loop.servo_->state().hand[0].model);
}

}  // namespace
}  // namespace tact::drill_scenario_test
