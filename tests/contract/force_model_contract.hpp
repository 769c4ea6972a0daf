// The contract of every force model. One suite, run for each model by its unit test:
//
//     INSTANTIATE_TEST_SUITE_P(Docking, ForceModelContract, testing::Values(ForceModelCase{"ring", make,
//     touch}));
//
// make builds the model; touch is a tool pose with a nonzero force, and the tests explore the space around it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "rt/force/force_model.hpp"

namespace tact {

struct ForceModelCase {
    std::string name;
    std::function<std::unique_ptr<ForceModel>()> make;
    // The pose at the grip, and the pose to which the tool then moves to get a force.
    Pose grip, touch;
    double force_n_min = 0.01;  // at touch, at full fidelity
    double step_n_max = 0.1;    // largest imperceptible change of force
    // Path on which the knob matters: the tool's pose in each step, from touch on. Empty: at rest at touch.
    std::function<Pose(int)> path = {};
    int path_steps = 50;
    // Relative difference allowed between the items that predict() expects and those that steps report, for models whose
    // items depend on the surroundings. Their items may fall, and their errors rise, by a twentieth from level to level.
    double items_tolerance = 0.0;
    [[nodiscard]] double items_slack() const { return items_tolerance > 0.0 ? 0.95 : 1.0; }
    // Part of the predicted error that a step at rest reports at least, for models that also predict how often steps lag.
    double error_at_rest = 1.0 - 1e-3;
    // Reason why all levels give the same force in this case; null: a lower level has a larger error.
    const char* error_free = nullptr;
};

inline void PrintTo(const ForceModelCase& c, std::ostream* out) { *out << c.name; }

class ForceModelContract : public testing::TestWithParam<ForceModelCase> {
protected:
    static constexpr int kSettle = 2000;  // steps after which every ramp has ended

    void SetUp() override {
        model_ = GetParam().make();
        ASSERT_NE(model_, nullptr);
        model_->reset(at(GetParam().grip));
    }
    static ToolState at(const Pose& pose, std::uint32_t buttons = 0) {
        ToolState tool;
        tool.T_world_tool = pose;
        tool.buttons = buttons;
        return tool;
    }
    static Pose between(double s) {
        const Pose &a = GetParam().grip, &b = GetParam().touch;
        return {a.p_m + s * (b.p_m - a.p_m), a.q.slerp(s, b.q)};
    }
    static Budget budget(float fidelity) {
        Budget b;
        b.fidelity = fidelity;
        return b;
    }
    static Budget no_time(float fidelity) {
        Budget b = budget(fidelity);
        b.deadline = instant_from_ns(0);
        return b;
    }
    StepResult settle(const Pose& pose, float fidelity = 1.0F, int steps = kSettle) {
        StepResult result;
        for (int i = 0; i <= 100; ++i) result = model_->step(at(between(0.01 * i)), budget(fidelity));
        for (int i = 0; i < steps; ++i) result = model_->step(at(pose), budget(fidelity));
        return result;
    }
    // A fresh model led along the case's path at a level, after it settled at touch at full fidelity.
    struct KnobRun {
        double items = 0.0, items_predicted = 0.0, error_n = 0.0;  // sums over the steps
        std::vector<StepResult> step;
    };
    template <class Before>
    KnobRun run(float fidelity, const Before& before_step) {
        const ForceModelCase& c = GetParam();
        model_ = c.make();
        model_->reset(at(c.grip));
        (void)settle(c.touch, 1.0F, 500);
        KnobRun run;
        for (int i = 0; i < c.path_steps; ++i) {
            before_step(*model_);
            run.items_predicted += model_->predict(fidelity).items;
            run.step.push_back(model_->step(at(c.path ? c.path(i) : c.touch), budget(fidelity)));
            run.items += run.step.back().load.items;
            run.error_n += run.step.back().load.error;
        }
        return run;
    }
    KnobRun run(float fidelity) {
        return run(fidelity, [](const ForceModel&) {});
    }
    static double difference_n(const StepResult& a, const StepResult& b) {
        return (a.wrench_world.force_n - b.wrench_world.force_n).norm();
    }
    std::unique_ptr<ForceModel> model_;
};

TEST_P(ForceModelContract, knob_is_named_and_in_range) {
    const KnobSpec knob = model_->knob();
    EXPECT_NE(std::string(knob.path), "");
    EXPECT_GE(knob.floor, 0.0F);
    EXPECT_LE(knob.floor, knob.start);
    EXPECT_LE(knob.start, 1.0F);
    EXPECT_GT(knob.slew_per_s, 0.0F);
    EXPECT_TRUE(knob.haptic);
}

// The loop warms up before a hand is present.
TEST_P(ForceModelContract, a_step_before_the_first_reset_moves_no_body) {
    model_ = GetParam().make();
    const ModelBodies before = model_->bodies();
    for (int i = 0; i < 10; ++i) (void)model_->step(at(GetParam().grip), budget(1.0F));
    for (std::uint32_t i = 0; i < before.count; ++i) {
        const Pose &a = before.T_model_body[i], b = model_->bodies().T_model_body[i];
        EXPECT_LT((a.p_m - b.p_m).norm(), 1e-9 * (1e-9 + a.p_m.norm()));
        EXPECT_LT(a.q.angularDistance(b.q), 1e-9);
    }
}

TEST_P(ForceModelContract, touch_gives_a_force) {
    EXPECT_GE(settle(GetParam().touch).wrench_world.force_n.norm(), GetParam().force_n_min);
}

TEST_P(ForceModelContract, items_rise_and_errors_fall_with_the_knob) {
    (void)settle(GetParam().touch);
    std::uint32_t items = 0;
    double error = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= 100; ++i) {
        const auto fidelity = 0.01F * static_cast<float>(i);
        const StepResult result = model_->step(at(GetParam().touch), budget(fidelity));
        EXPECT_EQ(result.status, StepStatus::ok);
        EXPECT_GE(model_->items(fidelity), GetParam().items_slack() * items);
        EXPECT_NEAR(result.load.items, model_->items(fidelity),
                    GetParam().items_tolerance * result.load.items);
        EXPECT_LE(result.load.error, error * (1.0 + 1e-9) + 1e-12);
        EXPECT_GT(result.load.cost.count(), 0);
        items = model_->items(fidelity);
        error = result.load.error;
    }
}

