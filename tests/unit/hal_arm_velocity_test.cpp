// Velocity from quantised positions against the true velocity, at rest and in motion, with uneven sample times.
#include "hal/arm/velocity.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/unit/hal_arm_samples.hpp"

namespace tact::hal_arm_velocity_test {
namespace {

template <class Property>
void for_all(Property&& property) {
    EXPECT_TRUE(rc::check(property));
}

using std::chrono::microseconds;
using std::chrono::milliseconds;

Instant at_us(double us) { return instant_from_ns(1'000'000'000 + std::llround(us * 1e3)); }
double stepped(double x, double step) { return std::round(x / step) * step; }

TEST(Velocity, is_exactly_zero_at_rest) {
    VelocityWindow v;
    for (int i = 0; i < 200; ++i) EXPECT_EQ(v.push(12345.0, at_us(1000.0 * i)), 0.0);
}

TEST(Velocity, at_rest_between_two_steps_it_stays_below_two_steps_per_window) {
    for (const double period_us : {125.0, 250.0, 1000.0, 2000.0}) {
        VelocityWindow v;
        std::mt19937_64 random(7);
        double worst = 0.0;
        for (int i = 0; i < 4000; ++i) {
            const double now = v.push(static_cast<double>(random() % 2), at_us(period_us * i));
            if (i * period_us > 60e3) worst = std::max(worst, std::abs(now));
        }
        EXPECT_LE(worst, 2.0 / 0.027) << period_us;
    }
}

TEST(Velocity, at_constant_speed_it_uses_the_whole_window_with_an_error_below_two_steps) {
    for_all([] {
        const double speed = *rc::gen::inRange(-200'000, 200'001) * 0.01;  // steps a second
        const double offset = *rc::gen::inRange(0, 1000) * 1e-3;
        VelocityWindow v;
        std::mt19937_64 random(*rc::gen::inRange(0, 1000));
        double t_us = 0.0;
        for (int i = 0; i < 200; ++i) {
            t_us += 600.0 + static_cast<double>(random() % 800);  // 0.6 to 1.4 ms
            const double now = v.push(std::round(offset + speed * t_us * 1e-6), at_us(t_us));
            if (t_us < 60e3) continue;
            RC_ASSERT(v.window() > milliseconds(27));
            RC_ASSERT(std::abs(now - speed) <= 2.0 / to_s(v.window()) + 1e-6);
        }
    });
}

// A Premium's 0.03 mm at 1 kHz; a hand that moves by 2 cm at 2 Hz: 0.25 m/s, 3.2 m/s^2.
struct Errors {
    double rms = 0.0, worst = 0.0;
};

template <class Estimate>
Errors against_truth(Estimate&& estimate, double period_us, double jitter_us) {
    constexpr double kStep = 3e-5, kAmplitude = 0.02, kRate = 2.0 * M_PI * 2.0;
    std::mt19937_64 random(11);
    Errors e;
    int n = 0;
    for (double t_us = 0.0; t_us < 4e6;
         t_us += period_us + jitter_us * (static_cast<double>(random() % 2001) * 1e-3 - 1.0)) {
        const double t = t_us * 1e-6;
        const double seen = estimate(stepped(kAmplitude * std::sin(kRate * t), kStep), at_us(t_us));
        if (t < 0.1) continue;
        const double error = std::abs(seen - kAmplitude * kRate * std::cos(kRate * t));
        e.worst = std::max(e.worst, error);
        e.rms += error * error;
        ++n;
    }
    e.rms = std::sqrt(e.rms / n);
    return e;
}

TEST(Velocity, in_motion_it_beats_finite_differences_and_a_low_pass) {
    for (const double jitter_us : {0.0, 300.0}) {
        VelocityWindow window(3e-5);
        const Errors ours =
            against_truth([&](double x, Instant t) { return window.push(x, t); }, 1000.0, jitter_us);

        double x_before = 0.0, slow = 0.0;
        Instant t_before = at_us(-1000.0);
        const auto difference = [&](double x, Instant t) {
            const double v = (x - x_before) / to_s(t - t_before);
            const double share = 1.0 - std::exp(-2.0 * M_PI * 30.0 * to_s(t - t_before));
            x_before = x;
            t_before = t;
            slow += share * (v - slow);
            return v;
        };
        const Errors raw = against_truth(difference, 1000.0, jitter_us);
        x_before = slow = 0.0;
        t_before = at_us(-1000.0);
        const Errors low_pass =
            against_truth([&](double x, Instant t) { return difference(x, t), slow; }, 1000.0, jitter_us);
        EXPECT_LT(ours.rms, 0.008) << jitter_us;
        EXPECT_LT(ours.worst, 0.020);
        EXPECT_LT(ours.rms, 0.7 * raw.rms);
        EXPECT_LT(ours.rms, 0.7 * low_pass.rms);
    }
}

TEST(Velocity, a_start_appears_at_once_and_a_stop_within_a_window) {
    VelocityWindow v(3e-5);
    double t_us = 0.0, x = 0.0;
    for (int i = 0; i < 100; ++i, t_us += 1000.0) v.push(0.0, at_us(t_us));
    for (int i = 1; i <= 5; ++i, t_us += 1000.0) {
        x += 0.2e-3;  // 0.2 m/s from this sample on
        const double now = v.push(stepped(x, 3e-5), at_us(t_us));
        if (i >= 2) {
            EXPECT_NEAR(now, 0.2, 0.05) << i;
        }
    }
    for (int i = 0; i < 35; ++i, t_us += 1000.0) v.push(stepped(x, 3e-5), at_us(t_us));
    EXPECT_EQ(v.per_s(), 0.0);
}

TEST(Velocity, stays_within_the_range_that_two_consecutive_samples_allow) {
    for_all([] {
        VelocityWindow v;
        double t_us = 0.0, x = 0.0;
        for (int i = 0; i < 100; ++i) {
            const double dt_us = *rc::gen::inRange(50, 5000);
            const double move = *rc::gen::inRange(-20, 21);
            t_us += dt_us;
            x += move;
            const double now = v.push(x, at_us(t_us));
            if (i == 0) continue;
            RC_ASSERT(now <= (move + 1.0) / (dt_us * 1e-6) + 1e-6 ||
                      v.window() > microseconds(std::llround(dt_us)));
            RC_ASSERT(std::isfinite(now));
        }
    });
}

TEST(Velocity, time_that_stops_runs_back_or_jumps_does_no_harm) {
    VelocityWindow v;
    EXPECT_EQ(v.push(0.0, at_us(0)), 0.0);
    EXPECT_NEAR(v.push(10.0, at_us(1000)), 1e4, 1e-6);
    const double before = v.per_s();
    EXPECT_EQ(v.push(50.0, at_us(1000)), before);
    EXPECT_EQ(v.push(50.0, at_us(500)), before);
    EXPECT_EQ(v.push(std::numeric_limits<double>::quiet_NaN(), at_us(2000)), before);
    EXPECT_EQ(v.push(1e9, at_us(1e6)), 0.0);  // after a gap of a second the speed is unknown
}

TEST(ArmVelocity, linear_and_angular_velocity_come_from_the_same_encoders) {
    const ArmKinematics arm = sample::arm("premium-1.5-6dof");
    ArmVelocity velocity(arm);
    const Counts6 zero{100, 200, 300, 400, 500, 600};
    const auto path = [](double t) {
        return sample::joints(0.3 * std::sin(3 * t), 0.5 + 0.2 * std::sin(2 * t),
                              0.4 + 0.3 * std::cos(2.5 * t), 0.5 * std::sin(4 * t), 0.3 * std::cos(3 * t),
                              0.8 * std::sin(2 * t));
    };
    std::mt19937_64 random(3);
    double worst_m_s = 0.0, worst_rad_s = 0.0;
    for (double t = 0.0; t < 2.0; t += 0.0007 + 0.0006 * static_cast<double>(random() % 1000) * 1e-3) {
        const Counts6 counts = arm.counts(path(t), zero);
        const Joint6 q = arm.angles_rad(counts, zero);
        const Twist seen = velocity.push(counts, q, at_us(t * 1e6));
        if (t < 0.1) continue;
        const Joint6 rad_s = (path(t + 1e-6) - path(t - 1e-6)) / 2e-6;
        const Twist truth = arm.twist(path(t), rad_s);
        worst_m_s = std::max(worst_m_s, (seen.linear_m_s - truth.linear_m_s).norm());
        worst_rad_s = std::max(worst_rad_s, (seen.angular_rad_s - truth.angular_rad_s).norm());
    }
    EXPECT_LT(worst_m_s, 0.03);
    EXPECT_LT(worst_rad_s, 0.25);
    velocity.reset();
    EXPECT_EQ(velocity.joint_rad_s(), Joint6::Zero());
}

}  // namespace
}  // namespace tact::hal_arm_velocity_test
