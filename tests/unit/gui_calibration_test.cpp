// The calibration of a stage without a window: measurement at rest, steps and displayed text.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "gui/stereo/calibration.hpp"
#include "ipc/base/random.hpp"

namespace tact::gui_calibration_test {
namespace {

double normal(SeededRandom& random) {
    return std::sqrt(-2.0 * std::log(1.0 - random.uniform())) *
           std::cos(2.0 * std::numbers::pi * random.uniform());
}
Vec3 noise(SeededRandom& random, double m) {
    const double x = normal(random), y = normal(random), z = normal(random);
    return m * Vec3(x, y, z);
}

// The unknowns of the calibration: a leaning screen, an arm rotated against the tracker, a wand tip.
struct Lab {
    Pose T_screen_glass{Vec3(0.12, -0.08, -0.4), quat_from_rotation_vector(Vec3(-0.3, 0.2, 0.05))};
    double width_m = 0.8, height_m = 0.45;
    Pose T_screen_world{Vec3(0.05, -0.2, 0.15), quat_from_rotation_vector(Vec3(0.1, 1.2, -0.2))};
    Vec3 tip_sensor_m{0.01, -0.02, 0.11};

    [[nodiscard]] Vec3 mark_screen_m(std::size_t i) const {
        return T_screen_glass *
               Vec3((kMarkPlaces[i][0] - 0.5) * width_m, (kMarkPlaces[i][1] - 0.5) * height_m, 0.0);
    }
    [[nodiscard]] ScreenPlace screen() const {
        const ScreenPlace flat = ScreenPlace::of_size(width_m, height_m);
        return {T_screen_glass * flat.lower_left_m, T_screen_glass * flat.lower_right_m,
                T_screen_glass * flat.upper_left_m};
    }
};

// A person in front of the screen; one frame every 20 ms.
class Person {
public:
    Person(const Lab& lab, Calibration& calibration) : lab_(lab), calibration_(calibration) {}

    double noise_m = 1e-3;
    bool seen = true, arm = true, button = false;

