// Stories of the governor in the whole loop: what the visual process says comes in by mail, levels go out.
#include <gtest/gtest.h>

#include "tests/scenario/lockstep.hpp"

namespace tact {
namespace {

// A visual process whose frames take so long at all of the picture, in proportion below it.
struct Picture {
    Lockstep& loop;
    double frame_s;
    HouseReport report{};

    void frame(bool obeys = true) {
        const LevelsTopic l = loop.levels();
        const double level = static_cast<double>(l.path[Servo::kMeshIndex].level);
        const double work_s = 0.004 + (frame_s - 0.004) * level;
        report.gui_heartbeat_ns = report.gui_taken_at_ns = to_ns(loop.clock_.now());
        report.gui_attached = 1;
        report.gui_generation = 5;
        report.gui_vertices_max = 100000;
        report.gui_vertices = static_cast<std::uint32_t>(100000 * level);
        if (obeys) report.gui_levels_sequence = l.sequence;
        ++report.gui_frame;
        report.gui_work_s = work_s;
        report.gui_cpu_s += work_s;
        loop.mail_.house.publish(report);
        loop.cycles(static_cast<int>(1e3 * work_s) + 1);
    }
    [[nodiscard]] float level() const { return loop.levels().path[Servo::kMeshIndex].level; }
    [[nodiscard]] auto reason() const {
        return static_cast<LevelReason>(loop.levels().path[Servo::kMeshIndex].reason);
    }
};

ServoSettings with_picture_goal(Law law, double hz) {
    ServoSettings s;
    s.governor.law = law;
    s.governor.picture_goal_hz = hz;
    return s;
}

TEST(GovernorScenario, a_map_too_big_for_the_renderer_becomes_usable_while_the_force_stays) {
    for (const Law law : {Law::elastic, Law::sensitus}) {
        Lockstep loop(with_picture_goal(law, 30.0));
        loop.active();
        Picture picture{loop, 0.5};
        int frames = 0;
        for (; frames < 40 && (frames < 2 || picture.level() > 0.07F); ++frames) picture.frame();
        EXPECT_LT(frames, 20);
        EXPECT_EQ(picture.reason(), LevelReason::picture_low);
        for (int i = 0; i < 100; ++i) picture.frame();
        EXPECT_LT(0.004 + 0.496 * static_cast<double>(picture.level()), 1.1 / 30.0);
        EXPECT_GT(picture.level(), 0.02F);
        EXPECT_FLOAT_EQ(loop.levels().path[Servo::kForceIndex].level, 1.0F);
        EXPECT_FLOAT_EQ(loop.levels().picture_goal_hz, 30.0F);
        EXPECT_EQ(loop.health().overruns, 0U);
    }
}

TEST(GovernorScenario, a_frame_that_has_not_obeyed_yet_is_not_answered_again) {
    Lockstep loop(with_picture_goal(Law::elastic, 30.0));
    loop.active();
    Picture picture{loop, 0.5};
    picture.frame();
    while (picture.level() == 1.0F) picture.frame();
    const float once = picture.level();
    picture.frame(false);
    picture.frame(false);
    EXPECT_FLOAT_EQ(picture.level(), once);
    picture.frame();
    picture.frame();
    EXPECT_LT(picture.level(), once);
}

TEST(GovernorScenario, without_a_goal_of_its_own_a_slow_picture_stays_as_it_is) {
    Lockstep loop(with_picture_goal(Law::elastic, 0.0));
    loop.active();
    Picture picture{loop, 0.5};
    for (int i = 0; i < 10; ++i) picture.frame();
    EXPECT_FLOAT_EQ(picture.level(), 1.0F);
}

TEST(GovernorScenario, hostile_words_of_the_picture_leave_the_levels_within_their_bounds) {
    for (const double bad : {-1.0, 1e300, 0.0}) {
        Lockstep loop(with_picture_goal(Law::elastic, 30.0));
        loop.active();
        Picture picture{loop, 0.05};
        for (int i = 0; i < 20; ++i) {
            picture.report.gui_cpu_s = i % 2 == 0 ? bad : 0.0;
            picture.report.gui_frame += i % 3 == 0 ? 1'000'000'000'000ULL : 0;
            picture.frame();
            picture.report.gui_taken_at_ns = i % 2 == 0 ? INT64_MIN : INT64_MAX;
            picture.report.gui_work_s = bad;
            ++picture.report.gui_frame;
            loop.mail_.house.publish(picture.report);
            loop.cycles(100);
            EXPECT_GE(picture.level(), 0.01F);
            EXPECT_LE(picture.level(), 1.0F);
        }
    }
}

}  // namespace
}  // namespace tact
