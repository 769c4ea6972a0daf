// Stages between pose and force, each tested alone: model exchange, model, shape, safety, actuate.
#include <gtest/gtest.h>

#include "rt/servo/model_exchange.hpp"
#include "rt/servo/stage_actuate.hpp"
#include "rt/servo/stage_model.hpp"
#include "rt/servo/stage_safety.hpp"
#include "rt/servo/stage_shape.hpp"
#include "tests/support/cycle_fixture.hpp"

namespace tact::servo_force_stages_test {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

TEST(ModelExchange, another_model_enters_with_a_reset_and_the_old_one_goes_back) {
    CycleFixture f;
    auto* const fresh = new SpringModel;
    std::unique_ptr<ForceModel> offered(fresh);
    ASSERT_TRUE(f.mailbox.model.offer(offered));
    servo::exchange_models(f.c, f.settings, f.io);
    EXPECT_EQ(f.c.hand[0].model, fresh);
    EXPECT_EQ(fresh->resets, 1);
    EXPECT_TRUE(f.reported(EventCode::model_swapped));
    EXPECT_EQ(f.mailbox.model.collect().release(), &f.model);  // the fixture's own
    delete fresh;
}

// Keeps its last drive input.
class DrivenModel final : public ForceModel {
public:
    ToolDrive driven;
    [[nodiscard]] KnobSpec knob() const noexcept override {
        return {.path = "driven", .floor = 0.1F, .start = 1.0F, .haptic = true};
    }
    [[nodiscard]] std::uint32_t items(float /*fidelity*/) const noexcept override { return 1; }
    void reset(const ToolState& /*tool*/) noexcept override {}
    void drive(const ToolDrive& drive) noexcept override { driven = drive; }
    StepResult step(const ToolState& /*tool*/, const Budget& /*budget*/) noexcept override { return {}; }
    [[nodiscard]] ModelBodies bodies() const noexcept override { return {}; }
};

TEST(StageModel, the_model_steps_at_the_governors_level_between_two_readings_of_the_clock) {
    CycleFixture f;
    f.model.clock = &f.clock;
    f.model.cost = microseconds(40);
    servo::step_models(f.c, f.settings, f.io);
    EXPECT_EQ(f.c.budget.fidelity, 1.0F);
    EXPECT_EQ(f.c.model_cost, microseconds(40));
    EXPECT_EQ(f.c.timestamps, 2U);
    EXPECT_EQ(f.c.recomputed_fraction, 1.0);
    EXPECT_LT((f.c.hand[0].step.wrench_world.force_n - 40.0 * f.model.rest_world_m).norm(), 1e-12);
}

TEST(StageModel, a_repeated_cycle_has_the_recorded_level) {
    CycleFixture f;
    const CycleScript script{.level = 0.25F, .deadline_check = {3, 0}};
    f.io.script = &script;
    servo::step_models(f.c, f.settings, f.io);
    EXPECT_EQ(f.c.budget.fidelity, 0.25F);
    EXPECT_TRUE(f.c.hand[0].deadline.replayed);
    EXPECT_EQ(f.c.hand[0].deadline.passed_at, 3U);
}

TEST(StageModel, a_tool_is_driven_while_its_switch_and_the_force_are_on) {
    CycleFixture f;
    DrivenModel model;
    f.c.hand[0].model = &model;
    f.c.dt = milliseconds(2);
    const auto on = [&] {
        servo::step_models(f.c, f.settings, f.io);
        return model.driven.on;
    };
    f.c.hand[0].tool.buttons = kDriveButton;
    EXPECT_FALSE(on());  // no force
    EXPECT_FALSE(model.driven.enabled);
    f.c.run.state = RunState::active;
    EXPECT_TRUE(on());
    EXPECT_DOUBLE_EQ(model.driven.step_s, 2e-3);
    f.c.dry = true;
    EXPECT_FALSE(on());
    f.c.dry = false;
    f.c.hand[0].tool.buttons = 0;
    EXPECT_FALSE(on());
    EXPECT_TRUE(model.driven.enabled);
    f.c.hand[0].drive.by = DriveSwitch::always;
    EXPECT_TRUE(on());
}

TEST(StageModel, a_line_that_cannot_be_read_switches_nothing_on) {
    CycleFixture f;
    DrivenModel model;
    f.c.hand[0].model = &model;
    f.c.hand[0].drive = {DriveSwitch::line, 1U << 4};
    f.c.run.state = RunState::active;
    f.c.lines.sample.sequence = 1;
    f.c.lines.sample.inputs = 1U << 4;
    const auto on = [&] {
        servo::step_models(f.c, f.settings, f.io);
        return model.driven.on;
    };
    EXPECT_FALSE(on());  // no safety inputs
    f.c.lines.fitted = true;
    EXPECT_TRUE(on());
    f.c.lines.age = f.settings.lines_age_max + microseconds(1);
    EXPECT_FALSE(on());
    f.c.lines.age = Duration{0};
    f.c.lines.sample.inputs = 1U << 5;
    EXPECT_FALSE(on());
}

TEST(StageShape, a_force_is_scaled_and_damped) {
    ServoSettings settings;
    settings.force_scale = 0.5;
    settings.damping_n_s_m = 2.0;
    settings.hand_damping_n_s_m = 1e6;  // no bound
    CycleFixture f(settings);
    f.c.bounds = {1e9, 1e9, 1e9};
    HandCycle& h = f.c.hand[0];
    h.step.wrench_world.force_n = Vec3(1.0, 0.0, 0.0);
    h.tool.twist_world.linear_m_s = Vec3(0.0, 0.1, 0.0);
    servo::shape(f.c, f.settings);
    EXPECT_LT((h.wanted_world.force_n - Vec3(0.5, -0.2, 0.0)).norm(), 1e-12);
}

TEST(StageShape, at_a_delay_the_walls_are_no_stiffer_than_is_stable) {
    CycleFixture f;
    f.c.statistics.metrics.delay_p99_ns = 20'000'000;
    servo::bound_by_delay(f.c, f.settings);
    const double bound = f.c.bounds.stiffness_n_m;
    EXPECT_GT(bound, 0.0);
    ASSERT_LT(bound, f.c.hand[0].chain.settings().wall_stiffness_n_m);
    servo::shape(f.c, f.settings);
    EXPECT_NEAR(f.c.hand[0].walls.gain(), bound / f.c.hand[0].chain.settings().wall_stiffness_n_m, 1e-9);
    f.c.statistics.metrics.delay_p99_ns = 0;
    servo::bound_by_delay(f.c, f.settings);
    EXPECT_GT(f.c.bounds.stiffness_n_m, bound);
}

// Mass over half a period plus the delay.
TEST(StageShape, at_a_delay_the_damping_is_no_larger_than_is_stable) {
    ServoSettings settings;
    settings.damping_n_s_m = 20.0;
    CycleFixture f(settings);
    f.c.statistics.metrics.delay_p99_ns = 20'000'000;
    servo::bound_by_delay(f.c, f.settings);
    ASSERT_NEAR(f.c.bounds.damping_n_s_m, 0.1 / 0.0205, 1e-9);
    f.c.hand[0].tool.twist_world.linear_m_s = Vec3(0.0, 0.1, 0.0);
    servo::shape(f.c, f.settings);
    EXPECT_NEAR(f.c.hand[0].wanted_world.force_n.y(), -0.1 * f.c.bounds.damping_n_s_m, 1e-9);
}

// Damping of hand and arm over half the measured period plus the delay.
TEST(StageShape, the_stiffness_that_is_stable_follows_the_measured_period) {
    for (const double rate_hz : {4000.0, 700.0}) {
        CycleFixture f;
        f.c.statistics.metrics.delay_p99_ns = 1'000'000;
        Instant now = f.c.now;
        f.c.statistics.rate.start(now);
        for (int slot = 0; slot < 10; ++slot) {
            for (int i = 0; i < static_cast<int>(0.1 * rate_hz); ++i) f.c.statistics.rate.count();
            now += milliseconds(100);
            f.c.statistics.rate.turn(now);
        }
        servo::bound_by_delay(f.c, f.settings);
        EXPECT_NEAR(f.c.bounds.stiffness_n_m, f.settings.hand_damping_n_s_m / (0.5 / rate_hz + 1e-3), 1e-6);
    }
}

class StiffModel final : public ForceModel {
public:
    [[nodiscard]] KnobSpec knob() const noexcept override { return {}; }
    [[nodiscard]] ModelStiffness stiffness() const noexcept override {
        return {.force_n_m = 2000.0, .torque_n_m_rad = torque_n_m_rad};
    }
    double torque_n_m_rad = 0.0;
    void reset(const ToolState&) noexcept override {}
    StepResult step(const ToolState&, const Budget&) noexcept override { return {}; }
    [[nodiscard]] ModelBodies bodies() const noexcept override { return {}; }
    [[nodiscard]] std::uint32_t items(float) const noexcept override { return 0; }
    [[nodiscard]] PathLoad predict(float) const noexcept override { return {}; }
};

// A stiff field that pushes and turns, at a device that can do both.
struct StiffCycle : CycleFixture {
    StiffModel stiff;
    HandCycle& h = c.hand[0];
    StiffCycle() {
        h.model = &stiff;
        h.torque = true;
        h.step.wrench_world = {Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.02, 0.0)};
    }
    void expect_a_quarter() {
        servo::shape(c, settings);
        EXPECT_NEAR(h.wanted_world.force_n.x(), 0.25, 1e-9);
        EXPECT_NEAR(h.wanted_world.torque_n_m.y(), 0.25 * 0.02, 1e-12);
    }
};