// Fails for a knob that is not connected: the knob changes work, force and reported error, and the error bounds the
// difference.
TEST_P(ForceModelContract, the_knob_changes_work_and_force_and_the_error_bounds_the_difference) {
    const KnobRun full = run(1.0F), coarse = run(0.0F);
    KnobRun before = coarse;
    for (const float fidelity : {0.25F, 0.5F, 0.75F, 1.0F}) {
        const KnobRun now = run(fidelity);
        EXPECT_GE(now.items, GetParam().items_slack() * before.items) << "at " << fidelity;
        EXPECT_LE(GetParam().items_slack() * now.error_n, before.error_n * (1.0 + 1e-9)) << "at " << fidelity;
        for (std::size_t i = 0; i < now.step.size(); ++i)
            EXPECT_LE(difference_n(now.step[i], full.step[i]),
                      now.step[i].load.error + full.step[i].load.error + 1e-9)
                << "at " << fidelity << ", step " << i;
        before = now;
    }
    EXPECT_GT(full.items, coarse.items);
    double most_n = 0.0;
    for (std::size_t i = 0; i < full.step.size(); ++i) {
        const double off_n = difference_n(coarse.step[i], full.step[i]);
        EXPECT_LE(off_n, coarse.step[i].load.error + full.step[i].load.error + 1e-9) << "step " << i;
        most_n = std::max(most_n, off_n);
    }
    if (GetParam().error_free != nullptr) {
        EXPECT_EQ(most_n, 0.0) << GetParam().error_free;
    } else {
        EXPECT_GT(coarse.error_n, full.error_n);
        EXPECT_GT(most_n, 1e-6);
    }
}

