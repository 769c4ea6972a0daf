// The smooth gain: its law against the closed form, no step in gain or slope, and its effect on a hand.
#include "rt/safety/smooth_gain.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "rt/safety/stages.hpp"

namespace tact::safety_smooth_gain_test {
namespace {

constexpr double kMs = 1e-3;

TEST(SmoothGain, applies_two_equal_lags_to_the_logarithm_faster_down_than_up) {
    for (const auto& [from, to, tau_s] : {std::array{1.0, 0.25, 0.1}, std::array{0.25, 1.0, 0.25}}) {
        SmoothGain g;
        g.settle(from);
        for (int ms = 1; ms <= 2000; ++ms) {
            const double gain = g.follow(to, kMs);
            const double t = ms * kMs / tau_s;
            const double left = (1.0 + t) * std::exp(-t);
            EXPECT_NEAR(std::log(gain), std::log(to) + left * std::log(from / to), 0.01) << ms;
        }
        EXPECT_NEAR(g.gain(), to, 0.01 * to);
    }
}

TEST(SmoothGain, settle_takes_the_gain_at_once_and_keeps_it_exactly) {
    SmoothGain g;
    g.settle(0.3);
    const double there = g.gain();
    EXPECT_NEAR(there, 0.3, 1e-12);
    for (int i = 0; i < 100; ++i) EXPECT_EQ(g.follow(0.3, kMs), there);
}

TEST(SmoothGain, the_gain_stays_in_range_without_steps_in_gain_or_slope) {
    constexpr double kLeast = 0.05;
    // Largest change of the logarithm per cycle: the whole range through one lag; through both, for the slope.
    const double way = std::log(1.0 / kLeast), share = kMs / SmoothGain::kDownS;
    EXPECT_TRUE(rc::check([&] {
        SmoothGain g;
        double low = *rc::gen::inRange(50, 1001) * 1e-3, high = low;
        g.settle(low);
        double before = std::log(g.gain()), slope = 0.0;
        for (int change = 0; change < 20; ++change) {
            const double wanted = *rc::gen::inRange(50, 1001) * 1e-3;
            low = std::min(low, wanted);
            high = std::max(high, wanted);
            const int cycles = *rc::gen::inRange(1, 400);
            for (int i = 0; i < cycles; ++i) {
                const double gain = g.follow(wanted, kMs);
                RC_ASSERT(gain > low * (1.0 - 1e-9) && gain < high * (1.0 + 1e-9));
                const double now = std::log(gain) - before;
                RC_ASSERT(std::abs(now) <= way * share);
                RC_ASSERT(std::abs(now - slope) <= 2.0 * way * share * share);
                before += now;
                slope = now;
            }
        }
    }));
}

TEST(SmoothGain, a_gain_of_zero_or_beyond_one_is_bounded) {
    SmoothGain g;
    g.settle(0.0);
    EXPECT_GT(g.gain(), 0.0);
    g.settle(7.0);
    EXPECT_EQ(g.gain(), 1.0);
}

// A hand of 0.25 kg and 3 N s/m on a field with a sampled damper, both late by a number of periods.
struct Hand {
    int late = 1;
    double x = 1e-4, v = 0.0;
    std::array<double, 64> x_at{}, v_at{};
    int cycle = 0;

    void period(double stiffness_n_m, double damping_n_s_m, double mass_kg = 0.25, double b_n_s_m = 3.0) {
        constexpr int kSubsteps = 20;
        x_at[static_cast<std::size_t>(cycle) % 64] = x;
        v_at[static_cast<std::size_t>(cycle) % 64] = v;
        const auto then = static_cast<std::size_t>(std::max(cycle - late, 0)) % 64;
        const double f = -stiffness_n_m * x_at[then] - damping_n_s_m * v_at[then];
        for (int k = 0; k < kSubsteps; ++k) {
            v += (f - b_n_s_m * v) / mass_kg * kMs / kSubsteps;
            x += v * kMs / kSubsteps;
        }
        ++cycle;
    }
};

TEST(SmoothGain, a_vibration_at_twice_the_stable_stiffness_stays_small_and_dies_out) {
    const double b = 3.0, stable_late = stages::stiffness_max_n_m(b, kMs, 5 * kMs);
    const double stiffness = 2.0 * stable_late;
    ASSERT_LT(stiffness, stages::stiffness_max_n_m(b, kMs, kMs));
    for (const bool glides : {true, false}) {
        Hand hand;
        for (int i = 0; i < 30; ++i) hand.period(stiffness, 0.0);
        hand.late = 5;
        SmoothGain g;
        g.settle(1.0);
        double most = 0.0;
        for (int i = 0; i < 2000; ++i) {
            hand.period(stiffness * (glides ? g.follow(0.9 * stable_late / stiffness, kMs) : 1.0), 0.0);
            most = std::max(most, std::abs(hand.x));
        }
        if (glides) {
            EXPECT_LT(most, 5e-4);
            double last = 0.0;
            for (int i = 0; i < 3000; ++i) {
                hand.period(stiffness * g.follow(0.9 * stable_late / stiffness, kMs), 0.0);
                if (i > 2500) last = std::max(last, std::abs(hand.x));
            }
            EXPECT_LT(last, 1e-4);
        } else {
            EXPECT_GT(most, 1.0);
        }
    }
}

TEST(DampingLimit, within_the_limit_a_late_damper_damps_and_at_twice_it_oscillates) {
    for (const int late : {1, 5, 20}) {
        for (const double mass_kg : {0.1, 0.25}) {
            const double damping = stages::damping_max_n_s_m(mass_kg, kMs, late * kMs);
            const double stiffness = 0.7 * stages::stiffness_max_n_m(3.0, kMs, late * kMs);
            const auto end = [&](double k, double rendered, double b_n_s_m) {
                Hand hand;
                hand.late = late;
                hand.v = 0.01;
                double most = 0.0;
                for (int i = 0; i < 4000; ++i) {
                    hand.period(k, rendered, mass_kg, b_n_s_m);
                    if (i > 3500) most = std::max(most, std::abs(hand.v));
                }
                return most;
            };
            EXPECT_LT(end(stiffness, damping, 3.0), 1e-5) << late << " " << mass_kg;
            EXPECT_LE(end(stiffness, damping, 3.0), end(stiffness, 0.0, 3.0)) << late << " " << mass_kg;
            EXPECT_GT(end(0.0, 2.0 * damping, 0.1), 0.1) << late << " " << mass_kg;
        }
    }
}

}  // namespace
}  // namespace tact::safety_smooth_gain_test
