// Stages after the force, each tested alone: publish, govern, close; and rate keeping of a free-running loop.
#include <gtest/gtest.h>

#include <set>

#include <cstring>

#include "rt/servo/fit_level.hpp"
#include "rt/servo/publish_levels.hpp"
#include "rt/servo/rate_keeping.hpp"
#include "rt/servo/record.hpp"
#include "rt/servo/stage_close.hpp"
#include "rt/servo/stage_govern.hpp"
#include "rt/servo/stage_publish.hpp"
#include "tests/support/cycle_fixture.hpp"

namespace tact::servo_output_stages_test {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

TEST(StagePublish, the_tool_is_published_each_cycle_and_health_ten_times_a_second) {
    CycleFixture f;
    f.c.report.health_at = f.c.now;
    f.c.cycle = 3;
    f.c.hand[0].shown_world.force_n = Vec3(0.1, 0.2, 0.3);
    servo::publish(f.c, f.settings, *f.region);
    EXPECT_EQ(newest(f.region->tool[0]).cycle, 3U);
    EXPECT_EQ(newest(f.region->tool[0]).force_world_n[2], 0.3);
    EXPECT_EQ(newest(f.region->bodies).count, 1U);
    EXPECT_EQ(f.region->health.count(), 0U);
    f.c.now += milliseconds(100);
    servo::publish(f.c, f.settings, *f.region);
    EXPECT_EQ(newest(f.region->health).cycle, 3U);
    EXPECT_EQ(newest(f.region->devices).hand[0].samples, 1U);
}

// Counts calls of publish().
class ShowingModel final : public ForceModel {
public:
    std::uint64_t shown_at = 0;
    double force_n = 0.0;
    [[nodiscard]] KnobSpec knob() const noexcept override { return {.path = "showing", .haptic = true}; }
    [[nodiscard]] std::uint32_t items(float /*fidelity*/) const noexcept override { return 1; }
    void reset(const ToolState& /*tool*/) noexcept override {}
    StepResult step(const ToolState& /*tool*/, const Budget& /*budget*/) noexcept override { return {}; }
    [[nodiscard]] ModelBodies bodies() const noexcept override { return {}; }
    void publish(const ModelCycle& cycle) noexcept override {
        shown_at = cycle.cycle;
        force_n = cycle.step.wrench_world.force_n.norm();
    }
};

TEST(StagePublish, a_model_publishes_its_own_topic) {
    CycleFixture f;
    ShowingModel model;
    f.c.hand[0].model = &model;
    f.c.hand[0].step.wrench_world.force_n = Vec3(0.0, 2.0, 0.0);
    f.c.cycle = 9;
    servo::publish(f.c, f.settings, *f.region);
    EXPECT_EQ(model.shown_at, 9U);
    EXPECT_EQ(model.force_n, 2.0);
}

TEST(PublishLevels, a_visual_path_publishes_items_and_cost_of_the_report) {
    CycleFixture f;
    f.c.housekeeping.gui_attached = 1;
    f.c.housekeeping.gui_vertices_max = 1000;
    f.c.housekeeping.gui_vertices = 700;
    f.c.housekeeping.gui_busy_s = 0.004;
    servo::publish_levels(f.c, f.settings, *f.region);
    const LevelsTopic t = newest(f.region->levels);
    EXPECT_EQ(t.count, 2U);
    EXPECT_STREQ(t.path[kDisplayPathIndex].path, "stub.display");
    EXPECT_EQ(t.path[kDisplayPathIndex].items, 1000U);
    EXPECT_EQ(t.path[kDisplayPathIndex].drawn, 700U);
    EXPECT_EQ(t.path[kDisplayPathIndex].cost_s, 0.004);
    EXPECT_STREQ(t.path[kForcePathIndex].path, "spring.force");
    EXPECT_EQ(t.path[kForcePathIndex].items, 1000U);
}

TEST(StageGovern,
     a_rate_below_the_goal_lowers_the_display_after_an_interval_and_leaves_the_force_to_its_cost) {
    CycleFixture f;
    servo::make_level_rows(f.c);
    servo::choose_level(f.c, f.settings);
    servo::start_interval(f.c, f.c.now);
    f.c.housekeeping.gui_attached = 1;
    servo::set_display_present(f.c, f.settings, true);
    const std::uint64_t sequence = f.c.report.levels_sequence;
    for (int i = 0; i < 400; ++i) {  // 500 Hz
        f.c.now += milliseconds(2);
        f.c.overran = true;
        ++f.c.govern.overruns;
        servo::govern(f.c, f.settings, *f.region);
    }
    EXPECT_LT(f.c.governor.level(kDisplayPathIndex), 1.0F);
    EXPECT_EQ(f.c.governor.level(kForcePathIndex), 1.0F);
    EXPECT_NEAR(f.c.govern.law_rate_hz, 500.0, 10.0);
    EXPECT_GT(f.c.report.levels_sequence, sequence);
    EXPECT_TRUE(f.reported(EventCode::level_changed));
}

// A model that does all of its work although it was asked for less leaves the rate to the display.
TEST(StageGovern, steps_that_cannot_do_less_leave_the_rate_to_the_display) {
    for (const double recomputed : {1.0, 0.5}) {
        CycleFixture f;
        f.settings.free_running = true;
        servo::make_level_rows(f.c);
        servo::choose_level(f.c, f.settings);
        const auto run_asked = [&](float asked, double done) {
            servo::start_interval(f.c, f.c.now);
            f.c.budget.work_fraction = asked;
            f.c.recomputed_fraction = done;
            for (int i = 0; i < 400; ++i) {
                f.c.now += milliseconds(1);
                servo::govern(f.c, f.settings, *f.region);
            }
        };
        run_asked(1.0F, 1.0);  // tells nothing
        EXPECT_TRUE(f.c.governor.held());
        run_asked(0.5F, recomputed);
        EXPECT_EQ(f.c.governor.held(), recomputed < 1.0);
        run_asked(0.95F, 1.0);  // slices are an eighth of the work
        EXPECT_EQ(f.c.governor.held(), recomputed < 1.0);
        run_asked(0.5F, 0.5);  // another model
        EXPECT_TRUE(f.c.governor.held());
    }
}

TEST(StageGovern, steps_that_cost_too_much_lower_the_level_at_once_with_the_reason) {
    CycleFixture f;
    servo::make_level_rows(f.c);
    servo::choose_level(f.c, f.settings);
    servo::start_interval(f.c, f.c.now);
    f.c.model_cost = microseconds(450);  // half more than predicted
    f.c.deadline_missed = true;
    f.c.budget.fidelity = f.c.governor.level(kForcePathIndex);
    for (int i = 0; i < 2; ++i) {  // in a row
        f.c.now += milliseconds(1);
        servo::govern(f.c, f.settings, *f.region);
    }
    EXPECT_LT(f.c.governor.level(kForcePathIndex), 1.0F);
    EXPECT_TRUE(f.reported(EventCode::level_changed));
    const PathLevel force = newest(f.region->levels).path[kForcePathIndex];
    EXPECT_EQ(force.reason, static_cast<std::uint8_t>(LevelReason::deadline_missed));
    EXPECT_EQ(force.changed_at_ns, to_ns(f.c.now));
    EXPECT_EQ(f.c.governor.level(kDisplayPathIndex), 1.0F);
}

TEST(StageGovern, the_law_fixed_leaves_the_level_to_the_person) {
    CycleFixture f;
    servo::make_level_rows(f.c);
    f.c.governor.set_law(Law::fixed);
    ASSERT_TRUE(f.c.governor.set_level(kForcePathIndex, 1.0));
    f.c.model_cost = milliseconds(5);
    f.c.deadline_missed = true;
    for (int i = 0; i < 500; ++i) {
        f.c.now += milliseconds(1);
        servo::govern(f.c, f.settings, *f.region);
    }
    EXPECT_EQ(f.c.governor.level(kForcePathIndex), 1.0F);
}

TEST(StageGovern, dry_cycles_try_each_level_and_the_first_armed_cycle_has_the_one_that_fits) {
    CycleFixture f;
    f.settings.period = milliseconds(1);
    servo::make_level_rows(f.c);
    f.c.dry = true;
    std::set<float> tried;
    for (int i = 0; i < 200; ++i) {
        f.c.budget.fidelity = f.c.governor.level(kForcePathIndex);
        tried.insert(f.c.budget.fidelity);
        // Five times the prediction of 300 us: 1.5 ms at level 1.
        f.c.model_cost = microseconds(static_cast<int>(1500.0F * f.c.budget.fidelity));
        servo::govern(f.c, f.settings, *f.region);
    }
    EXPECT_EQ(tried.size(), f.c.govern.fit.rows().size());
    f.c.dry = false;
    servo::choose_level(f.c, f.settings);
    EXPECT_LT(1.5 * static_cast<double>(f.c.governor.level(kForcePathIndex)), 0.7);
    EXPECT_GT(1.5 * static_cast<double>(f.c.governor.level(kForcePathIndex)), 0.45);
}

// In free space nothing costs what a contact will.
TEST(StageGovern, rows_cost_what_a_contact_is_foreseen_to_cost) {
    CycleFixture f;
    f.settings.period = milliseconds(1);
    f.model.foreseen = microseconds(250);
    servo::make_level_rows(f.c);
    for (const LevelFit::Row& row : f.c.govern.fit.rows()) EXPECT_GE(row.cost_s, 250e-6);
    // So do those that are renewed.
    f.model.foreseen = microseconds(290);
    for (int i = 0; i < 100; ++i) {
        f.c.now += milliseconds(1);
        servo::govern(f.c, f.settings, *f.region);
    }
    for (const LevelFit::Row& row : f.c.govern.fit.rows()) EXPECT_GE(row.cost_s, 290e-6);
    // Until a contact shows its own cost.
    f.model.foreseen = microseconds(0);
    for (int i = 0; i < 100; ++i) {
        f.c.now += milliseconds(1);
        servo::govern(f.c, f.settings, *f.region);
    }
    EXPECT_LT(f.c.govern.fit.rows()[0].cost_s, 250e-6);
}

TEST(StageGovern, dry_cycles_count_and_publish_no_levels) {
    CycleFixture f;
    f.c.dry = true;
    f.c.now += milliseconds(500);
    servo::govern(f.c, f.settings, *f.region);
    EXPECT_EQ(f.c.govern.cycles, 1U);
    EXPECT_EQ(f.region->levels.count(), 0U);
}

TEST(StageClose, a_cycle_is_recorded_and_traced_with_its_cost) {
    CycleFixture f;
    f.c.planned = f.c.now;
    f.c.step = 5;
    f.c.cycle = 5;
    f.c.run.state = RunState::active;
    f.c.hand[0].step.trace_flags = 1U << 17;
    f.clock.advance(microseconds(300));
    servo::close(f.c, f.settings, f.io);
    EXPECT_EQ(f.c.cost, microseconds(300));
    EXPECT_FALSE(f.c.overran);
    CycleTopic cycle{};
    HandTopic hand{};
    TraceTopic trace{};
    RingCursor a, b, t;
    ASSERT_TRUE(f.region->cycles.next(a, cycle) && f.region->hand[0].next(b, hand) &&
                f.region->trace.next(t, trace));
    EXPECT_EQ(cycle.step, 5U);
    EXPECT_EQ(cycle.cost_ns, 300000);
    EXPECT_EQ(cycle.timestamps, 1U);
    EXPECT_EQ(hand.step, 5U);
    EXPECT_EQ(trace.status, static_cast<std::uint32_t>(RunState::active) | 1U << 17);
}

TEST(StageClose, a_cycle_that_ends_after_the_next_one_is_due_overran) {
    CycleFixture f;
    f.c.planned = f.c.now;
    f.clock.advance(microseconds(1200));
    servo::close(f.c, f.settings, f.io);
    EXPECT_TRUE(f.c.overran);
    EXPECT_EQ(f.c.behind, microseconds(200));
    EXPECT_EQ(f.c.govern.overruns, 1U);
    EXPECT_TRUE(f.reported(EventCode::overrun));
}

TEST(StageClose, a_dry_cycle_is_recorded_as_one_and_leaves_no_trace) {
    CycleFixture f;
    f.c.dry = true;
    servo::close(f.c, f.settings, f.io);
    CycleTopic cycle{};
    RingCursor a;
    ASSERT_TRUE(f.region->cycles.next(a, cycle));
    EXPECT_EQ(cycle.flags, kCycleDry);
    EXPECT_EQ(f.region->trace.pushed(), 0U);
}

TEST(Record, the_start_names_the_devices) {
    CycleFixture f;
    const StartTopic t = servo::start_topic(f.settings, {&f.hand, 1}, true);
    EXPECT_EQ(t.hands, 1U);
    EXPECT_EQ(t.flags, kStartLines);
    EXPECT_EQ(t.period_ns, 1'000'000);
    EXPECT_STREQ(t.device[0].name, "stub");
}

TEST(RateKeeping, a_loop_of_fixed_rate_recomputes_all_work_and_never_sleeps) {
    CycleFixture f;
    EXPECT_EQ(servo::work_fraction(f.c, f.settings), 1.0);
    const Instant before = f.clock.now();
    EXPECT_EQ(servo::rest(f.c, f.settings, f.clock), before);
    EXPECT_EQ(f.c.timestamps, 1U);
}

TEST(RateKeeping, a_free_running_loop_behind_its_goal_reuses_part_of_its_sums) {
    ServoSettings settings;
    settings.free_running = true;
    settings.governor.law = Law::elastic;
    CycleFixture f(settings);
    double least = 1.0;
    for (int i = 0; i < 60; ++i) {
        f.c.now += milliseconds(2);  // half the goal
        least = std::min(least, servo::work_fraction(f.c, f.settings));
    }
    EXPECT_LT(least, 0.5);
}

}  // namespace
}  // namespace tact::servo_output_stages_test