TEST_P(ForceModelContract, predicted_cost_and_items_rise_and_the_predicted_error_falls_with_the_knob) {
    double costs = 0.0, coarse_costs = 0.0, errors = 0.0, coarse_errors = 0.0, most_error_n = 0.0;
    const KnobRun full = run(1.0F, [&](const ForceModel& model) {
        PathLoad before = model.predict(0.0F);
        coarse_costs += to_us(before.cost_predicted);
        coarse_errors += before.error;
        most_error_n = std::max(most_error_n, before.error);
        EXPECT_GT(before.cost_predicted.count(), 0);
        // At a knob's own levels: a blend of two costs both. Their costs are measured, so neighbours may be close.
        const std::uint32_t steps = model.knob().steps;
        const double slack = steps > 0 ? 0.5 : 1.0;
        for (std::uint32_t i = 0; i <= (steps > 0 ? steps : 20); ++i) {
            const PathLoad now =
                model.predict(static_cast<float>(i) / static_cast<float>(steps > 0 ? steps : 20));
            EXPECT_GE(to_us(now.cost_predicted), slack * to_us(before.cost_predicted)) << i;
            EXPECT_GE(now.items, GetParam().items_slack() * before.items) << i;
            EXPECT_LE(now.error, before.error * (1.0 + 1e-9) + 1e-12) << i;
            before = now;
        }
        costs += to_us(before.cost_predicted);
        errors += before.error;
    });
    EXPECT_GT(costs, coarse_costs);
    if (GetParam().error_free == nullptr) {
        EXPECT_GT(coarse_errors, errors);
    }
    for (const float fidelity : {0.0F, 0.3F, 1.0F}) {
        const KnobRun now = run(fidelity);
        EXPECT_NEAR(now.items_predicted, now.items, GetParam().items_tolerance * now.items)
            << "at " << fidelity;
    }
    // At rest, the predicted error of a level is the one that its steps report once a change of level has faded, or more
    // by the lags that it expects in motion.
    for (const float fidelity : {0.0F, 0.3F, 0.5F, 1.0F}) {
        if (GetParam().path || GetParam().items_tolerance > 0.0) continue;
        StepResult result;
        for (int i = 0; i < 1000; ++i) result = model_->step(at(GetParam().touch), budget(fidelity));
        const double expected = model_->predict(fidelity).error;
        EXPECT_LE(result.load.error, 1e-9 + 1.001 * expected) << "at " << fidelity;
        EXPECT_GE(result.load.error, GetParam().error_at_rest * expected - 1e-9) << "at " << fidelity;
    }
    // The predicted error of the floor bounds the difference.
    const KnobRun coarse = run(0.0F);
    double most_n = 0.0;
    for (std::size_t i = 0; i < full.step.size(); ++i)
        most_n = std::max(most_n, difference_n(coarse.step[i], full.step[i]));
    EXPECT_LE(most_n, most_error_n);
}

TEST_P(ForceModelContract, a_step_without_time_reports_the_part_of_its_work_that_it_did) {
    (void)settle(GetParam().touch);
    EXPECT_EQ(model_->step(at(GetParam().touch), budget(1.0F)).load.work_done, 1.0F);
    const PathLoad late = model_->step(at(GetParam().touch), no_time(1.0F)).load;
    EXPECT_GT(late.work_done, 0.0F);
    EXPECT_LE(late.work_done, 1.0F);
}

TEST_P(ForceModelContract, turning_the_knob_in_contact_causes_no_perceptible_force_step) {
    StepResult before = settle(GetParam().touch, 0.0F);
    // A governor's fastest sweep: slew_per_s at 1 kHz.
    const float step = std::max(1e-4F, std::min(0.004F, model_->knob().slew_per_s * 1e-3F));
    for (float fidelity = 0.0F; fidelity <= 1.0F; fidelity += step) {
        const StepResult now = model_->step(at(GetParam().touch), budget(fidelity));
        EXPECT_LT(difference_n(now, before), GetParam().step_n_max) << "at " << fidelity;
        before = now;
    }
}

TEST_P(ForceModelContract, a_fidelity_outside_its_range_is_clamped) {
    (void)settle(GetParam().touch);
    const auto step = [&](float fidelity) {
        StepResult result;  // of a level that has settled
        for (int i = 0; i < kSettle; ++i) result = model_->step(at(GetParam().touch), budget(fidelity));
        return result;
    };
    EXPECT_EQ(difference_n(step(7.0F), step(1.0F)), 0.0);
    EXPECT_EQ(difference_n(step(-3.0F), step(0.0F)), 0.0);
    EXPECT_TRUE(step(std::numeric_limits<float>::quiet_NaN()).wrench_world.finite());
}

