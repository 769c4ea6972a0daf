// The output chain: bounds for any input, each stage, and the order of the stages.
#include "rt/safety/output_chain.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <array>
#include <cmath>
#include <limits>

#include "rt/safety/stages.hpp"

namespace tact::safety_output_chain_test {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

ChainInput on(const Vec3& force_n, Duration dt = milliseconds(1)) {
    ChainInput in;
    in.wanted_dev.force_n = force_n;
    in.dt = dt;
    in.force_on = in.gate_open = in.amplifier = true;
    return in;
}

// Runs until ramp and slew have ended.
ChainOutput settled(OutputChain& chain, const ChainInput& in) {
    ChainOutput out;
    for (int i = 0; i < 1000; ++i) out = chain.apply(in);
    return out;
}

TEST(OutputChain, any_input_gives_a_finite_wrench_within_the_limits) {
    const bool held = rc::check([] {
        ChainSettings settings;
        settings.passivity = *rc::gen::arbitrary<bool>();
        settings.force_n_continuous = *rc::gen::element(0.0, 1.4);
        OutputChain chain(settings);
        const auto number = rc::gen::weightedOneOf<double>(
            {{20, rc::gen::map(rc::gen::inRange(-1000000, 1000000), [](int v) { return v * 1e-4; })},
             {1, rc::gen::element(kNan, kInf, -kInf, 1e300, -1e300, 0.0)}});
        const int cycles = *rc::gen::inRange(1, 60);
        Vec3 before = Vec3::Zero();
        for (int i = 0; i < cycles; ++i) {
            ChainInput in;
            for (int k = 0; k < 3; ++k) {
                in.wanted_dev.force_n[k] = *number;
                in.wanted_dev.torque_n_m[k] = *number;
                in.T_dev_tool.p_m[k] = *number * 1e-2;
            }
            in.T_dev_tool.q = quat_from_rotation_vector(Vec3(*number, 0.1, 0.2));
            in.dt = microseconds(*rc::gen::inRange(-10, 20000));
            in.force_on = *rc::gen::weightedElement<bool>({{9, true}, {1, false}});
            in.gate_open = *rc::gen::weightedElement<bool>({{19, true}, {1, false}});
            in.amplifier = *rc::gen::weightedElement<bool>({{9, true}, {1, false}});
            const ChainOutput out = chain.apply(in);
            RC_ASSERT(out.wrench_dev.finite());
            RC_ASSERT(out.wrench_dev.force_n.norm() <= settings.force_n_max * (1.0 + 1e-9));
            RC_ASSERT(out.wrench_dev.torque_n_m.norm() <= settings.torque_n_m_max * (1.0 + 1e-9));
            RC_ASSERT(out.gain >= 0.0 && out.gain <= 1.0);
            RC_ASSERT(in.gate_open || !out.enable);
            RC_ASSERT(out.enable || out.wrench_dev.force_n.isZero(0.0));
            // An upward slew of at most 2 ms, plus the change by the ramp.
            const double step =
                settings.force_slew_n_s * 2e-3 +
                settings.force_n_max * 2e-3 / std::min(settings.ramp_in_s, settings.ramp_out_s);
            if (out.enable) RC_ASSERT((out.wrench_dev.force_n - before).norm() <= step + 1e-9);
            before = out.enable ? out.wrench_dev.force_n : Vec3(Vec3::Zero());
        }
    });
    EXPECT_TRUE(held);
}

TEST(OutputChain, a_force_inside_all_limits_passes_unchanged) {
    OutputChain chain;
    const Vec3 wanted(1.0, -0.5, 0.25);
    const ChainOutput out = settled(chain, on(wanted));
    EXPECT_TRUE(out.wrench_dev.force_n.isApprox(wanted, 1e-12));
    EXPECT_EQ(out.acts, 0U);
    EXPECT_TRUE(out.enable);
}

TEST(OutputChain, saturation_keeps_the_direction) {
    OutputChain chain;
    const Vec3 wanted(30.0, -40.0, 0.0);
    const ChainOutput out = settled(chain, on(wanted));
    EXPECT_TRUE(out.wrench_dev.force_n.isApprox(wanted * (3.3 / 50.0), 1e-12));
    EXPECT_NE(out.acts & kChainForce, 0U);
    EXPECT_DOUBLE_EQ(out.wanted_n, 50.0);
}

TEST(OutputChain, a_force_that_is_not_finite_becomes_zero_and_is_reported) {
    OutputChain chain;
    static_cast<void>(settled(chain, on(Vec3(1.0, 0.0, 0.0))));
    ChainInput in = on(Vec3(1.0, kNan, 0.0));
    in.gate_open = false;  // as the state machine does in the same cycle
    const ChainOutput out = chain.apply(in);
    EXPECT_NE(out.acts & kChainNotFinite, 0U);
    EXPECT_TRUE(out.wrench_dev.force_n.isZero(0.0));
    EXPECT_FALSE(out.enable);
}

TEST(OutputChain, a_closed_gate_gives_zero_at_once_and_restarts_the_ramp) {
    OutputChain chain;
    static_cast<void>(settled(chain, on(Vec3(2.0, 0.0, 0.0))));
    ChainInput shut = on(Vec3(2.0, 0.0, 0.0));
    shut.gate_open = false;
    EXPECT_TRUE(chain.apply(shut).wrench_dev.force_n.isZero(0.0));
    const ChainOutput again = chain.apply(on(Vec3(2.0, 0.0, 0.0)));
    EXPECT_LT(again.wrench_dev.force_n.norm(), 0.005);
}

TEST(OutputChain, a_pose_that_is_not_finite_closes_the_gate_and_turns_the_amplifier_off) {
    for (const bool turned : {false, true}) {
        OutputChain chain;
        ChainInput in = on(Vec3(1.0, 0.0, 0.0));
        ASSERT_TRUE(settled(chain, in).enable);
        if (turned)
            in.T_dev_tool.q = Quat(kNan, 0.0, 0.0, 0.0);
        else
            in.T_dev_tool.p_m.y() = kNan;
        const ChainOutput out = chain.apply(in);
        EXPECT_FALSE(out.enable);
        EXPECT_TRUE(out.wrench_dev.force_n.isZero(0.0));
        EXPECT_EQ(out.gain, 0.0);
        EXPECT_NE(out.acts & kChainNotFinite, 0U);
    }
}

TEST(OutputChain, a_torque_is_limited_and_ramped_as_a_force_is) {
    OutputChain chain;
    ChainInput in = on(Vec3::Zero());
    in.wanted_dev.torque_n_m = Vec3(0.6, 0.0, 0.8);
    ChainOutput out;
    for (int i = 0; i < 250; ++i) out = chain.apply(in);
    EXPECT_NEAR(out.gain, 0.5, 1e-9);
    EXPECT_NEAR(out.wrench_dev.torque_n_m.norm(), 0.5 * chain.settings().torque_n_m_max, 1e-9);
    out = settled(chain, in);
    EXPECT_NE(out.acts & kChainTorque, 0U);
    EXPECT_LT((out.wrench_dev.torque_n_m - chain.settings().torque_n_m_max * Vec3(0.6, 0.0, 0.8)).norm(),
              1e-12);
}

TEST(OutputChain, after_a_closed_gate_the_slope_starts_at_zero_again) {
    OutputChain chain;
    ChainInput in = on(Vec3(3.0, 0.0, 0.0));
    in.wanted_dev.torque_n_m = Vec3(0.0, 0.15, 0.0);
    (void)settled(chain, in);
    in.gate_open = false;
    (void)chain.apply(in);
    in.gate_open = true;
    const ChainOutput out = chain.apply(in);
    EXPECT_NE(out.acts & kChainSlew, 0U);
    EXPECT_NE(out.acts & kChainTorqueSlew, 0U);
    EXPECT_NEAR(out.step_n, 3.0, 1e-12);
    EXPECT_NEAR(out.step_n_m, 0.15, 1e-12);
}

// A field that pushes along the motion generates energy. The turn is measured in the frame of the torque, the device's.
TEST(OutputChain, passivity_acts_on_a_turn_about_the_axis_of_the_torque_and_forgets_with_the_gate) {
    ChainSettings settings;
    settings.passivity = true;
    settings.ramp_in_s = 1e-3;
    OutputChain chain(settings);
    const Quat base = quat_from_rotation_vector(Vec3(0.0, 0.0, 0.5 * M_PI));
    ChainInput in = on(Vec3::Zero());
    in.wanted_dev.torque_n_m = Vec3(0.02, 0.0, 0.0);
    std::uint32_t acts = 0;
    double angle = 0.0, torque_n_m = 0.02;
    const auto turn = [&] {
        angle += 1e-3;
        in.T_dev_tool.q = quat_from_rotation_vector(Vec3(angle, 0.0, 0.0)) * base;
        const ChainOutput out = chain.apply(in);
        torque_n_m = out.wrench_dev.torque_n_m.x();
        return out.acts;
    };
    for (int i = 0; i < 30; ++i) acts |= turn();
    EXPECT_NE(acts & kChainPassivity, 0U);
    EXPECT_LT(torque_n_m, 0.01);
    in.gate_open = false;
    (void)turn();
    in.gate_open = true;
    in.wanted_dev.torque_n_m.setZero();
    for (int i = 0; i < 3; ++i) EXPECT_EQ(turn() & kChainPassivity, 0U);
    // Across the axis nothing is generated.
    OutputChain other(settings);
    in.wanted_dev.torque_n_m = Vec3(0.0, 0.0, 0.02);
    for (int i = 0; i < 30; ++i) {
        angle += 1e-3;
        in.T_dev_tool.q = quat_from_rotation_vector(Vec3(angle, 0.0, 0.0)) * base;
        EXPECT_LT(std::abs(other.apply(in).wrench_dev.torque_n_m.x()), 1e-12);
    }
}

TEST(OutputChain, passivity_acts_on_a_force_along_the_motion_and_forgets_with_the_gate) {
    ChainSettings settings;
    settings.passivity = true;
    settings.ramp_in_s = 1e-3;
    OutputChain chain(settings);
    ChainInput in = on(Vec3(1.0, 0.0, 0.0));
    std::uint32_t acts = 0;
    const auto move = [&] {
        in.T_dev_tool.p_m.x() += 1e-4;
        return chain.apply(in).acts;
    };
    for (int i = 0; i < 30; ++i) acts |= move();
    EXPECT_NE(acts & kChainPassivity, 0U);
    in.gate_open = false;
    (void)move();
    in.gate_open = true;
    in.wanted_dev.force_n.setZero();
    for (int i = 0; i < 3; ++i) EXPECT_EQ(move() & kChainPassivity, 0U);
}

// The knees are the documented ones: four fifths of the heat, and the whole.
TEST(OutputChain, a_warm_motor_is_limited_in_proportion_between_four_fifths_and_the_whole_heat) {
    for (const double heat : {0.0, 0.5, 0.79, 0.8})
        EXPECT_EQ(stages::heat_limit_n(heat, 3.0, 1.0), 3.0) << heat;
    EXPECT_NEAR(stages::heat_limit_n(0.85, 3.0, 1.0), 2.5, 1e-12);
    EXPECT_NEAR(stages::heat_limit_n(0.9, 3.0, 1.0), 2.0, 1e-12);
    EXPECT_NEAR(stages::heat_limit_n(0.95, 3.0, 1.0), 1.5, 1e-12);
    for (const double heat : {1.0, 1.3, 10.0}) EXPECT_NEAR(stages::heat_limit_n(heat, 3.0, 1.0), 1.0, 1e-12);
    ChainSettings settings;
    settings.force_n_continuous = 1.0;
    settings.heat_start = 0.9;
    OutputChain chain(settings);
    ChainInput in = on(Vec3(settings.force_n_max, 0.0, 0.0), microseconds(10));
    ChainOutput out;
    for (int i = 0; i < 1000; ++i) out = chain.apply(in);
    EXPECT_NE(out.acts & kChainHeat, 0U);
}

TEST(OutputChain, the_ramp_reaches_full_force_in_its_time_and_ends_it_within_fifty_milliseconds) {
    OutputChain chain;
    const ChainInput in = on(Vec3(1.0, 0.0, 0.0));
    double before = -1.0;
    for (int i = 0; i < 499; ++i) {
        const ChainOutput out = chain.apply(in);
        EXPECT_GE(out.wrench_dev.force_n.x(), before);
        EXPECT_LT(out.gain, 1.0);
        before = out.wrench_dev.force_n.x();
    }
    static_cast<void>(chain.apply(in));
    EXPECT_NEAR(chain.apply(in).wrench_dev.force_n.x(), 1.0, 1e-9);
    ChainInput leave = in;
    leave.force_on = leave.amplifier = false;
    for (int i = 0; i < 49; ++i) EXPECT_TRUE(chain.apply(leave).enable);
    static_cast<void>(chain.apply(leave));
    const ChainOutput gone = chain.apply(leave);
    EXPECT_TRUE(gone.wrench_dev.force_n.isZero(0.0));
    EXPECT_FALSE(gone.enable);
}

TEST(OutputChain, the_slope_is_limited_to_its_setting) {
    ChainSettings settings;
    settings.ramp_in_s = 1e-6;
    OutputChain chain(settings);
    for (int i = 1; i <= 6; ++i) {
        const ChainOutput out = chain.apply(on(Vec3(3.3, 0.0, 0.0)));
        EXPECT_NEAR(out.wrench_dev.force_n.x(), 0.5 * i, 1e-9);
        EXPECT_NE(out.acts & kChainSlew, 0U);
    }
    EXPECT_NEAR(chain.apply(on(Vec3(3.3, 0.0, 0.0))).wrench_dev.force_n.x(), 3.3, 1e-9);
}

// The slope stage must not report an action when it has none; rounding of before + (wanted - before) once caused it.
TEST(OutputChain, a_slow_force_passes_the_slope_stage_unchanged_and_unreported) {
    OutputChain chain(ChainSettings{});
    for (int i = 0; i < 2000; ++i) {
        const double s = 1e-3 * i;
        const ChainOutput out =
            chain.apply(on(Vec3(0.3 * std::sin(s), 0.7 * std::cos(1.3 * s) - 0.7, 1e-7 * s)));
        EXPECT_EQ(out.acts & (kChainSlew | kChainTorqueSlew), 0U) << "cycle " << i;
    }
}

TEST(OutputChain, the_wall_pushes_inwards_and_is_saturated_like_any_force) {
    OutputChain chain;
    ChainInput in = on(Vec3::Zero());
    in.T_dev_tool.p_m = {0.097, 0.0, -0.2};  // 2 mm and 105 mm beyond the soft edge at 95 mm
    const ChainOutput out = settled(chain, in);
    EXPECT_LT(out.wrench_dev.force_n.x(), 0.0);
    EXPECT_GT(out.wrench_dev.force_n.z(), 0.0);
    EXPECT_NEAR(out.wrench_dev.force_n.norm(), 3.3, 1e-9);
    EXPECT_NE(out.acts & kChainWall, 0U);
    const Vec3 alone = stages::wall_force_n({0.097, 0.0, 0.0}, Vec3::Constant(0.1), 0.005, 500.0);
    EXPECT_TRUE(alone.isApprox(Vec3(-1.0, 0.0, 0.0), 1e-9));
}

TEST(OutputChain, the_wall_stiffness_scales_with_its_gain) {
    OutputChain chain;
    ChainInput in = on(Vec3::Zero());
    in.T_dev_tool.p_m = {0.097, 0.0, 0.0};  // 2 mm deep
    in.wall_gain = 0.4;
    EXPECT_NEAR(settled(chain, in).wrench_dev.force_n.x(), -0.4, 1e-9);
    in.wall_gain = 1.0;
    EXPECT_NEAR(settled(chain, in).wrench_dev.force_n.x(), -1.0, 1e-9);
}

TEST(StiffnessLimit, is_damping_over_half_a_period_plus_the_delay) {
    EXPECT_NEAR(stages::stiffness_max_n_m(0.05, 1e-3, 1e-3), 0.05 / 1.5e-3, 1e-9);  // 33 N/m
    EXPECT_NEAR(stages::stiffness_max_n_m(3.0, 1e-3, 5e-3), 3.0 / 5.5e-3, 1e-9);
    // A delay of 0 is unknown and counts as one period.
    EXPECT_EQ(stages::stiffness_max_n_m(3.0, 1e-3, 0.0), stages::stiffness_max_n_m(3.0, 1e-3, 1e-3));
    EXPECT_TRUE(std::isinf(stages::stiffness_max_n_m(3.0, 0.0, 0.0)));
}

// A heavy mass with little damping on a sampled spring whose force is some periods late.
double amplitude_after(double stiffness_n_m, int late_periods) {
    constexpr double kMass = 0.25, kDamping = 0.05, kPeriod = 1e-3;
    constexpr int kSubsteps = 20;
    std::array<double, 8> forces{};
    double x = 1e-3, v = 0.0, most = 0.0;
    for (int i = 0; i < 60'000; ++i) {
        forces[static_cast<std::size_t>(i) % 8] = -stiffness_n_m * x;
        const double f = i < late_periods ? 0.0 : forces[static_cast<std::size_t>(i - late_periods) % 8];
        for (int k = 0; k < kSubsteps; ++k) {
            v += (f - kDamping * v) / kMass * kPeriod / kSubsteps;
            x += v * kPeriod / kSubsteps;
        }
        if (i > 55'000) most = std::max(most, std::abs(x));
    }
    return most;
}

TEST(StiffnessLimit, below_the_limit_a_delayed_spring_comes_to_rest_and_above_it_does_not) {
    for (const int late : {1, 2, 5}) {
        const double limit = stages::stiffness_max_n_m(0.05, 1e-3, late * 1e-3);
        EXPECT_LT(amplitude_after(0.7 * limit, late), 1e-3) << late;
        EXPECT_GT(amplitude_after(1.4 * limit, late), 1e-3) << late;
    }
}

TEST(OutputChain, a_motor_above_its_continuous_force_is_reduced_to_it_and_never_overheats) {
    ChainSettings settings;
    settings.force_n_continuous = 1.4;
    settings.heat_tau_s = 5.0;
    OutputChain chain(settings);
    ChainOutput out;
    for (int i = 0; i < 60000; ++i) {
        out = chain.apply(on(Vec3(3.3, 0.0, 0.0)));
        ASSERT_LE(out.heat, 1.0 + 1e-6);
    }
    // Equilibrium: theta = (F/Fc)^2, where F falls linearly from 3.3 N at 0.8 to 1.4 N at 1. Solved by bisection.
    double low = 0.8, high = 1.0;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        const double force = 3.3 + (middle - 0.8) / 0.2 * (1.4 - 3.3);
        ((force / 1.4) * (force / 1.4) > middle ? low : high) = middle;
    }
    EXPECT_NEAR(out.heat, low, 1e-3);
    EXPECT_NE(out.acts & kChainHeat, 0U);
}

TEST(OutputChain, heat_follows_the_exact_solution_for_any_step) {
    const double exact = 4.0 * (1.0 - std::exp(-2.0 / 60.0));
    double coarse = stages::heated(0.0, 2.0, 1.0, 60.0, 2.0);
    double fine = 0.0;
    for (int i = 0; i < 2000; ++i) fine = stages::heated(fine, 2.0, 1.0, 60.0, 1e-3);
    EXPECT_NEAR(coarse, exact, 1e-12);
    EXPECT_NEAR(fine, exact, 1e-9);
}

// A mass bounces on a sampled wall. Sampling adds energy (Colgate); the control dissipates it.
double bounce_energy_j(bool passivity) {
    PassivitySettings settings;
    settings.position_step = 3e-5;
    PassivityControl control(settings);
    const double m = 0.136, k = 2000.0, dt = 1e-3;
    double x = -1e-3, v = 0.0, x_before = x;
    for (int i = 0; i < 2000; ++i) {
        Vec3 force(x < 0.0 ? -k * x : 0.0, 0.0, 0.0);
        if (passivity) force = control.shape(force, Vec3(x - x_before, 0.0, 0.0), dt);
        control.applied(force);
        x_before = x;
        // The hand pushes towards the wall with 1 N.
        const double a = (force.x() - 1.0) / m;
        x += v * dt + 0.5 * a * dt * dt;
        v += a * dt;
    }
    return 0.5 * m * v * v + (x > 0.0 ? x : 0.5 * k * x * x);
}

TEST(PassivityControl, dissipates_the_energy_that_a_sampled_wall_adds) {
    EXPECT_LT(bounce_energy_j(true), 0.5 * bounce_energy_j(false));
}

TEST(PassivityControl, leaves_a_passive_force_unchanged) {
    PassivityControl control;
    double x = 0.0;
    for (int i = 1; i < 1000; ++i) {
        const double moved = 1e-5;
        x += moved;
        const Vec3 resisting(-100.0 * x, 0.0, 0.0);  // moving into a spring stores energy
        EXPECT_EQ(control.shape(resisting, Vec3(moved, 0.0, 0.0), 1e-3), resisting);
        control.applied(resisting);
    }
    EXPECT_NEAR(control.energy_j(), 0.5 * 100.0 * x * x, 0.01 * 0.5 * 100.0 * x * x);
}

TEST(PassivityControl, its_damping_is_bounded_by_mass_and_by_encoder_step) {
    for (const double dt : {1e-2, 1e-3, 2.5e-4}) {  // the mass decides at 100 Hz, the encoder above
        PassivitySettings settings;
        PassivityControl control(settings);
        control.applied(Vec3(10.0, 0.0, 0.0));
        const Vec3 moved(1e-4, 0.0, 0.0);
        const Vec3 shaped = control.shape(Vec3::Zero(), moved, dt);
        const double damping = shaped.norm() * dt / moved.norm();
        EXPECT_LE(damping, 0.5 * settings.inertia / dt * (1.0 + 1e-9));
        EXPECT_LE(damping, settings.felt * dt / settings.position_step * (1.0 + 1e-9));
        EXPECT_GT(damping, 0.0);
    }
}

TEST(PassivityControl, a_credit_is_used_up_before_it_damps) {
    PassivitySettings settings;
    settings.energy_start_j = 0.01;
    PassivityControl control(settings);
    EXPECT_EQ(control.energy_j(), 0.01);
    control.applied(Vec3(1.0, 0.0, 0.0));
    const Vec3 wanted(1.0, 0.0, 0.0), moved(1e-3, 0.0, 0.0);
    for (int i = 0; i < 9; ++i) EXPECT_EQ(control.shape(wanted, moved, 1e-3), wanted);
    for (int i = 0; i < 2; ++i) (void)control.shape(wanted, moved, 1e-3);
    EXPECT_LT(control.shape(wanted, moved, 1e-3).x(), 1.0);
    control.forget();
    EXPECT_EQ(control.energy_j(), 0.01);
}

}  // namespace
}  // namespace tact::safety_output_chain_test
