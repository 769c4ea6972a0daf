// Stages before the model, each tested alone: wake, orders, lines, sense, pose.
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "rt/servo/stage_lines.hpp"
#include "rt/servo/stage_orders.hpp"
#include "rt/servo/stage_pose.hpp"
#include "rt/servo/stage_sense.hpp"
#include "rt/servo/stage_wake.hpp"
#include "tests/support/cycle_fixture.hpp"

namespace tact::servo_input_stages_test {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

TEST(StageWake, a_cycle_begins_at_its_planned_time_with_one_clock_reading) {
    CycleFixture f;
    const Instant planned = f.c.pacer.planned() + milliseconds(1);
    f.c.pacer.restart(planned);
    servo::wake(f.c, f.settings, f.clock);
    EXPECT_EQ(f.c.now, planned);
    EXPECT_EQ(f.c.lateness, Duration{0});
    EXPECT_EQ(f.c.cycle, 1U);
    EXPECT_EQ(f.c.step, 1U);
    EXPECT_EQ(f.c.dt, Duration{0});  // first cycle
    ASSERT_EQ(f.c.timestamps, 1U);
    EXPECT_EQ(f.c.timestamp[0], planned);
}

TEST(StageWake, a_late_cycle_measures_its_lateness_and_a_dry_one_is_never_late) {
    CycleFixture f;
    servo::wake(f.c, f.settings, f.clock);
    f.clock.advance(microseconds(1300));
    servo::wake(f.c, f.settings, f.clock);
    EXPECT_EQ(f.c.lateness, microseconds(1300));  // the planned time is unchanged
    EXPECT_EQ(f.c.dt, microseconds(1300));
    f.c.dry = true;
    servo::wake(f.c, f.settings, f.clock);
    EXPECT_EQ(f.c.lateness, Duration{0});
}

TEST(StageOrders, a_level_is_set_answered_and_recorded) {
    CycleFixture f;
    f.order(CommandKind::set_level, 0.5, kForcePathIndex);
    servo::take_orders(f.c, f.settings, f.io);
    EXPECT_EQ(f.c.report.last_sequence, 1U);
    EXPECT_EQ(f.c.report.last_result, CommandResult::done);
    EXPECT_EQ(f.c.governor.settings().law, Law::fixed);
    EXPECT_TRUE(f.c.report.health_due);
    MailboxTopic recorded{};
    RingCursor cursor;
    ASSERT_TRUE(f.region->mailbox.next(cursor, recorded));
    EXPECT_EQ(recorded.kind, static_cast<std::uint32_t>(MailboxKind::order));
    EXPECT_EQ(recorded.order.value, 0.5);
}

TEST(StageOrders, an_order_for_the_state_waits_for_the_state_machine_and_the_others_wait_for_it) {
    CycleFixture f;
    f.order(CommandKind::mark);
    f.order(CommandKind::arm);
    servo::take_orders(f.c, f.settings, f.io);
    EXPECT_TRUE(f.c.events.arm);
    EXPECT_EQ(f.c.report.last_sequence, 0U);
    f.c.run.state = RunState::armed;
    servo::answer_state_order(f.c, RunState::ready, *f.region);
    EXPECT_EQ(f.c.report.last_sequence, 2U);
    EXPECT_EQ(f.c.report.last_result, CommandResult::done);
    servo::take_orders(f.c, f.settings, f.io);
    EXPECT_FALSE(f.c.events.arm);
    EXPECT_EQ(f.c.report.last_sequence, 1U);
    EXPECT_EQ(f.c.report.state_sequence, 2U);  // still to be read by who armed
    EXPECT_EQ(f.c.report.state_result, CommandResult::done);
}

TEST(StageOrders, a_disarm_behind_a_flood_of_others_is_taken_in_the_next_cycle) {
    for (const int flood : {70, 10'000}) {
        CycleFixture f;
        for (int i = 0; i < flood; ++i) f.order(CommandKind::set_level, 0.5, kForcePathIndex);
        const ServoOrder disarm = f.order(CommandKind::disarm);
        for (int i = 0; i < flood; ++i) f.order(CommandKind::mark);
        servo::take_orders(f.c, f.settings, f.io);
        EXPECT_TRUE(f.c.events.disarm) << flood;
        EXPECT_EQ(f.c.order.sequence, disarm.sequence) << flood;
        servo::answer_state_order(f.c, RunState::armed, *f.region);
        EXPECT_EQ(f.c.report.state_sequence, disarm.sequence) << flood;
        EXPECT_EQ(f.c.report.state_result, CommandResult::done) << flood;
        MailboxTopic recorded{};
        RingCursor cursor;
        ASSERT_TRUE(f.region->mailbox.next(cursor, recorded));
        EXPECT_EQ(recorded.order.kind, static_cast<std::uint32_t>(CommandKind::disarm));
        EXPECT_EQ(recorded.order.sequence, disarm.sequence);
    }
}

TEST(StageOrders, a_disarm_wins_over_an_arm_that_is_pending_with_it_and_both_are_answered) {
    for (const bool arm_first : {true, false}) {
        CycleFixture f;
        f.c.run.state = RunState::active;
        f.order(arm_first ? CommandKind::arm : CommandKind::disarm);
        f.order(arm_first ? CommandKind::disarm : CommandKind::arm);
        servo::take_orders(f.c, f.settings, f.io);
        EXPECT_TRUE(f.c.events.disarm);
        EXPECT_FALSE(f.c.events.arm);
        f.c.run.state = RunState::ready;
        servo::answer_state_order(f.c, RunState::active, *f.region);
        std::vector<std::pair<CommandKind, CommandResult>> answers;
        for (const EventTopic& e : f.events())
            if (e.code == static_cast<std::uint16_t>(EventCode::command_done))
                answers.emplace_back(static_cast<CommandKind>(e.a), static_cast<CommandResult>(e.b));
        using Answer = std::pair<CommandKind, CommandResult>;
        const Answer arm{CommandKind::arm, CommandResult::refused_state},
            disarm{CommandKind::disarm, CommandResult::done};
        EXPECT_EQ(answers, (arm_first ? std::vector{arm, disarm} : std::vector{disarm, arm}));
        EXPECT_EQ(f.c.report.state_sequence, 2U);  // the newest
        // A replay needs both.
        MailboxTopic recorded{};
        RingCursor cursor;
        int rows = 0;
        while (f.region->mailbox.next(cursor, recorded)) ++rows;
        EXPECT_EQ(rows, 2);
        servo::take_orders(f.c, f.settings, f.io);
        EXPECT_FALSE(f.c.events.arm || f.c.events.disarm);
        servo::answer_state_order(f.c, RunState::ready, *f.region);
        EXPECT_EQ(f.events().size(), 2U);
    }
}

TEST(StageOrders, an_arm_that_is_replaced_by_a_newer_one_is_taken_once) {
    CycleFixture f;
    for (int i = 0; i < 3; ++i) f.order(CommandKind::arm);
    servo::take_orders(f.c, f.settings, f.io);
    EXPECT_EQ(f.c.order.sequence, 3U);
    servo::take_orders(f.c, f.settings, f.io);
    EXPECT_EQ(f.c.order.kind, 0U);
}

TEST(StageOrders, a_model_without_such_a_setting_refuses_it_and_an_unknown_command_is_answered) {
    CycleFixture f;
    f.order(CommandKind::set_clash, 1.0);
    servo::take_orders(f.c, f.settings, f.io);
    EXPECT_EQ(f.c.report.last_result, CommandResult::refused_value);
    f.order(static_cast<CommandKind>(999));
    servo::take_orders(f.c, f.settings, f.io);
    EXPECT_EQ(f.c.report.last_result, CommandResult::unknown);
}

TEST(StageOrders, a_visual_process_that_falls_silent_is_reported_once_and_ramps_out_where_asked) {
    ServoSettings settings;
    settings.gui_silent_ramps = true;
    CycleFixture f(settings);
    HousekeepingReport r{};
    r.gui_heartbeat_ns = to_ns(f.c.now);
    r.gui_attached = 1;
    f.mailbox.housekeeping.publish(r);
    servo::take_orders(f.c, f.settings, f.io);
    EXPECT_TRUE(f.reported(EventCode::gui_attached));
    EXPECT_FALSE(f.c.events.gui_silent);
    f.c.now += milliseconds(501);
    servo::take_orders(f.c, f.settings, f.io);
    servo::take_orders(f.c, f.settings, f.io);
    EXPECT_TRUE(f.c.events.gui_silent);
    int times = 0;
    for (const EventTopic& e : f.events())
        times += e.code == static_cast<std::uint16_t>(EventCode::gui_silent);
    EXPECT_EQ(times, 1);
}

TEST(StageLines, a_stop_bars_arming_and_old_samples_are_lost_lines) {
    CycleFixture f;
    servo::check_lines(f.c, f.settings, f.io);  // no safety inputs
    EXPECT_EQ(f.c.lines.stops, RunReason::none);
    f.fit_lines();
    servo::check_lines(f.c, f.settings, f.io);
    EXPECT_EQ(f.c.lines.stops, RunReason::none);
    EXPECT_FALSE(f.c.events.arm_barred);
    f.lines.sample.state = LinesState::stopped;
    f.lines.sample.cause = LinesCause::emergency_stop;
    servo::check_lines(f.c, f.settings, f.io);
    EXPECT_EQ(f.c.lines.stops, RunReason::emergency_stop);
    EXPECT_TRUE(f.c.events.arm_barred);
    EXPECT_TRUE(f.reported(EventCode::lines_changed));
    f.lines.sample.state = LinesState::permitted;
    f.c.now += f.settings.lines_age_max + microseconds(1);
    servo::check_lines(f.c, f.settings, f.io);
    EXPECT_EQ(f.c.lines.stops, RunReason::lines_lost);
}

TEST(StageLines, a_stop_between_two_samples_is_not_missed_once_armed) {
    CycleFixture f;
    f.fit_lines();
    f.c.run.state = RunState::armed;
    servo::rearm_lines(f.c, RunState::ready, f.io);
    servo::check_lines(f.c, f.settings, f.io);
    EXPECT_EQ(f.c.lines.stops, RunReason::none);
    ++f.lines.sample.trips;
    servo::check_lines(f.c, f.settings, f.io);
    EXPECT_EQ(f.c.lines.stops, RunReason::lines_lost);
}

TEST(StageLines, arming_re_arms_and_the_outputs_follow_the_state) {
    CycleFixture f;
    f.fit_lines();
    f.c.run.state = RunState::armed;
    servo::rearm_lines(f.c, RunState::ready, f.io);
    EXPECT_EQ(f.mailbox.pulse.rearms.load(), 1U);
    f.c.hand[0].out.enable = true;
    servo::drive_lines(f.c, f.io);
    EXPECT_TRUE(f.lines.command.enable);
    EXPECT_EQ(f.lines.command.lamp, Lamp::lit);
    EXPECT_EQ(f.mailbox.pulse.beat_ns.load(), to_ns(f.c.now));
    f.c.run.state = RunState::fault;
    servo::drive_lines(f.c, f.io);
    EXPECT_EQ(f.lines.command.lamp, Lamp::blinking);
    f.c.dry = true;
    servo::drive_lines(f.c, f.io);
    EXPECT_FALSE(f.lines.command.enable);
    EXPECT_EQ(f.lines.command.heartbeat, 3U);
}

TEST(StageLines, a_drop_by_the_supervisor_is_handled_once_and_recorded) {
    CycleFixture f;
    f.mailbox.pulse.drops.store(1);
    EXPECT_TRUE(servo::supervisor_dropped(f.c, f.io));
    EXPECT_FALSE(servo::supervisor_dropped(f.c, f.io));
    EXPECT_EQ(f.region->mailbox.pushed(), 1U);
}

TEST(StageSense, a_sample_that_is_not_finite_or_of_a_lost_device_is_not_usable) {
    CycleFixture f;
    servo::sense(f.c);
    EXPECT_TRUE(f.c.hand[0].sample_usable);
    f.device.sample.twist_dev.linear_m_s.x() = std::numeric_limits<double>::quiet_NaN();
    servo::sense(f.c);
    EXPECT_FALSE(f.c.hand[0].sample_usable);
    f.device.sample.twist_dev.linear_m_s.x() = 0.0;
    f.device.status = IoStatus::lost;
    servo::sense(f.c);
    EXPECT_FALSE(f.c.hand[0].sample_usable);
    EXPECT_EQ(f.c.hand[0].read_status, IoStatus::lost);
}

TEST(StageSense, the_oldest_sample_is_remembered) {
    CycleFixture f;
    f.device.sample.taken_at = f.c.now - milliseconds(3);
    servo::sense(f.c);
    f.device.sample.taken_at = f.c.now - milliseconds(1);
    servo::sense(f.c);
    EXPECT_EQ(f.c.hand[0].age_most, milliseconds(3));
}

TEST(StagePose, a_sample_is_turned_into_the_world_and_an_unusable_one_leaves_the_tool) {
    ServoSettings settings;
    settings.T_world_dev.p_m = Vec3(0.0, 1.0, 0.0);
    settings.T_world_dev.q = Quat(Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitZ()));
    CycleFixture f(settings);
    DeviceSample& s = f.c.hand[0].sample;
    s.T_dev_tool.p_m = Vec3(0.01, 0.0, 0.0);
    s.twist_dev.linear_m_s = Vec3(1.0, 0.0, 0.0);
    s.buttons = 2;
    servo::pose(f.c, f.settings);
    EXPECT_LT((f.c.hand[0].tool.T_world_tool.p_m - Vec3(0.0, 1.01, 0.0)).norm(), 1e-12);
    EXPECT_LT((f.c.hand[0].tool.twist_world.linear_m_s - Vec3(0.0, 1.0, 0.0)).norm(), 1e-12);
    EXPECT_EQ(f.c.hand[0].tool.buttons, 2U);
    s.T_dev_tool.p_m = Vec3(0.09, 0.0, 0.0);
    f.c.hand[0].sample_usable = false;
    servo::pose(f.c, f.settings);
    EXPECT_LT((f.c.hand[0].tool.T_world_tool.p_m - Vec3(0.0, 1.01, 0.0)).norm(), 1e-12);
}

}  // namespace
}  // namespace tact::servo_input_stages_test