TEST_P(ForceModelContract, the_same_steps_give_the_same_forces) {
    const StepResult first = settle(GetParam().touch, 0.6F);
    model_ = GetParam().make();
    model_->reset(at(GetParam().grip));
    EXPECT_EQ(difference_n(settle(GetParam().touch, 0.6F), first), 0.0);
}

TEST_P(ForceModelContract, without_time_the_force_is_still_usable) {
    const StepResult full = settle(GetParam().touch);
    for (const float fidelity : {0.0F, 0.3F, 0.95F, 1.0F}) {
        const StepResult late = model_->step(at(GetParam().touch), no_time(fidelity));
        EXPECT_EQ(late.status, StepStatus::out_of_time);
        EXPECT_TRUE(late.wrench_world.finite());
        EXPECT_LE(difference_n(late, full), late.load.error + GetParam().step_n_max);
    }
    EXPECT_EQ(model_->step(at(GetParam().touch), budget(1.0F)).status, StepStatus::ok);
}

TEST_P(ForceModelContract, no_force_right_after_reset) {
    (void)settle(GetParam().touch);
    model_->reset(at(GetParam().touch));
    const Wrench first = model_->step(at(GetParam().touch), budget(1.0F)).wrench_world;
    EXPECT_LT(first.force_n.norm(), 1e-3);
    EXPECT_LT(first.torque_n_m.norm(), 1e-5);
}

// A force is finite at first and later, and a torque fades in with it: at a tenth of the force, its share of the whole is the same.
TEST_P(ForceModelContract, the_torque_fades_in_with_the_force) {
    const StepResult full = settle(GetParam().touch);
    model_->reset(at(GetParam().touch));
    StepResult now;
    for (int i = 0; i < kSettle && now.wrench_world.force_n.norm() < 0.1 * full.wrench_world.force_n.norm();
         ++i)
        now = model_->step(at(GetParam().touch), budget(1.0F));
    const double share = now.wrench_world.force_n.norm() / full.wrench_world.force_n.norm();
    EXPECT_LT(share, 0.5);
    EXPECT_LE(now.wrench_world.torque_n_m.norm(), 2.0 * share * full.wrench_world.torque_n_m.norm() + 1e-9);
}

TEST_P(ForceModelContract, force_returns_after_reset_without_a_step) {
    StepResult before = settle(GetParam().touch);
    model_->reset(at(GetParam().touch));
    before.wrench_world = Wrench{};
    for (int i = 0; i < kSettle; ++i) {
        const StepResult now = model_->step(at(GetParam().touch), budget(1.0F));
        ASSERT_LT(difference_n(now, before), GetParam().step_n_max);
        before = now;
    }
    EXPECT_GE(before.wrench_world.force_n.norm(), GetParam().force_n_min);
}

// From a tenth of the force to nine tenths of it, and back with the clutch: 0.61 of the 0.256 s of a fade.
TEST_P(ForceModelContract, the_force_fades_in_and_out_over_the_same_time_at_any_rate) {
    model_->reset(at(GetParam().touch));
    double full_n = 0.0;
    for (int i = 0; i < kSettle; ++i)
        full_n = model_->step(at(GetParam().touch), budget(1.0F)).wrench_world.force_n.norm();
    for (const double step_s : {1e-2, 1e-3, 5e-5}) {
        const auto step_n = [&](std::uint32_t buttons) {
            model_->drive({.step_s = step_s});
            return model_->step(at(GetParam().touch, buttons), budget(1.0F)).wrench_world.force_n.norm();
        };
        const int most = static_cast<int>(3.0 / step_s);
        const auto steps_until = [&](std::uint32_t buttons, const std::function<bool(double)>& reached) {
            int steps = 0;
            while (steps < most && !reached(step_n(buttons))) ++steps;
            return steps;
        };
        model_->reset(at(GetParam().touch));
        (void)steps_until(0, [&](double n) { return n > 0.1 * full_n; });
        const double in_s = step_s * steps_until(0, [&](double n) { return n > 0.9 * full_n; });
        EXPECT_NEAR(in_s, 0.1557, 2.0 * step_s + 2e-3) << "at " << 1.0 / step_s << " Hz";
        (void)steps_until(0, [&](double n) { return n > 0.9999 * full_n; });
        (void)steps_until(1, [&](double n) { return n < 0.9 * full_n; });
        const double out_s = step_s * steps_until(1, [&](double n) { return n < 0.1 * full_n; });
        EXPECT_NEAR(out_s, 0.1557, 2.0 * step_s + 2e-3) << "at " << 1.0 / step_s << " Hz";
    }
}

