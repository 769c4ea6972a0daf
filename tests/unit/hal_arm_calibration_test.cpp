// Calibration of each style in simulated time: its notices, its end, and its restart.
#include "hal/arm/calibration.hpp"

#include <gtest/gtest.h>

#include "tests/unit/hal_arm_samples.hpp"

namespace tact::hal_arm_calibration_test {
namespace {

class Bench {
public:
    explicit Bench(const char* model) : arm(sample::arm(model)), calibration(arm.parameters()) {
        in.counts_valid = true;
        in.counts = {1000, -2000, 3000, 40, 50, 60};
    }
    CalibrationState run(int steps) {
        CalibrationState s = calibration.state();
        for (int i = 0; i < steps; ++i) {
            now += std::chrono::milliseconds(1);
            s = calibration.step(in, now);
            EXPECT_EQ(calibration.force_allowed(), s == CalibrationState::done);
            EXPECT_EQ(calibration.asks() == DeviceNotice::none, s == CalibrationState::done);
        }
        return s;
    }
    ArmKinematics arm;
    Calibration calibration;
    CalibrationInput in;
    Instant now = instant_from_ns(1'000'000'000);
};

TEST(ResetPose, needs_a_confirmation_and_half_a_second_of_stillness) {
    Bench b("premium-1.5");
    EXPECT_EQ(b.run(2000), CalibrationState::waiting);
    b.in.confirm = true;
    EXPECT_EQ(b.run(1), CalibrationState::holding);
    EXPECT_EQ(b.run(499), CalibrationState::holding);
    EXPECT_EQ(b.run(1), CalibrationState::done);
    EXPECT_EQ(b.calibration.zero()[1], -2000);
    EXPECT_LT(b.arm.angles_rad(b.in.counts, b.calibration.zero()).norm(), 1e-12);
}

TEST(ResetPose, a_button_pressed_from_the_start_is_no_confirmation) {
    Bench b("premium-1.5");
    b.in.confirm = true;
    EXPECT_EQ(b.run(2000), CalibrationState::waiting);
    b.in.confirm = false;
    b.run(10);
    b.in.confirm = true;
    EXPECT_EQ(b.run(502), CalibrationState::done);
}

TEST(ResetPose, an_arm_that_moves_has_to_be_confirmed_again) {
    Bench b("premium-1.5");
    b.run(1);
    b.in.confirm = true;
    b.run(300);
    b.in.counts[2] += 1000;
    EXPECT_EQ(b.run(1000), CalibrationState::waiting);
    // A slow drift counts as motion.
    b.in.confirm = false;
    b.run(1);
    b.in.confirm = true;
    b.run(1);
    for (int i = 0; i < 400; ++i) {
        b.in.counts[0] += 1;
        b.run(1);
    }
    EXPECT_EQ(b.calibration.state(), CalibrationState::waiting);
}

TEST(ResetPose, a_tremor_of_a_few_steps_counts_as_still_and_the_mean_is_used) {
    Bench b("premium-1.5");
    b.run(1);
    b.in.confirm = true;
    for (int i = 0; i < 600; ++i) {
        b.in.counts[0] = 1000 + (i % 2 == 0 ? 0 : 10);
        b.run(1);
    }
    EXPECT_EQ(b.calibration.state(), CalibrationState::done);
    EXPECT_EQ(b.calibration.zero()[0], 1005);
}

TEST(ResetPose, a_gap_in_the_samples_does_not_count_as_stillness) {
    Bench b("premium-1.5");
    b.run(1);
    b.in.confirm = true;
    b.run(10);
    b.now += std::chrono::seconds(2);
    EXPECT_EQ(b.run(1), CalibrationState::waiting);
}

TEST(Inkwell, a_still_stylus_in_the_inkwell_is_enough) {
    Bench b("omni");
    EXPECT_EQ(b.run(1000), CalibrationState::waiting);
    b.in.inkwell = true;
    EXPECT_EQ(b.run(400), CalibrationState::holding);
    b.in.inkwell = false;
    EXPECT_EQ(b.run(1), CalibrationState::waiting);
    b.in.inkwell = true;
    b.run(400);
    b.in.counts[0] += 500;  // a push: the time restarts
    EXPECT_EQ(b.run(499), CalibrationState::holding);
    EXPECT_EQ(b.run(2), CalibrationState::done);
    const Vec3 tip = b.arm.tip_m(b.arm.angles_rad(b.in.counts, b.calibration.zero()));
    EXPECT_LT((tip - Vec3(0.0, -0.0655107, -0.0881142)).norm(), 1e-5);  // position of the inkwell
    b.in.inkwell = false;
    EXPECT_EQ(b.run(1000), CalibrationState::done);
}

TEST(Automatic, is_done_after_the_device_reports_it_for_half_a_second) {
    Bench b("desktop");
    EXPECT_EQ(b.run(1000), CalibrationState::waiting);
    b.in.device_calibrated = true;
    b.run(300);
    b.in.device_calibrated = false;
    EXPECT_EQ(b.run(1), CalibrationState::waiting);
    b.in.device_calibrated = true;
    for (int i = 0; i < 502; ++i) {
        b.in.counts[0] += 50;  // the arm may move
        b.run(1);
    }
    EXPECT_EQ(b.calibration.state(), CalibrationState::done);
    EXPECT_EQ(b.calibration.zero(), Counts6{});
    b.in.device_calibrated = false;
    EXPECT_EQ(b.run(1), CalibrationState::waiting);
}

TEST(AnyStyle, lost_counts_restart_the_calibration) {
    for (const char* model : {"premium-1.5", "omni", "desktop"}) {
        Bench b(model);
        b.in.inkwell = b.in.device_calibrated = true;
        b.run(1);
        b.in.confirm = true;
        ASSERT_EQ(b.run(600), CalibrationState::done) << model;
        b.in.counts_valid = false;
        EXPECT_EQ(b.run(1), CalibrationState::waiting);
        b.in.counts_valid = true;
        b.in.inkwell = b.in.device_calibrated = false;
        EXPECT_EQ(b.run(2000), CalibrationState::waiting) << "confirm is still down";
        b.calibration.restart();
        EXPECT_FALSE(b.calibration.force_allowed());
    }
}

}  // namespace
}  // namespace tact::hal_arm_calibration_test
