// Fades last a stated time at any rate, against the analytic curve.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "rt/force/force_fade.hpp"

namespace tact::force_fade_test {
namespace {

constexpr double kFadeS = 0.256;

double smooth(double t_s) {
    const double s = std::clamp(t_s / kFadeS, 0.0, 1.0);
    return 3.0 * s * s - 2.0 * s * s * s;
}

class AtRate : public testing::TestWithParam<double> {
protected:
    [[nodiscard]] static double step_s() { return 1.0 / GetParam(); }
};

TEST_P(AtRate, the_gain_rises_and_falls_along_its_curve_in_a_quarter_of_a_second) {
    ForceFade fade;
    EXPECT_EQ(fade.gain(), 0.0);
    double t_s = 0.0;
    while (t_s < 0.4) {
        fade.begin_step(step_s());
        fade.rise();
        t_s += step_s();
        ASSERT_NEAR(fade.gain(), smooth(t_s), 1e-9) << t_s;
    }
    EXPECT_EQ(fade.gain(), 1.0);
    for (t_s = 0.0; t_s < 0.4;) {
        fade.begin_step(step_s());
        fade.fall();
        t_s += step_s();
        ASSERT_NEAR(fade.gain(), 1.0 - smooth(t_s), 1e-9) << t_s;
    }
    EXPECT_EQ(fade.gain(), 0.0);
}

TEST_P(AtRate, the_force_of_what_left_is_gone_after_83_milliseconds_and_what_is_felt_waits_for_it) {
    ForceFade before, fade;
    const Wrench left{Vec3(0.0, 3.3, 0.0), Vec3(0.1, 0.0, 0.0)};
    static_cast<void>(before.show(left));
    fade.follow(before);
    for (double t_s = step_s(); t_s < 0.2; t_s += step_s()) {
        fade.begin_step(step_s());
        fade.rise();
        const Wrench shown = fade.show({});
        ASSERT_NEAR(shown.force_n.y(), std::max(3.3 - 40.0 * t_s, 0.0), 1e-9) << t_s;
        ASSERT_NEAR(shown.torque_n_m.x(), std::max(0.1 - 2.0 * t_s, 0.0), 1e-9) << t_s;
        if (shown.force_n.y() > 0.0) {
            EXPECT_EQ(fade.gain(), 0.0);
        }
        // A step more or less than the time since.
        EXPECT_LE(fade.gain(), smooth(t_s + step_s() - 0.0825) + 1e-9);
        EXPECT_GE(fade.gain(), smooth(t_s - step_s() - 0.0825) - 1e-9);
    }
    EXPECT_GT(fade.gain(), 0.3);
}

TEST_P(AtRate, orders_in_quick_succession_do_not_hold_up_what_leaves) {
    ForceFade fade;
    fade.begin_step(step_s());
    static_cast<void>(fade.show({Vec3(2.0, 0.0, 0.0), Vec3::Zero()}));
    for (double t_s = 0.0; t_s < 0.05; t_s += step_s()) {
        fade.follow(fade);
        fade.begin_step(step_s());
        static_cast<void>(fade.show({}));
    }
    EXPECT_NEAR(fade.show({}).force_n.x(), 0.0, 1e-9);
}

TEST_P(AtRate, a_force_far_beyond_any_device_shrinks_by_half_in_a_seventh_of_a_second) {
    ForceFade fade;
    static_cast<void>(fade.show({Vec3(1e6, 0.0, 0.0), Vec3::Zero()}));
    fade.follow(fade);
    double t_s = 0.0;
    for (; t_s < 0.1386; t_s += step_s()) {
        fade.begin_step(step_s());
        static_cast<void>(fade.show({}));
    }
    EXPECT_NEAR(fade.show({}).force_n.x(), 1e6 * std::exp(-5.0 * t_s), 2e4);
}

TEST_P(AtRate, the_steps_of_a_ramp_are_counted) {
    EXPECT_EQ(ForceFade::ramp_steps(step_s()), static_cast<int>(std::ceil(kFadeS * GetParam() - 1e-9)));
}

INSTANTIATE_TEST_SUITE_P(ForceFade, AtRate, testing::Values(100.0, 1000.0, 20000.0), [](const auto& rate) {
    return std::to_string(static_cast<int>(rate.param)) + "_hz";
});

TEST(ForceFade, steps_of_changing_length_add_up) {
    ForceFade fade;
    double t_s = 0.0;
    for (int i = 0; t_s < 0.2; ++i) {
        const double step_s = i % 3 == 0 ? 5e-5 : i % 3 == 1 ? 1e-3 : 7e-3;
        fade.begin_step(step_s);
        fade.rise();
        t_s += step_s;
        ASSERT_NEAR(fade.gain(), smooth(t_s), 1e-9);
    }
}

TEST(ForceFade, at_1_khz_a_ramp_takes_256_steps_with_the_gain_of_a_count) {
    ForceFade fade;
    for (int i = 1; i <= 256; ++i) {
        fade.begin_step(1e-3);
        fade.rise();
        const double s = i / 256.0;
        ASSERT_EQ(fade.gain(), s * s * (3.0 - 2.0 * s)) << i;
    }
    ForceFade leaving;
    static_cast<void>(leaving.show({Vec3(3.3, 0.0, 0.0), Vec3::Zero()}));
    leaving.follow(leaving);
    for (int i = 1; i <= 83; ++i) {
        EXPECT_GT(leaving.show({}).force_n.x(), 0.0) << i;
        leaving.begin_step(1e-3);
    }
    EXPECT_EQ(leaving.show({}).force_n.x(), 0.0);
}

TEST(ForceFade, a_jump_of_the_model_is_absorbed_and_gone_after_its_way) {
    ForceFade fade;
    for (int i = 0; i < 300; ++i) {
        fade.begin_step(1e-3);
        fade.rise();
        static_cast<void>(fade.show({Vec3(1.0, 0.0, 0.0), Vec3::Zero()}));
    }
    double before_n = 1.0;
    const Wrench other{Vec3(0.5, 0.0, 0.0), Vec3::Zero()};
    for (int i = 0; i < 20; ++i) {
        fade.begin_step(1e-3);
        if (i == 0) fade.absorb(other, 1.0, 0.01);
        const double now_n = fade.show(other).force_n.x();
        EXPECT_NEAR(now_n, std::max(1.0 - 0.04 * i, 0.5), 1e-12) << i;
        EXPECT_NEAR(fade.leaving_n(0.01), now_n - 0.5, 1e-12);
        EXPECT_LE(before_n - now_n, 0.04 + 1e-12);
        before_n = now_n;
    }
    EXPECT_EQ(fade.gain(), 1.0);
    // What the model cannot explain is shown at once; torques count at the lever.
    fade.absorb({Vec3(0.1, 0.0, 0.0), Vec3::Zero()}, 0.1, 0.01);
    EXPECT_NEAR(fade.show({Vec3(0.1, 0.0, 0.0), Vec3::Zero()}).force_n.x(), 0.2, 1e-12);
    fade.absorb({Vec3(0.2, 0.0, 0.0), Vec3(0.0, 0.004, 0.0)}, 0.1, 0.01);
    EXPECT_NEAR(fade.show({Vec3(0.2, 0.0, 0.0), Vec3(0.0, 0.004, 0.0)}).torque_n_m.y(), 0.003, 1e-12);
    EXPECT_NEAR(fade.leaving_n(0.01), 0.1, 1e-12);
}

TEST(ForceFade, a_pause_or_an_impossible_length_is_no_step_of_the_force) {
    for (const double step_s : {10.0, std::numeric_limits<double>::infinity()}) {
        ForceFade fade;
        fade.begin_step(step_s);
        fade.rise();
        EXPECT_NEAR(fade.gain(), smooth(0.02), 1e-12);
    }
    for (const double step_s : {0.0, -1.0, -std::numeric_limits<double>::infinity()}) {
        ForceFade fade;
        fade.begin_step(step_s);
        fade.rise();
        EXPECT_EQ(fade.gain(), 0.0);
    }
    ForceFade fade;
    fade.begin_step(std::nan(""));
    fade.rise();
    EXPECT_NEAR(fade.gain(), smooth(1e-3), 1e-12);
}

}  // namespace
}  // namespace tact::force_fade_test