TEST_P(ForceModelContract, invalid_poses_give_no_force_and_leave_no_trace) {
    (void)settle(GetParam().touch);
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
    std::vector<Pose> absurd(7, GetParam().touch);
    absurd[6].p_m.x() = 2e3;  // farther than any arm reaches
    absurd[0].p_m.x() = nan;
    absurd[1].p_m.y() = inf;
    absurd[2].p_m.z() = -1e300;
    absurd[3].q = Quat(nan, 0.0, 0.0, 0.0);
    absurd[4].q = Quat(0.0, 0.0, 0.0, 0.0);
    absurd[5].q = Quat(0.0, inf, 0.0, 0.0);
    for (const Pose& pose : absurd) {
        const ModelBodies before = model_->bodies();
        const StepResult result = model_->step(at(pose), budget(1.0F));
        EXPECT_EQ(result.status, StepStatus::out_of_range);
        EXPECT_EQ(result.wrench_world.force_n, Vec3::Zero());
        EXPECT_EQ(result.wrench_world.torque_n_m, Vec3::Zero());
        const ModelBodies after = model_->bodies();
        for (std::uint32_t b = 0; b < after.count; ++b) {
            EXPECT_TRUE(after.T_model_body[b].finite());
            EXPECT_EQ(after.T_model_body[b].p_m, before.T_model_body[b].p_m);
        }
        model_->reset(at(pose));
        EXPECT_TRUE(model_->step(at(pose), budget(1.0F)).wrench_world.finite());
        EXPECT_LT(model_->step(at(GetParam().touch), budget(1.0F)).wrench_world.force_n.norm(),
                  GetParam().step_n_max);
    }
    for (int i = 0; i < kSettle; ++i) (void)model_->step(at(GetParam().touch), budget(1.0F));
    EXPECT_EQ(model_->step(at(GetParam().touch), budget(1.0F)).status, StepStatus::ok);
}

TEST_P(ForceModelContract, orders_cause_no_force_step_and_a_new_body_fades_in_from_zero) {
    const ModelBodies bodies = (settle(GetParam().touch), model_->bodies());
    if (bodies.count == 0) GTEST_SKIP() << "the model has no bodies";
    using Kind = ModelOrder::Kind;
    ModelOrder place, let_go, take, fix, free, add;
    place.kind = Kind::place;
    place.T_model_body = bodies.T_model_body[bodies.active];
    fix.kind = free.kind = Kind::fix;
    fix.on = true;
    place.body = take.body = fix.body = free.body = bodies.id[bodies.active];
    let_go.body = ModelBodies::kNone;
    add = place;
    add.kind = Kind::add;
    add.body = bodies.structure[bodies.active];
    StepResult before = model_->step(at(GetParam().touch), budget(1.0F));
    for (const ModelOrder& order : {place, let_go, take, fix, free, add}) {
        const bool applied = model_->order(order);
        double least_n = std::numeric_limits<double>::infinity();
        for (int i = 0; i < kSettle; ++i) {
            const StepResult now = model_->step(at(GetParam().touch), budget(1.0F));
            ASSERT_LT(difference_n(now, before), GetParam().step_n_max) << "step " << i;
            least_n = std::min(least_n, now.wrench_world.force_n.norm());
            before = now;
        }
        if (applied && order.kind != Kind::add) {
            EXPECT_LT(least_n, 1e-3) << static_cast<int>(order.kind);
        }
        const bool felt = order.kind != Kind::fix ? order.body != ModelBodies::kNone : !order.on;
        if (applied && felt) {
            EXPECT_GE(before.wrench_world.force_n.norm(), GetParam().force_n_min);
        }
    }
}