TEST(StageShape, at_a_delay_force_and_torque_of_a_stiff_field_are_reduced_alike) {
    StiffCycle f;
    f.c.bounds = {500.0, 1e9, 1e9};
    f.expect_a_quarter();
    f.h.torque = false;  // a device of three axes
    servo::shape(f.c, f.settings);
    EXPECT_EQ(f.h.wanted_world.torque_n_m, Vec3::Zero());
}

// Force and torque shrink together, whichever is too stiff.
TEST(StageShape, a_field_that_is_too_stiff_in_rotation_is_reduced) {
    StiffCycle f;
    f.stiff.torque_n_m_rad = 4.0;
    f.c.bounds = {1e9, 1e9, 1.0};
    f.expect_a_quarter();
    f.h.torque = false;
    servo::shape(f.c, f.settings);
    EXPECT_NEAR(f.h.wanted_world.force_n.x(), 1.0, 1e-9);
}

TEST(StageShape, the_stable_stiffness_in_rotation_is_the_damping_over_the_delay) {
    CycleFixture f;
    f.c.statistics.metrics.delay_p99_ns = 20'000'000;
    servo::bound_by_delay(f.c, f.settings);
    EXPECT_NEAR(f.c.bounds.torque_n_m_rad, f.settings.hand_turn_damping_n_m_s_rad / 0.0205, 1e-9);
}