    void frame(const Vec3& wand_screen_m, const Vec3& stylus_world_m, const Quat& turn = Quat::Identity()) {
        time_s_ += 0.02;
        CalibrationInput in;
        in.now_s = time_s_;
        in.sensor_good = seen;
        in.sensor_at_ns = in.hand_at_ns = static_cast<std::int64_t>(1e9 * time_s_);
        in.T_screen_sensor = {wand_screen_m - turn * lab_.tip_sensor_m + noise(random_, noise_m), turn};
        in.hand_good = arm;
        in.stylus_world_m = stylus_world_m + noise(random_, 0.3 * noise_m);
        in.button = button;
        calibration_.follow(in);
    }
    void touch(const Vec3& wand_screen_m, const Vec3& stylus_world_m = Vec3::Zero(), int frames = 60) {
        frame(wand_screen_m, stylus_world_m);
        calibration_.take();
        for (int i = 0; i < frames && calibration_.measuring(); ++i) frame(wand_screen_m, stylus_world_m);
    }
    SeededRandom& random() { return random_; }

private:
    const Lab& lab_;
    Calibration& calibration_;
    SeededRandom random_{7};
    double time_s_ = 10.0;
};

StageSettings start_of(const Lab& lab) {
    StageSettings s;
    s.wand_tip_sensor_m = lab.tip_sensor_m;
    return s;
}

void touch_screen(Person& person, Calibration& calibration, const Lab& lab) {
    calibration.set_picture_size(lab.width_m, lab.height_m);
    calibration.go(CalibrationStep::screen);
    for (std::size_t i = 0; i < kMarks; ++i) {
        ASSERT_EQ(calibration.marks().current, i);
        person.touch(lab.mark_screen_m(i));
        ASSERT_TRUE(calibration.marks().mark[i].taken) << calibration.live() << calibration.message();
    }
}

double apart_rad(const Quat& a, const Quat& b) { return rotation_vector_rad(a * b.conjugate()).norm(); }

TEST(RestWindow, takes_the_mean_and_spread_of_a_second_at_rest) {
    SeededRandom random(3);
    RestWindow window(4e-3);
    window.start(0.0);
    const Vec3 at(0.1, 0.2, 0.3);
    double t = 0.0;
    // Moving at 0.2 m/s: no second stays within 4 mm.
    for (int i = 0; i < 100; ++i, t += 0.02) {
        window.add(t, i + 1, at + Vec3(0.2 * (t - 2.0), 0.0, 0.0), true);
        ASSERT_NE(window.state(), RestWindow::State::done);
    }
    EXPECT_NE(window.text("the wand").find("hold the wand still"), std::string::npos);
    int frames = 0;
    for (; window.state() != RestWindow::State::done && frames < 200; ++frames, t += 0.02)
        window.add(t, 200 + frames, at + noise(random, 1e-3), true);
    EXPECT_GE(frames, 45);  // samples from the motion have left the window
    EXPECT_LT((window.mean_m() - at).norm(), 1e-3);
    // A hand that sinks by 4 mm/s is not at rest, even with a small spread.
    RestWindow sinking(4e-3);
    sinking.start(0.0);
    for (int i = 0; i < 200; ++i) {
        sinking.add(0.02 * i, i + 1, Vec3(0.0, -4e-3 * 0.02 * i, 0.0), true);
        ASSERT_NE(sinking.state(), RestWindow::State::done);
    }
    EXPECT_NEAR(window.spread_m(), std::sqrt(3.0) * 1e-3, 0.8e-3);
}

TEST(RestWindow, repeated_and_non_finite_samples_do_not_count_and_silence_restarts) {
    RestWindow window(2e-3);
    window.start(0.0);
    const Vec3 at(0.1, 0.0, 0.0);
    for (int i = 0; i < 40; ++i) window.add(0.02 * i, 5, at, true);  // the same sample repeatedly
    EXPECT_LE(window.samples(), 1U);
    EXPECT_TRUE(window.silent());
    EXPECT_NE(window.text("the wand").find("lost"), std::string::npos);
    double t = 0.8;
    for (int i = 0; i < 30; ++i, t += 0.02) window.add(t, 100 + i, at, true);
    EXPECT_EQ(window.state(), RestWindow::State::resting);
    for (int i = 0; i < 20; ++i, t += 0.02) window.add(t, 200 + i, Vec3(NAN, 0.0, 0.0), true);
    for (int i = 0; i < 20; ++i, t += 0.02) window.add(t, 300 + i, at, false);
    EXPECT_EQ(window.samples(), 0U);
    for (int i = 0; i < 1200; ++i, t += 0.02) window.add(t, 400 + i, at, false);
    EXPECT_EQ(window.state(), RestWindow::State::failed);
    EXPECT_NE(window.text("the wand").find("no data"), std::string::npos);
}

TEST(Calibration, finds_screen_and_workspace_from_noisy_touches_with_a_residual_of_the_noise) {
    const Lab lab;
    Calibration calibration(start_of(lab));
    Person person(lab, calibration);
    touch_screen(person, calibration, lab);
    EXPECT_EQ(calibration.status().grade, FitGrade::green) << calibration.status().text;
    // Noise of 1 mm per axis, averaged over about fifty samples: a seventh of it.
    EXPECT_LT(calibration.marks().fit.residual_m_rms, 0.6e-3);
    EXPECT_GT(calibration.marks().fit.residual_m_rms, 0.02e-3);
    const ScreenPlace truth = lab.screen(), found = calibration.draft().screen;
    EXPECT_LT((found.lower_left_m - truth.lower_left_m).norm(), 1e-3);
    EXPECT_LT((found.lower_right_m - truth.lower_right_m).norm(), 1e-3);
    EXPECT_LT((found.upper_left_m - truth.upper_left_m).norm(), 1e-3);
    EXPECT_NEAR(calibration.measured_size_m().x(), lab.width_m, 2e-3);
    EXPECT_NEAR(calibration.measured_size_m().y(), lab.height_m, 2e-3);

    calibration.next();
    ASSERT_EQ(calibration.step(), CalibrationStep::workspace);
    for (const bool by_wand : {false, true}) {
        calibration.set_workspace_by_wand(by_wand);
        for (std::size_t i = 0; i < kMarks; ++i) {
            static const std::array<Vec3, kMarks> kPlaces{Vec3(0.0, 0.0, 0.0), Vec3(0.1, 0.0, 0.0),
                                                          Vec3(0.0, 0.1, 0.0), Vec3(0.1, 0.1, 0.03),
                                                          Vec3(0.0, 0.0, 0.1), Vec3(0.1, 0.0, 0.1)};
            const Vec3 at_screen_m =
                by_wand ? Vec3(lab.T_screen_world * kPlaces.at(i)) : lab.mark_screen_m(i);
            person.touch(at_screen_m, lab.T_screen_world.inverse() * at_screen_m);
        }
        EXPECT_EQ(calibration.marks().taken(), kMarks);
        EXPECT_EQ(calibration.status().grade, FitGrade::green) << calibration.status().text;
        EXPECT_LT((calibration.draft().T_screen_world.p_m - lab.T_screen_world.p_m).norm(), 1.5e-3);
        EXPECT_LT(apart_rad(calibration.draft().T_screen_world.q, lab.T_screen_world.q), 0.01);
        EXPECT_TRUE(calibration.draft().in_workspace);
    }
}

TEST(Calibration, a_wrong_mark_is_named_and_measured_again) {
    const Lab lab;
    for (const std::size_t missed : {std::size_t{0}, std::size_t{3}, std::size_t{4}}) {
        Calibration calibration(start_of(lab));
        Person person(lab, calibration);
        calibration.set_picture_size(lab.width_m, lab.height_m);
        calibration.go(CalibrationStep::screen);
        const ScreenPlace before = calibration.draft().screen;
        for (std::size_t i = 0; i < kMarks; ++i)
            person.touch(lab.mark_screen_m(i) + (i == missed ? Vec3(0.02, -0.02, 0.03) : Vec3(Vec3::Zero())));
        EXPECT_EQ(calibration.marks().outlier(), missed) << calibration.status().text;
        EXPECT_NE(calibration.status().grade, FitGrade::green);
        EXPECT_NE(calibration.status().text.find("Point " + std::to_string(missed + 1)), std::string::npos)
            << calibration.status().text;
        if (missed < kMarksMin && calibration.status().grade == FitGrade::red) {
            EXPECT_EQ(before.lower_left_m, calibration.draft().screen.lower_left_m);
        }
        EXPECT_EQ(calibration.glass_text(), "POINT " + std::to_string(missed + 1) + " DOES NOT FIT");
        EXPECT_NE(calibration.instruction().find("All points are measured"), std::string::npos);
        calibration.redo(missed);
        EXPECT_EQ(calibration.marks().current, missed);
        EXPECT_EQ(calibration.glass_text(), "WAND: TOUCH MARK " + std::to_string(missed + 1));
        person.touch(lab.mark_screen_m(missed));
        EXPECT_EQ(calibration.status().grade, FitGrade::green) << calibration.status().text;
        EXPECT_FALSE(calibration.marks().outlier());
        EXPECT_EQ(calibration.glass_text(), "ALL POINTS DONE");
    }
}

TEST(Calibration, accurate_marks_have_no_outlier) {
    const Lab lab;
    int named = 0;
    SeededRandom random(21);
    for (int round = 0; round < 300; ++round) {
        std::vector<PointPair> pairs;
        for (std::size_t i = 0; i < kMarks; ++i)
            pairs.push_back(
                {Vec3((kMarkPlaces[i][0] - 0.5) * lab.width_m, (kMarkPlaces[i][1] - 0.5) * lab.height_m, 0.0),
                 lab.mark_screen_m(i) + noise(random, 0.7e-3)});
        named += register_points(pairs).outlier ? 1 : 0;
    }
    EXPECT_LE(named, 15);
}

TEST(Calibration, degenerate_points_are_refused_and_change_nothing) {
    const Lab lab;
    Calibration calibration(start_of(lab));
    Person person(lab, calibration);
    const Pose before = calibration.draft().T_screen_world;
    calibration.go(CalibrationStep::workspace);
    calibration.set_workspace_by_wand(true);
    for (int i = 0; i < 4; ++i) person.touch(Vec3(0.1, 0.0, 0.0), Vec3(0.0, 0.1, 0.0));
    EXPECT_EQ(calibration.status().grade, FitGrade::red);
    EXPECT_NE(calibration.status().text.find("of each other"), std::string::npos)
        << calibration.status().text;
    calibration.clear();
    for (int i = 0; i < 4; ++i) person.touch(Vec3(0.1 * i, 0.0, 0.0), Vec3(0.0, 0.1 * i, 0.0));
    EXPECT_EQ(calibration.status().grade, FitGrade::red);
    EXPECT_NE(calibration.status().text.find("on a line"), std::string::npos);
    EXPECT_EQ(before.p_m, calibration.draft().T_screen_world.p_m);
    EXPECT_FALSE(calibration.draft().in_workspace);
}

TEST(Calibration, a_wrong_size_is_reported_and_can_be_replaced_by_the_measured_one) {
    const Lab lab;
    Calibration calibration(start_of(lab));
    Person person(lab, calibration);
    person.noise_m = 0.3e-3;
    calibration.set_picture_size(1.02 * lab.width_m, 0.98 * lab.height_m);
    calibration.go(CalibrationStep::screen);
    for (std::size_t i = 0; i < kMarks; ++i) person.touch(lab.mark_screen_m(i));
    EXPECT_NE(calibration.status().grade, FitGrade::green);
    EXPECT_NE(calibration.status().text.find("off the typed size"), std::string::npos)
        << calibration.status().text;
    calibration.use_measured_size();
    EXPECT_EQ(calibration.status().grade, FitGrade::green) << calibration.status().text;
    EXPECT_NEAR(calibration.draft().screen.width_m(), lab.width_m, 1e-3);
    EXPECT_NEAR(calibration.draft().screen.height_m(), lab.height_m, 1e-3);
}

TEST(Calibration, a_moving_hand_or_lost_tracker_ends_in_a_message_after_a_time) {
    const Lab lab;
    Calibration calibration(start_of(lab));
    Person person(lab, calibration);
    calibration.set_picture_size(lab.width_m, lab.height_m);
    calibration.go(CalibrationStep::screen);
    person.seen = false;
    for (int i = 0; i < 60; ++i) person.frame(Vec3::Zero(), Vec3::Zero());
    calibration.take();
    EXPECT_FALSE(calibration.measuring());
    EXPECT_NE(calibration.message().find("No data from the tracker"), std::string::npos);
    person.seen = true;
    person.frame(Vec3::Zero(), Vec3::Zero());
    calibration.take();
    for (int i = 0; i < 200; ++i) person.frame(Vec3(0.01 * i, 0.0, 0.0), Vec3::Zero());
    EXPECT_TRUE(calibration.measuring());
    EXPECT_EQ(calibration.marks().taken(), 0U);
    person.seen = false;
    for (int i = 0; i < 50; ++i) person.frame(Vec3::Zero(), Vec3::Zero());
    EXPECT_NE(calibration.live().find("lost"), std::string::npos);
    for (int i = 0; i < 1000; ++i) person.frame(Vec3::Zero(), Vec3::Zero());
    EXPECT_FALSE(calibration.measuring());
    EXPECT_NE(calibration.message().find("Not measured"), std::string::npos);
    // A non-finite pose counts as no pose.
    CalibrationInput in;
    in.now_s = 1e3;
    in.sensor_good = in.hand_good = true;
    in.T_screen_sensor.p_m.x() = NAN;
    in.stylus_world_m.z() = INFINITY;
    calibration.follow(in);
    EXPECT_FALSE(calibration.wand_tip_screen_m());
    EXPECT_FALSE(calibration.stylus_screen_m());
}

TEST(Calibration, stylus_and_wand_must_rest_together) {
    const Lab lab;
    Calibration calibration(start_of(lab));
    Person person(lab, calibration);
    calibration.go(CalibrationStep::workspace);
    calibration.set_workspace_by_wand(true);
    person.frame(Vec3::Zero(), Vec3::Zero());
    calibration.take();
    for (int i = 0; i < 100; ++i) person.frame(Vec3::Zero(), Vec3(0.01 * i, 0.0, 0.0));
    EXPECT_EQ(calibration.marks().taken(), 0U);  // only the wand rested
    for (int i = 0; i < 60; ++i) person.frame(Vec3::Zero(), Vec3(1.0, 0.0, 0.0));
    EXPECT_EQ(calibration.marks().taken(), 1U);
}

TEST(Calibration, the_screen_requests_nothing_before_it_is_possible) {
    const Lab lab;
    Calibration calibration(start_of(lab));
    Person person(lab, calibration);
    person.frame(Vec3::Zero(), Vec3::Zero());
    using Lacking = Calibration::Lacking;
    for (const CalibrationStep step : {CalibrationStep::screen, CalibrationStep::workspace}) {
        calibration.go(step);
        EXPECT_EQ(calibration.lacking(), Lacking::size);
        EXPECT_EQ(calibration.glass_text(), "FIRST TYPE THE DISPLAY SIZE");
        EXPECT_NE(calibration.instruction().find("size is missing"), std::string::npos);
        calibration.take();
        EXPECT_FALSE(calibration.measuring());
        EXPECT_NE(calibration.message().find("size is missing"), std::string::npos) << calibration.message();
    }
    calibration.set_workspace_by_wand(true);  // needs no display
    EXPECT_EQ(calibration.lacking(), Lacking::nothing);
    EXPECT_EQ(calibration.glass_text(), "STYLUS TO WAND: POINT 1");
    EXPECT_EQ(calibration.instruction().find("size is missing"), std::string::npos);
    calibration.set_workspace_by_wand(false);
    calibration.set_picture_size(lab.width_m, lab.height_m);
    EXPECT_EQ(calibration.glass_text(), "STYLUS: TOUCH MARK 1");
    calibration.go(CalibrationStep::screen);
    EXPECT_EQ(calibration.glass_text(), "WAND: TOUCH MARK 1");
    calibration.take();
    EXPECT_EQ(calibration.glass_text(), "HOLD STILL: POINT 1");
    calibration.take();
    person.seen = person.arm = false;
    for (int i = 0; i < 60; ++i) person.frame(Vec3::Zero(), Vec3::Zero());
    EXPECT_EQ(calibration.glass_text(), "NO SENSOR TRACKED");
    calibration.go(CalibrationStep::workspace);
    EXPECT_EQ(calibration.glass_text(), "NO DATA FROM THE STYLUS");
}

TEST(Calibration, the_stylus_button_measures_once_per_press) {
    const Lab lab;
    Calibration calibration(start_of(lab));
    Person person(lab, calibration);
    calibration.set_picture_size(lab.width_m, lab.height_m);
    calibration.go(CalibrationStep::screen);
    person.frame(lab.mark_screen_m(0), Vec3::Zero());
    person.button = true;
    for (int i = 0; i < 150; ++i) person.frame(lab.mark_screen_m(0), Vec3::Zero());
    EXPECT_EQ(calibration.marks().taken(), 1U);
    EXPECT_EQ(calibration.marks().current, 1U);
    EXPECT_FALSE(calibration.measuring());
}

TEST(Calibration, the_tip_of_the_wand_is_found_by_rotating_about_it) {
    const Lab lab;
    Calibration calibration{StageSettings{}};
    Person person(lab, calibration);
    calibration.go(CalibrationStep::wand);
    for (const bool well : {false, true}) {
        person.frame(Vec3(0.2, 0.1, 0.3), Vec3::Zero());
        calibration.take();
        for (int i = 0; i < 500 && calibration.measuring(); ++i)
            person.frame(Vec3(0.2, 0.1, 0.3), Vec3::Zero(),
                         quat_from_rotation_vector(
                             0.4 * Vec3(std::sin(0.05 * i), well ? std::cos(0.07 * i) : 0.0, 0.0)));
        EXPECT_FALSE(calibration.measuring());
        if (!well) {  // rotation about one axis leaves the tip undetermined along it
            EXPECT_NE(calibration.message().find("tilted too little"), std::string::npos)
                << calibration.message();
        } else {
            EXPECT_LT((calibration.draft().wand_tip_sensor_m - lab.tip_sensor_m).norm(), 1e-3)
                << calibration.message();
        }
    }
}

TEST(Calibration, typed_values_are_checked) {
    Calibration calibration{StageSettings{}};
    calibration.set_picture_size(NAN, 0.3);
    EXPECT_FALSE(calibration.draft().screen_measured);
    EXPECT_NE(calibration.message(), "");
    calibration.set_screen({Vec3(0, 0, 0), Vec3(0.5, 0, 0), Vec3(0.3, 0.3, 0)});
    EXPECT_NE(calibration.message().find("not form a rectangle"), std::string::npos);
    calibration.set_screen({Vec3(0, 0, 0), Vec3(0.5, INFINITY, 0), Vec3(0, 0.3, 0)});
    EXPECT_FALSE(calibration.draft().screen_measured);
    calibration.set_screen({Vec3(0, 0, 0), Vec3(0.5, 0, 0), Vec3(0, 0.3, 0)});
    EXPECT_TRUE(calibration.draft().screen_measured);
    calibration.set_eyes({.apart_m = 0.5});
    calibration.set_eyes({.apart_m = 0.06, .middle_head_m = Vec3(0, NAN, 0)});
    EXPECT_EQ(calibration.draft().eyes.apart_m, EyesOfHead{}.apart_m);
    calibration.set_eyes({.apart_m = 0.06, .swapped = true});
    EXPECT_TRUE(calibration.draft().eyes.swapped);
    calibration.set_wand_tip(Vec3(0, 0, 3));
    EXPECT_EQ(calibration.draft().wand_tip_sensor_m, Vec3(0, 0, 0));
}

}  // namespace
}  // namespace tact::gui_calibration_test
