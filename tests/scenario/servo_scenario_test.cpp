// Stories of the whole loop: it converges, it is commanded, it is stopped, and it repeats to the bit.
#include <gtest/gtest.h>

#include <cstring>

#include "rt/force/drilling/drill_model.hpp"
#include "tests/scenario/lockstep.hpp"
#include "tests/support/bone_block.hpp"

namespace tact {
namespace {

using std::chrono::milliseconds;

TEST(ServoScenario, a_spring_draws_the_emulated_hand_to_its_rest) {
    Lockstep loop;
    loop.order(CommandKind::arm);
    loop.cycles(4000);
    EXPECT_EQ(loop.state(), RunState::active);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(loop.tool().pos_world_m[i], loop.model_.rest_world_m[i], 5e-5);
    }
    EXPECT_LT(loop.shown_n(), 0.01);
    const HealthTopic h = loop.health();
    EXPECT_NEAR(h.force_rate_hz, 1000.0, 1e-6);
    EXPECT_EQ(h.overruns, 0U);
    EXPECT_EQ(h.lateness_max_ns, 0);
    BodiesTopic bodies{};
    ASSERT_TRUE(loop.region_->bodies.read(bodies));
    EXPECT_EQ(bodies.count, 1U);
    EXPECT_EQ(bodies.cycle, loop.servo_->state().cycle);
    EXPECT_EQ(loop.region_->trace.pushed(), loop.servo_->state().cycle);
}

TEST(ServoScenario, unarmed_it_shows_no_force_and_the_hand_stays) {
    Lockstep loop;
    loop.cycles(1000);
    EXPECT_EQ(loop.state(), RunState::ready);
    EXPECT_EQ(loop.shown_n(), 0.0);
    EXPECT_DOUBLE_EQ(loop.device_.hand_pose().p_m.norm(), 0.0);
    EXPECT_GT(
        Vec3(loop.tool().force_model_n[0], loop.tool().force_model_n[1], loop.tool().force_model_n[2]).norm(),
        1.0);
}

TEST(ServoScenario, the_force_ramps_in_and_never_steps) {
    Lockstep loop;
    loop.order(CommandKind::arm);
    double before = 0.0;
    for (int i = 0; i < 700; ++i) {
        loop.cycles(1);
        EXPECT_LT(std::abs(loop.shown_n() - before), 0.02);
        before = loop.shown_n();
    }
    EXPECT_GT(before, 0.0);
}

TEST(ServoScenario, the_same_run_twice_writes_the_same_bytes) {
    const auto run = [] {
        SimSettings sim;
        sim.hand.script = "wander";
        sim.hand.seed = 11;
        auto loop = std::make_unique<Lockstep>(ServoSettings{}, sim);
        loop->order(CommandKind::arm);
        loop->cycles(3000);
        loop->model_.not_a_number = true;
        loop->cycles(50);
        return loop;
    };
    const auto a = run(), b = run();
    EXPECT_EQ(std::memcmp(static_cast<const void*>(a->region_.get()),
                          static_cast<const void*>(b->region_.get()), sizeof(RtRegion)),
              0);
    EXPECT_GT(a->device_.hand_pose().p_m.norm(), 1e-3);
}

TEST(ServoScenario, the_hand_leaving_takes_the_force_out_and_its_return_ramps_it_in) {
    Lockstep loop;
    loop.active();
    loop.device_.inject(SimFault::hand_off);
    loop.cycles(1);
    EXPECT_EQ(loop.state(), RunState::armed);
    loop.cycles(55);
    EXPECT_EQ(loop.shown_n(), 0.0);
    loop.device_.inject(SimFault::none);
    loop.cycles(2);
    EXPECT_EQ(loop.state(), RunState::active);
    EXPECT_LT(loop.shown_n(), 0.02);
}

// --- stopping ---

TEST(ServoScenario, a_signal_ramps_to_zero_within_a_tenth_of_a_second_and_ends_with_the_amplifier_off) {
    Lockstep loop;
    loop.active();
    const double before = loop.shown_n();
    loop.mail_.stop_signal = 15;
    loop.cycles(1);
    EXPECT_GT(loop.shown_n(), 0.5 * before);  // a ramp, not a step
    const Instant begin = loop.clock_.now();
    loop.cycles(1000);
    EXPECT_TRUE(loop.servo_->finished());
    EXPECT_LE(loop.clock_.now() - begin, milliseconds(100));
    EXPECT_EQ(loop.shown_n(), 0.0);
    EXPECT_EQ(loop.device_.state(), DeviceState::ready);
    EXPECT_EQ(loop.state(), RunState::off);
    EXPECT_EQ(loop.health().state, static_cast<std::uint8_t>(RunState::off));
}

TEST(ServoScenario, a_signal_ends_a_faulted_loop_as_well) {
    Lockstep loop;
    loop.active();
    loop.device_.inject(SimFault::unplugged);
    loop.cycles(10);
    loop.mail_.stop_signal = 2;
    loop.cycles(200);
    EXPECT_TRUE(loop.servo_->finished());
}

// --- commands ---

TEST(ServoScenario, commands_are_obeyed_and_answered_in_order) {
    Lockstep loop;
    loop.order(CommandKind::disarm);
    loop.order(CommandKind::arm);
    loop.cycles(3);
    EXPECT_EQ(loop.health().command_sequence, 2U);
    EXPECT_EQ(loop.health().command_result, static_cast<std::uint32_t>(CommandResult::done));
    EXPECT_EQ(loop.state(), RunState::active);
    loop.order(CommandKind::reset_fault);
    loop.cycles(1);
    EXPECT_EQ(loop.health().command_result, static_cast<std::uint32_t>(CommandResult::refused_state));
    loop.order(CommandKind::set_level, 0.25, Servo::kForceIndex);
    loop.cycles(300);
    EXPECT_EQ(loop.health().command_result, static_cast<std::uint32_t>(CommandResult::done));
    EXPECT_STREQ(loop.levels().law, "fixed");
    EXPECT_FLOAT_EQ(loop.levels().path[Servo::kForceIndex].level, 0.25F);
    EXPECT_EQ(loop.levels().path[Servo::kForceIndex].items, 250U);
    loop.order(CommandKind::set_level, 0.01, Servo::kForceIndex);  // below its floor
    loop.cycles(1);
    EXPECT_EQ(loop.health().command_result, static_cast<std::uint32_t>(CommandResult::refused_value));
    loop.order(CommandKind::set_goal_hz, 750.0);
    loop.order(CommandKind::set_fidelity_auto);
    loop.order(CommandKind::disarm);
    loop.cycles(60);
    EXPECT_DOUBLE_EQ(loop.health().goal_hz, 750.0);
    EXPECT_STREQ(loop.levels().law, "elastic");
    EXPECT_EQ(loop.state(), RunState::ready);
    EXPECT_EQ(loop.shown_n(), 0.0);
    EXPECT_EQ(loop.health().command_sequence, 8U);
}

TEST(ServoScenario, a_refused_command_is_answered_without_effect) {
    Lockstep loop;
    loop.order(CommandKind::none, 0.0, static_cast<std::uint32_t>(CommandResult::refused_value));
    loop.cycles(1);
    EXPECT_EQ(loop.health().command_sequence, 1U);
    EXPECT_EQ(loop.health().command_result, static_cast<std::uint32_t>(CommandResult::refused_value));
    EXPECT_EQ(loop.state(), RunState::ready);
}

// --- the visual process ---

TEST(ServoScenario, a_silent_gui_is_said_and_the_force_goes_on_or_ramps_out_as_configured) {
    for (const bool ramps : {false, true}) {
        ServoSettings s;
        s.gui_silent_ramps = ramps;
        Lockstep loop(s);
        loop.mail_.house.publish(gui_at(loop.clock_.now()));
        loop.order(CommandKind::arm);
        loop.cycles(499);
        EXPECT_EQ(loop.state(), RunState::active);
        EXPECT_EQ(loop.said(EventCode::gui_silent), 0);
        loop.cycles(100);
        EXPECT_EQ(loop.said(EventCode::gui_silent), 1);
        EXPECT_EQ(loop.state(), ramps ? RunState::ready : RunState::active);
        EXPECT_EQ(loop.shown_n() == 0.0, ramps);
        if (ramps) {
            EXPECT_EQ(loop.reason(), RunReason::gui_silent);
        }
        EXPECT_EQ(loop.said(EventCode::gui_attached), 1);
    }
}

// --- handing a model over ---

TEST(ServoScenario, a_new_model_enters_with_zero_force_and_the_old_one_comes_back) {
    int destroyed = 0;
    Lockstep loop;
    loop.active();
    auto fresh = std::make_unique<SpringModel>();
    fresh->rest_world_m = {0.0, 0.05, 0.0};
    fresh->destroyed = &destroyed;
    SpringModel* const raw = fresh.get();
    std::unique_ptr<ForceModel> offered = std::move(fresh);
    ASSERT_TRUE(loop.mail_.model.offer(offered));
    loop.cycles(1);
    EXPECT_LT(loop.shown_n(), 0.01);
    EXPECT_EQ(raw->resets, 1);
    EXPECT_EQ(loop.said(EventCode::model_swapped), 1);
    std::unique_ptr<ForceModel> old = loop.mail_.model.collect();
    EXPECT_EQ(old.get(), &loop.model_);
    static_cast<void>(old.release());  // the fixture's own
    loop.cycles(4000);
    EXPECT_NEAR(loop.tool().pos_world_m[1], 0.05, 1e-4);

    // Back again, so that the one on the heap is destroyed here.
    std::unique_ptr<ForceModel> back(&loop.model_);
    ASSERT_TRUE(loop.mail_.model.offer(back));
    loop.cycles(1);
    loop.mail_.model.collect().reset();
    EXPECT_EQ(destroyed, 1);
}

// A wall of bone some 5 mm away from the hand at rest, and a hand that presses a burr into it.
struct DrillScenario {
    BoneBlock block{64, 5e-4, [](const Vec3& v) { return v.z() < 22.0 ? 1.0 : 0.0; }, 1};
    DrillBone bone{block.bricks, block.density, block.revision};
    DrillModel model{meta(), bone, burr()};
    Lockstep loop;

    explicit DrillScenario(bool pedal) : loop(settings(pedal), sim(), nullptr, &model) {}

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
        return s;
    }
    static ServoSettings settings(bool pedal) {
        ServoSettings s;
        s.burr_rad_s = 6283.0;
        s.burr_always = pedal;
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

TEST(DrillScenario, without_the_pedal_the_burr_stands_and_the_bone_holds_the_hand) {
    DrillScenario drill(false);
    drill.loop.active();
    drill.loop.cycles(3000);
    EXPECT_EQ(drill.model.removed_levels(), 0U);
    EXPECT_GT(drill.loop.shown_n(), 0.2);
    EXPECT_GT(drill.loop.tool().pos_world_m[2], -6.5e-3);  // the wall is at -5.25 mm, the burr's radius 2
    EXPECT_LT(drill.loop.tool().pos_world_m[2], -3.25e-3);
}

TEST(DrillScenario, what_the_tool_is_and_took_is_published) {
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

}  // namespace
}  // namespace tact