TEST(StageShape, at_a_wall_field_and_wall_share_the_stable_stiffness) {
    CycleFixture f;
    StiffModel stiff;
    HandCycle& h = f.c.hand[0];
    h.model = &stiff;
    h.step.wrench_world.force_n = Vec3(1.0, 0.0, 0.0);
    h.out.acts = kChainWall;
    f.c.bounds = {1000.0, 1e9, 1e9};
    servo::shape(f.c, f.settings);
    const double walls_n_m = h.chain.settings().wall_stiffness_n_m;
    EXPECT_NEAR(2000.0 * h.field.gain() + walls_n_m * h.walls.gain(), 1000.0, 1e-6);
    EXPECT_NEAR(h.field.gain(), h.walls.gain(), 1e-9);
}

// A field that is scaled down is less stiff.
TEST(StageShape, the_scale_of_the_force_counts_in_its_stiffness) {
    ServoSettings settings;
    settings.force_scale = 0.5;
    CycleFixture f(settings);
    StiffModel stiff;
    HandCycle& h = f.c.hand[0];
    h.model = &stiff;
    h.step.wrench_world.force_n = Vec3(1.0, 0.0, 0.0);
    f.c.bounds = {500.0, 1e9, 1e9};
    servo::shape(f.c, f.settings);
    EXPECT_NEAR(h.wanted_world.force_n.x(), 0.5 * 500.0 / (0.5 * 2000.0), 1e-9);
}

