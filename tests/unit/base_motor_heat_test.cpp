// Heat of a motor: against fine explicit steps, closed forms, and the data sheet of a motor.
#include "ipc/base/motor_heat.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tact::base_motor_heat_test {
namespace {

// Motor RE25 of a Premium 1.5.
const MotorHeatParameters kMotor{2.18, 3.1, 14.0, 12.0, 612.0, 100.0};

MotorHeat by_small_steps(MotorHeat h, double current_a, double for_s) {
    const double cw = kMotor.winding_tau_s / kMotor.winding_k_w,
                 ch = kMotor.housing_tau_s / kMotor.housing_k_w;
    constexpr double kStep = 1e-3;
    for (double t = 0.0; t < for_s - 0.5 * kStep; t += kStep) {
        const double heat_w =
            current_a * current_a * kMotor.resistance_ohm * (1 + 0.0039 * (h.winding_c - 25));
        const double across_w = (h.winding_c - h.housing_c) / kMotor.winding_k_w;
        h.winding_c += kStep * (heat_w - across_w) / cw;
        h.housing_c += kStep * (across_w - (h.housing_c - 25.0) / kMotor.housing_k_w) / ch;
    }
    return h;
}

TEST(MotorHeat, one_step_of_any_length_equals_many_small_steps) {
    for (const double current_a : {0.0, 0.5, 1.24, 2.5, 5.5}) {
        for (const double for_s : {0.1, 3.0, 40.0}) {
            const MotorHeat start{60.0, 40.0};
            const MotorHeat slow = by_small_steps(start, current_a, for_s);
            const MotorHeat once = heated(kMotor, start, current_a, for_s);
            MotorHeat often = start;
            for (int i = 0; i < 1000; ++i) often = heated(kMotor, often, current_a, for_s / 1000);
            if (slow.winding_c > 900.0) continue;  // beyond the limit of the state
            EXPECT_NEAR(once.winding_c, slow.winding_c, 1e-3 * (slow.winding_c - 20.0))
                << current_a << " " << for_s;
            EXPECT_NEAR(once.housing_c, slow.housing_c, 1e-3 * (slow.housing_c - 20.0));
            EXPECT_NEAR(often.winding_c, once.winding_c, 1e-8);
        }
    }
}

TEST(MotorHeat, the_continuous_current_of_the_data_sheet_ends_at_the_limit_of_the_winding) {
    EXPECT_NEAR(continuous_current_a(kMotor), 1.24, 0.01);
    const MotorHeat end = heated(kMotor, {}, continuous_current_a(kMotor), 1e5);
    EXPECT_NEAR(end.winding_c, 100.0, 1e-6);
}

TEST(MotorHeat, without_current_it_cools_to_the_ambient) {
    const MotorHeat end = heated(kMotor, {150.0, 90.0}, 0.0, 1e5);
    EXPECT_NEAR(end.winding_c, 25.0, 1e-9);
    EXPECT_NEAR(end.housing_c, 25.0, 1e-9);
    const MotorHeat later = heated(kMotor, {150.0, 90.0}, 0.0, 60.0);
    EXPECT_GT(later.housing_c, 80.0);  // the housing stays hot for minutes
    EXPECT_LT(later.winding_c, 95.0);
}

TEST(MotorHeat, within_the_limit_the_winding_never_overheats) {
    MotorHeat h;
    double worst_c = 0.0;
    for (int i = 0; i < 400'000; ++i) {  // more than an hour at 10 ms
        h = heated(kMotor, h, current_limit_a(kMotor, h, 5.5), 0.01);
        worst_c = std::max(worst_c, h.winding_c);
    }
    EXPECT_LE(worst_c, 100.1);
    EXPECT_NEAR(current_limit_a(kMotor, h, 5.5), continuous_current_a(kMotor), 0.05);
}

TEST(MotorHeat, the_limit_falls_continuously_with_the_heat) {
    double before = current_limit_a(kMotor, {20.0, 20.0}, 5.5);
    EXPECT_EQ(before, 5.5);
    for (double c = 20.0; c <= 130.0; c += 0.1) {
        const double now = current_limit_a(kMotor, {c, 25.0}, 5.5);
        EXPECT_LE(now, before);
        EXPECT_GE(now, 0.0);
        EXPECT_LT(before - now, 0.05);
        before = now;
    }
    EXPECT_EQ(before, 0.0);
}

TEST(MotorHeat, invalid_input_keeps_it_finite) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(heated(kMotor, {30.0, 26.0}, nan, 1.0).winding_c, 30.0);
    EXPECT_EQ(heated(kMotor, {30.0, 26.0}, 1.0, nan).winding_c, 30.0);
    EXPECT_EQ(heated(kMotor, {30.0, 26.0}, 1.0, -1.0).winding_c, 30.0);
    for (const double current_a : {5.5, 100.0, 1e300}) {
        for (const double dt : {1e-3, 10.0, 1e9}) {
            const MotorHeat h = heated(kMotor, {}, current_a, dt);
            EXPECT_TRUE(std::isfinite(h.winding_c) && std::isfinite(h.housing_c)) << current_a << " " << dt;
            EXPECT_LE(h.winding_c, kHeatCMax);
            EXPECT_GE(h.winding_c, 25.0);
        }
    }
}

}  // namespace
}  // namespace tact::base_motor_heat_test
