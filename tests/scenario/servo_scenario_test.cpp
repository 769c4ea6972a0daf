// The whole loop: it converges, executes commands, stops, and is repeatable to the bit.
#include <gtest/gtest.h>

#include <cstring>

#include "tests/scenario/lockstep.hpp"

namespace tact::servo_scenario_test {
namespace {

using std::chrono::milliseconds;

TEST(ServoScenario, a_spring_moves_the_emulated_hand_to_its_rest_position) {
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

TEST(ServoScenario, unarmed_there_is_no_force_and_the_hand_stays) {
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

// Each level at once, three times; then like the loop, for a second at most.
TEST(ServoScenario, dry_cycles_keep_the_pace_of_the_loop_once_the_levels_are_measured) {
    const auto warm_up_s = [](std::uint32_t cycles, bool free_running) {
        Lockstep loop;
        ServoSettings settings;
        settings.free_running = free_running;
        settings.model_deadline = false;
        settings.visual_paths = kMeshPaths;
        settings.dry_cycles = cycles;
        Servo servo({loop.clock_, std::span(loop.hands_).first(1), *loop.region_, loop.mailbox_}, settings);
        const Instant begin = loop.clock_.now();
        servo.warm_up();
        EXPECT_EQ(servo.state().govern.fit.rows().size(), 21U);
        return to_s(loop.clock_.now() - begin);
    };
    EXPECT_EQ(warm_up_s(60, false), 0.0);
    EXPECT_NEAR(warm_up_s(500, false), 1e-3 * (500 - 3 * 21), 1.5e-3);
    EXPECT_NEAR(warm_up_s(ServoSettings{}.dry_cycles, false), 1.0, 1.5e-3);
    EXPECT_EQ(warm_up_s(500, true), 0.0);
}

// Its hand would go through the bone meanwhile: no force holds it.
TEST(ServoScenario, the_hand_of_an_emulated_device_stays_while_dry_cycles_take_their_time) {
    const auto moved_m = [](bool emulated) {
        SimSettings sim;
        sim.hand.script = "wander";
        Lockstep loop({}, sim);
        ServoSettings settings;
        settings.emulated = emulated;
        settings.model_deadline = false;
        settings.visual_paths = kMeshPaths;
        settings.dry_cycles = 500;
        Servo servo({loop.clock_, std::span(loop.hands_).first(1), *loop.region_, loop.mailbox_}, settings);
        const Vec3 before_m = loop.device_.hand_pose().p_m;
        servo.warm_up();
        return (loop.device_.hand_pose().p_m - before_m).norm();
    };
    EXPECT_LT(moved_m(true), 1e-9);
    EXPECT_GT(moved_m(false), 1e-4);
}

TEST(ServoScenario, a_level_set_before_the_start_holds_from_the_first_cycle) {
    Lockstep loop;
    ServoSettings settings;
    settings.model_deadline = false;
    settings.visual_paths = kMeshPaths;
    settings.dry_cycles = 80;
    Servo servo({loop.clock_, std::span(loop.hands_).first(1), *loop.region_, loop.mailbox_}, settings);
    servo.start_at_level(kForcePathIndex, 0.3);
    servo.start_at_level(1000, 0.3);  // no such path
    servo.warm_up();
    EXPECT_EQ(servo.governor().settings().law, Law::fixed);
    for (int i = 0; i < 200; ++i) {
        servo.cycle();
        ASSERT_EQ(servo.state().budget.fidelity, 0.3F) << i;
    }
    // Other paths keep what was found for them.
    EXPECT_EQ(servo.governor().level(kDisplayPathIndex), 1.0F);
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

TEST(ServoScenario, the_force_ramps_out_when_the_hand_leaves_and_in_when_it_returns) {
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
    loop.mailbox_.stop_signal = 15;
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
    loop.mailbox_.stop_signal = 2;
    loop.cycles(200);
    EXPECT_TRUE(loop.servo_->finished());
}

// --- commands ---

TEST(ServoScenario, devices_report_samples_their_age_and_motor_heat) {
    Lockstep loop;
    loop.cycles(200);
    const DevicesTopic cool = loop.devices();
    ASSERT_EQ(cool.hand[0].valid, 1);
    EXPECT_EQ(cool.hand[1].valid, 0);
    EXPECT_GT(cool.hand[0].samples, 100U);
    EXPECT_GE(cool.hand[0].age_ns, 0);
    EXPECT_GE(cool.hand[0].age_ns_most, cool.hand[0].age_ns);
    EXPECT_LT(cool.hand[0].age_ns_most, 5'000'000);
    EXPECT_FLOAT_EQ(cool.hand[0].heat, 0.0F);
    EXPECT_GT(cool.hand[0].force_n_continuous, 0.0F);
    EXPECT_EQ(cool.hand[0].winding_c_max, 0.0F);  // the emulated device reports none
    loop.active();
    loop.cycles(2000);
    const DevicesTopic warm = loop.devices();
    EXPECT_GT(warm.hand[0].heat, 0.0F);
    EXPECT_LT(warm.hand[0].heat, 1.0F);
    EXPECT_GT(warm.hand[0].samples, cool.hand[0].samples + 1000);
}

TEST(ServoScenario, commands_are_applied_and_answered_in_order) {
    Lockstep loop;
    loop.order(CommandKind::disarm);
    loop.cycles(1);
    loop.order(CommandKind::arm);
    loop.cycles(3);
    EXPECT_EQ(loop.health().command_sequence, 2U);
    EXPECT_EQ(loop.health().command_result, static_cast<std::uint32_t>(CommandResult::done));
    EXPECT_EQ(loop.state(), RunState::active);
    loop.order(CommandKind::reset_fault);
    loop.cycles(1);
    EXPECT_EQ(loop.health().command_result, static_cast<std::uint32_t>(CommandResult::refused_state));
    loop.order(CommandKind::set_level, 0.25, kForcePathIndex);
    loop.cycles(300);
    EXPECT_EQ(loop.health().command_result, static_cast<std::uint32_t>(CommandResult::done));
    EXPECT_STREQ(loop.levels().law, "fixed");
    EXPECT_FLOAT_EQ(loop.levels().path[kForcePathIndex].level, 0.25F);
    EXPECT_EQ(loop.levels().path[kForcePathIndex].items, 250U);
    loop.order(CommandKind::set_level, 0.01, kForcePathIndex);  // below its floor
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
    EXPECT_EQ(loop.health().state_sequence, 8U);
    EXPECT_EQ(loop.health().command_sequence, 7U);  // overtaken
}

TEST(ServoScenario, no_flood_of_orders_holds_up_a_disarm_or_hides_its_answer) {
    for (const int flood : {70, 10'000}) {
        Lockstep loop;
        loop.active();
        ASSERT_EQ(loop.state(), RunState::active);
        for (int i = 0; i < flood; ++i) loop.order(CommandKind::set_goal_hz, 750.0);
        loop.order(CommandKind::disarm);
        for (int i = 0; i < flood; ++i) loop.order(CommandKind::mark);
        loop.cycles(1);
        EXPECT_EQ(loop.state(), RunState::ready);
        loop.cycles(20);
        EXPECT_EQ(loop.health().state_sequence, 2U + static_cast<std::uint64_t>(flood));
        EXPECT_EQ(loop.health().state_result, static_cast<std::uint16_t>(CommandResult::done));
    }
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

TEST(ServoScenario, a_silent_gui_is_reported_and_the_force_continues_or_ramps_out_as_configured) {
    for (const bool ramps : {false, true}) {
        ServoSettings s;
        s.gui_silent_ramps = ramps;
        Lockstep loop(s);
        loop.mailbox_.housekeeping.publish(gui_at(loop.clock_.now()));
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

// --- passing on a model ---

TEST(ServoScenario, a_new_model_enters_with_zero_force_and_the_old_one_comes_back) {
    int destroyed = 0;
    Lockstep loop;
    loop.active();
    auto fresh = std::make_unique<SpringModel>();
    fresh->rest_world_m = {0.0, 0.05, 0.0};
    fresh->destroyed = &destroyed;
    SpringModel* const raw = fresh.get();
    std::unique_ptr<ForceModel> offered = std::move(fresh);
    ASSERT_TRUE(loop.mailbox_.model.offer(offered));
    loop.cycles(1);
    EXPECT_LT(loop.shown_n(), 0.01);
    EXPECT_EQ(raw->resets, 1);
    EXPECT_EQ(loop.said(EventCode::model_swapped), 1);
    std::unique_ptr<ForceModel> old = loop.mailbox_.model.collect();
    EXPECT_EQ(old.get(), &loop.model_);
    static_cast<void>(old.release());  // owned by the fixture
    loop.cycles(4000);
    EXPECT_NEAR(loop.tool().pos_world_m[1], 0.05, 1e-4);

    // Back again, so that the one on the heap is destroyed here.
    std::unique_ptr<ForceModel> back(&loop.model_);
    ASSERT_TRUE(loop.mailbox_.model.offer(back));
    loop.cycles(1);
    loop.mailbox_.model.collect().reset();
    EXPECT_EQ(destroyed, 1);
}

}  // namespace
}  // namespace tact::servo_scenario_test