TEST(StageSafety, armed_with_a_hand_the_force_ramps_in) {
    CycleFixture f;
    f.c.events.arm = true;
    f.c.order.kind = static_cast<std::uint32_t>(CommandKind::arm);
    f.c.order.sequence = 7;
    f.c.hand[0].wanted_world.force_n = Vec3(1.0, 0.0, 0.0);
    f.c.dt = milliseconds(1);
    servo::make_safe(f.c, f.settings, f.io);
    EXPECT_EQ(f.c.run.state, RunState::armed);
    EXPECT_EQ(f.c.report.last_sequence, 7U);
    EXPECT_EQ(f.c.report.last_result, CommandResult::done);
    EXPECT_TRUE(f.c.hand[0].out.enable);
    f.c.events = {};
    double before_n = 0.0;
    for (int i = 0; i < 600; ++i) {
        servo::make_safe(f.c, f.settings, f.io);
        const double now_n = f.c.hand[0].shown_world.force_n.norm();
        EXPECT_GE(now_n, before_n);
        before_n = now_n;
    }
    EXPECT_EQ(f.c.run.state, RunState::active);
    EXPECT_NEAR(before_n, 1.0, 1e-9);
}

TEST(StageSafety, a_force_that_is_not_finite_is_a_fault_with_a_snapshot_and_zero_force) {
    CycleFixture f;
    f.c.run.state = RunState::active;
    f.c.hand[0].wanted_world.force_n = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    servo::make_safe(f.c, f.settings, f.io);
    EXPECT_EQ(f.c.run.state, RunState::fault);
    EXPECT_EQ(f.c.run.reason, RunReason::force_not_finite);
    EXPECT_EQ(f.c.hand[0].shown_world.force_n, Vec3(Vec3::Zero()));
    EXPECT_FALSE(f.c.hand[0].out.enable);
    EXPECT_TRUE(f.reported(EventCode::fault_latched));
    EXPECT_EQ(newest(f.mailbox.fault).reason, static_cast<std::uint64_t>(RunReason::force_not_finite));
}

TEST(StageSafety, a_stop_ends_the_run_once_no_force_is_shown) {
    CycleFixture f;
    f.mailbox.stop_signal.store(15);
    servo::make_safe(f.c, f.settings, f.io);
    EXPECT_TRUE(f.c.finished);
    EXPECT_TRUE(f.reported(EventCode::stopping));
    EXPECT_EQ(f.region->mailbox.pushed(), 1U);
}

TEST(StageSafety, a_dry_cycle_changes_no_state) {
    CycleFixture f;
    f.c.dry = true;
    f.c.events.arm = true;
    servo::make_safe(f.c, f.settings, f.io);
    EXPECT_EQ(f.c.run.state, RunState::ready);
}

TEST(StageActuate, the_device_gets_the_wrench_after_the_chain) {
    CycleFixture f;
    f.c.cycle = 12;
    f.c.hand[0].out.wrench_dev.force_n = Vec3(0.0, 0.3, 0.0);
    f.c.hand[0].out.enable = true;
    f.device.write_status = IoStatus::lost;
    servo::actuate(f.c);
    EXPECT_EQ(f.device.command.wrench_dev.force_n, Vec3(0.0, 0.3, 0.0));
    EXPECT_TRUE(f.device.command.enable);
    EXPECT_EQ(f.device.command.heartbeat, 12U);
    EXPECT_EQ(f.c.hand[0].write_status, IoStatus::lost);
}

}  // namespace
}  // namespace tact::servo_force_stages_test