TEST_P(ForceModelContract, a_refused_order_changes_nothing) {
    (void)settle(GetParam().touch);
    const ModelBodies before = model_->bodies();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    std::vector<ModelOrder> absurd(8);
    using Kind = ModelOrder::Kind;
    absurd[0].kind = Kind::select, absurd[0].body = 0;
    absurd[1].kind = Kind::select, absurd[1].body = 12345;
    absurd[2].kind = Kind::fix, absurd[2].body = 12345;
    absurd[3].kind = Kind::place, absurd[3].body = before.id[0], absurd[3].T_model_body.p_m.y() = nan;
    absurd[4].kind = Kind::place, absurd[4].body = before.id[0], absurd[4].T_model_body.p_m.x() = 1e300;
    absurd[5].kind = Kind::add, absurd[5].T_model_body.q = Quat(0.0, 0.0, 0.0, 0.0);
    absurd[6].kind = Kind::remove, absurd[6].body = 12345;
    absurd[7].kind = Kind::setting, absurd[7].command = 255;
    const StepResult felt = model_->step(at(GetParam().touch), budget(1.0F));
    for (const ModelOrder& order : absurd) EXPECT_FALSE(model_->order(order)) << static_cast<int>(order.kind);
    const ModelBodies after = model_->bodies();
    EXPECT_EQ(after.count, before.count);
    EXPECT_EQ(after.active, before.active);
    EXPECT_EQ(after.id, before.id);
    EXPECT_EQ(after.placements, before.placements);
    EXPECT_EQ(after.options_asked, before.options_asked);
    EXPECT_EQ(difference_n(model_->step(at(GetParam().touch), budget(1.0F)), felt), 0.0);
    EXPECT_FALSE(model_->stale());
}

TEST_P(ForceModelContract, a_rebuilt_model_continues_from_the_old_one) {
    StepResult before = settle(GetParam().touch);
    const auto rebuilt = model_->rebuild(model_->bodies());
    if (rebuilt == nullptr) GTEST_SKIP() << "the model has nothing to rebuild";
    before = model_->step(at(GetParam().touch), budget(1.0F));  // the old model continues meanwhile
    ASSERT_TRUE(rebuilt->adopt(*model_));
    const ModelBodies old = model_->bodies();
    double least_n = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kSettle; ++i) {
        const StepResult now = rebuilt->step(at(GetParam().touch), budget(1.0F));
        ASSERT_LT(difference_n(now, before), GetParam().step_n_max) << "step " << i;
        least_n = std::min(least_n, now.wrench_world.force_n.norm());
        before = now;
    }
    EXPECT_LT(least_n, 1e-3);
    EXPECT_GE(before.wrench_world.force_n.norm(), GetParam().force_n_min);
    const ModelBodies now = rebuilt->bodies();
    EXPECT_EQ(now.id, old.id);
    EXPECT_EQ(now.active, old.active);
    EXPECT_EQ(now.grips, old.grips);  // the same gesture
    for (std::uint32_t b = 0; b < old.count; ++b) {
        EXPECT_LT((now.T_model_body[b].p_m - old.T_model_body[b].p_m).norm(),
                  1e-9 * (1e-9 + old.T_model_body[b].p_m.norm()));
        EXPECT_LT(now.T_model_body[b].q.angularDistance(old.T_model_body[b].q), 1e-7);
    }
}

TEST_P(ForceModelContract, bodies_are_counted_and_placed) {
    (void)settle(GetParam().touch);
    const ModelBodies bodies = model_->bodies();
    EXPECT_LE(bodies.count, ModelBodies::kMax);
    if (bodies.count > 0) {
        EXPECT_LT(bodies.active, bodies.count);
    }
    for (std::uint32_t b = 0; b < bodies.count; ++b) {
        EXPECT_TRUE(bodies.T_model_body[b].finite());
        EXPECT_GT(bodies.id[b], 0U);
        for (std::uint32_t other = 0; other < b; ++other) EXPECT_NE(bodies.id[b], bodies.id[other]);
    }
}

}  // namespace tact
