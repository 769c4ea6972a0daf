// The governor in the whole loop: reports of the visual process come by mailbox, levels go out.
#include <gtest/gtest.h>

#include "tests/scenario/lockstep.hpp"

namespace tact::governor_scenario_test {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

// A visual process with a frame time proportional to the level; frame_s at level 1.
struct Picture {
    Lockstep& loop;
    double frame_s;
    HousekeepingReport report{};

    void frame(bool applies = true) {
        const LevelsTopic l = loop.levels();
        const double level = static_cast<double>(l.path[kDisplayPathIndex].level);
        const double work_s = 0.004 + (frame_s - 0.004) * level;
        report.gui_heartbeat_ns = report.gui_taken_at_ns = to_ns(loop.clock_.now());
        report.gui_attached = 1;
        report.gui_generation = 5;
        report.gui_vertices_max = 100000;
        report.gui_vertices = static_cast<std::uint32_t>(100000 * level);
        if (applies) report.gui_levels_sequence = l.sequence;
        ++report.gui_frame;
        report.gui_work_s = work_s;
        report.gui_cpu_s += work_s;
        loop.mailbox_.housekeeping.publish(report);
        loop.cycles(static_cast<int>(1e3 * work_s) + 1);
    }
    [[nodiscard]] float level() const { return loop.levels().path[kDisplayPathIndex].level; }
    [[nodiscard]] auto reason() const {
        return static_cast<LevelReason>(loop.levels().path[kDisplayPathIndex].reason);
    }
};

ServoSettings with_display_goal(Law law, double hz) {
    ServoSettings s;
    s.governor.law = law;
    s.governor.display_goal_hz = hz;
    return s;
}

TEST(GovernorScenario, a_map_too_big_for_the_renderer_becomes_usable_with_the_same_force_level) {
    for (const Law law : {Law::elastic, Law::sensitus}) {
        Lockstep loop(with_display_goal(law, 30.0));
        loop.active();
        Picture picture{loop, 0.5};
        int frames = 0;
        for (; frames < 40 && (frames < 2 || picture.level() > 0.07F); ++frames) picture.frame();
        EXPECT_LT(frames, 20);
        EXPECT_EQ(picture.reason(), LevelReason::display_low);
        for (int i = 0; i < 100; ++i) picture.frame();
        EXPECT_LT(0.004 + 0.496 * static_cast<double>(picture.level()), 1.1 / 30.0);
        EXPECT_GT(picture.level(), 0.02F);
        EXPECT_FLOAT_EQ(loop.levels().path[kForcePathIndex].level, 1.0F);
        EXPECT_FLOAT_EQ(loop.levels().display_goal_hz, 30.0F);
        EXPECT_EQ(loop.health().overruns, 0U);
    }
}

TEST(GovernorScenario, a_frame_that_has_not_applied_the_level_causes_no_further_change) {
    Lockstep loop(with_display_goal(Law::elastic, 30.0));
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

TEST(GovernorScenario, without_a_display_goal_a_slow_display_keeps_its_level) {
    Lockstep loop(with_display_goal(Law::elastic, 0.0));
    loop.active();
    Picture picture{loop, 0.5};
    for (int i = 0; i < 10; ++i) picture.frame();
    EXPECT_FLOAT_EQ(picture.level(), 1.0F);
}

// --- bone: the display's particles ---

PathLevel particles_of(const Lockstep& loop) { return loop.levels().path[kParticlesPathIndex]; }

TEST(GovernorScenario, particles_are_reduced_with_the_display_of_bone_and_absent_elsewhere) {
    ServoSettings settings = with_display_goal(Law::elastic, 30.0);
    EXPECT_EQ(Lockstep(settings).levels().count, 2U);
    settings.visual_paths = kBonePaths;
    Lockstep loop(settings);
    loop.model_.clock = &loop.clock_;
    loop.model_.cost = microseconds(100);
    ASSERT_EQ(loop.levels().count, 3U);
    EXPECT_STREQ(particles_of(loop).path, kParticlesPath);
    EXPECT_STREQ(loop.levels().path[kDisplayPathIndex].path, kVolumePath);
    EXPECT_EQ(particles_of(loop).haptic, 0);
    loop.active();
    Picture picture{loop, 0.2};
    picture.report.gui_particles_max = 80000;
    picture.report.gui_particles_s = 0.05;
    picture.report.gui_volume_s = 0.1;
    for (int i = 0; i < 60; ++i) picture.frame();
    const PathLevel p = particles_of(loop);
    EXPECT_LT(p.level, 0.5F);
    EXPECT_GE(p.level, p.floor);
    EXPECT_EQ(p.items_max, 80000U);
    EXPECT_NEAR(p.items, 80000.0 * static_cast<double>(p.level), 1.0);
    EXPECT_EQ(p.cost_s, 0.05);
    EXPECT_FLOAT_EQ(loop.levels().path[kForcePathIndex].level, 1.0F);
    picture.frame_s = 0.006;  // the machine is free again
    for (int i = 0; i < 2000; ++i) picture.frame();
    EXPECT_GT(particles_of(loop).level, p.level + 0.2F);
}

TEST(GovernorScenario, a_low_force_rate_reduces_particles_to_their_floor_before_the_force) {
    ServoSettings settings;
    settings.free_running = true;
    settings.visual_paths = kBonePaths;
    settings.governor = {.law = Law::sensitus, .goal_hz = 1000.0};
    settings.watchdogs.timing_latches = false;
    Lockstep loop(settings);
    loop.model_.clock = &loop.clock_;
    loop.model_.cost = microseconds(300);
    loop.active();
    Picture picture{loop, 0.004};
    for (int i = 0; i < 3; ++i) picture.frame();
    ASSERT_EQ(particles_of(loop).level, 1.0F);
    const float force_before = loop.levels().path[kForcePathIndex].level;
    bool force_fell = false;
    for (int i = 0; i < 400 && !force_fell; ++i) {
        picture.frame();
        for (int turn = 0; turn < 10; ++turn) {  // another program uses the processor most of the time
            loop.cycles(1);
            loop.clock_.advance(milliseconds(3));
        }
        const LevelsTopic l = loop.levels();
        force_fell = l.path[kForcePathIndex].level < force_before;
        if (!force_fell) continue;
        EXPECT_EQ(l.path[kParticlesPathIndex].level, l.path[kParticlesPathIndex].floor);
        EXPECT_EQ(l.path[kDisplayPathIndex].level, l.path[kDisplayPathIndex].floor);
    }
    EXPECT_TRUE(force_fell);
}

// --- several visual paths ---

TEST(GovernorScenario, the_reported_cost_of_each_path_decides_which_one_is_lowered) {
    for (const bool of_mesh : {true, false}) {
        ServoSettings settings = with_display_goal(Law::elastic, 30.0);
        settings.visual_paths = kDockingPaths;
        Lockstep loop(settings);
        loop.active();
        Picture picture{loop, 0.06};
        (of_mesh ? picture.report.gui_mesh_s : picture.report.gui_molecules_s) = 0.05;
        (of_mesh ? picture.report.gui_molecules_s : picture.report.gui_mesh_s) = 0.0005;
        picture.report.gui_resolution_s = 0.0005;
        picture.report.gui_pixels_max = 2000000;
        for (int i = 0; i < 6; ++i) picture.frame();
        const LevelsTopic l = loop.levels();
        ASSERT_EQ(l.count, 4U);
        EXPECT_STREQ(l.path[2].path, kMoleculesPath);
        EXPECT_STREQ(l.path[3].path, kResolutionPath);
        EXPECT_EQ(l.path[kDisplayPathIndex].level < 1.0F, of_mesh);
        EXPECT_EQ(l.path[2].level < 1.0F, !of_mesh);
        EXPECT_EQ(l.path[3].level, 1.0F);
        EXPECT_EQ(l.path[3].items_max, 2000000U);
        EXPECT_EQ(l.path[of_mesh ? kDisplayPathIndex : 2].cost_s, 0.05);
    }
}

TEST(GovernorScenario, frames_of_a_view_at_rest_move_no_level) {
    Lockstep loop(with_display_goal(Law::elastic, 30.0));
    loop.active();
    Picture picture{loop, 0.1};
    for (int i = 0; i < 60; ++i) picture.frame();
    const float level = picture.level();
    ASSERT_LT(level, 0.6F);
    picture.report.gui_refined = 1;
    picture.frame_s = 0.3;  // in full detail
    picture.frame();
    picture.frame_s = 0.004;  // copied
    for (int i = 0; i < 1000; ++i) picture.frame();
    EXPECT_FLOAT_EQ(picture.level(), level);
    picture.report.gui_refined = 0;
    picture.frame_s = 0.1;
    for (int i = 0; i < 20; ++i) picture.frame();
    EXPECT_NEAR(picture.level(), level, 0.1F);
}

// --- a slow update that takes too long ---

TEST(GovernorScenario, a_late_slow_update_lowers_the_display_and_then_its_own_work) {
    Lockstep loop(with_display_goal(Law::elastic, 30.0));
    loop.model_.clock = &loop.clock_;
    loop.model_.cost = microseconds(100);
    loop.active();
    Picture picture{loop, 0.004};
    for (int i = 0; i < 20; ++i) picture.frame();
    ASSERT_EQ(picture.level(), 1.0F);
    ASSERT_EQ(loop.levels().path[kForcePathIndex].level, 1.0F);
    loop.model_.turn_s = 0.008;  // of a period of four milliseconds
    const auto force = [&] { return static_cast<double>(loop.levels().path[kForcePathIndex].level); };
    bool force_fell = false;
    for (int i = 0; i < 2000; ++i) {
        picture.frame();
        if (force() >= 1.0 || force_fell) continue;
        force_fell = true;
        EXPECT_EQ(picture.level(), loop.levels().path[kDisplayPathIndex].floor);
    }
    // Slow updates use nine tenths of their period, and the servo itself missed nothing.
    EXPECT_TRUE(force_fell);
    EXPECT_LT(loop.model_.slow_update_s(), 0.0041);
    EXPECT_GT(loop.model_.slow_update_s(), 0.003);
    EXPECT_EQ(loop.health().overruns, 0U);
    loop.model_.turn_s = 0.001;
    for (int i = 0; i < 4000; ++i) picture.frame();
    EXPECT_GT(force(), 0.99);
}

// --- free running: the rate within a tenth of a second ---

struct FreeLoop : Lockstep {
    explicit FreeLoop(Law law) : Lockstep(settings(law)) {
        model_.clock = &clock_;
        model_.keeps_sums = true;
    }
    static ServoSettings settings(Law law) {
        ServoSettings s;
        s.free_running = true;
        s.governor.law = law;
        s.watchdogs.timing_latches = false;
        return s;
    }
    // Fewest and most updates in any tenth of a second during the given time.
    std::pair<std::size_t, std::size_t> windows(double seconds) {
        std::vector<Instant> begun;
        const Instant end =
            clock_.now() + std::chrono::microseconds(static_cast<std::int64_t>(1e6 * seconds));
        while (clock_.now() < end) {
            cycles(1);
            begun.push_back(clock_.now());
        }
        std::pair<std::size_t, std::size_t> w{100000, 0};
        std::size_t from = 0;
        for (std::size_t to = 0; to < begun.size(); ++to) {
            if (begun[to] - begun[0] < milliseconds(100)) continue;
            while (begun[to] - begun[from] > milliseconds(100)) ++from;
            w = {std::min(w.first, to - from + 1), std::max(w.second, to - from + 1)};
        }
        return w;
    }
};

TEST(GovernorScenario, free_running_steps_reduce_their_work_before_the_law_can_react) {
    FreeLoop loop(Law::elastic);
    loop.model_.cost = std::chrono::microseconds(500);
    static_cast<void>(loop.windows(1.0));
    EXPECT_FLOAT_EQ(loop.health().recomputed_fraction_least, 1.0F);
    loop.model_.cost = std::chrono::microseconds(1500);
    EXPECT_GE(loop.windows(0.25).first, 96U);
    EXPECT_GE(loop.windows(5.0).first, 96U);
    EXPECT_GT(loop.health().recomputed_fraction_mean, 0.95F);  // by then the level has adapted
    // Steps of 0.7 ms at most; a rise keeps a tenth of that free.
    EXPECT_LT(static_cast<double>(loop.levels().path[kForcePathIndex].level), 0.7 / 1.5);
    EXPECT_GT(static_cast<double>(loop.levels().path[kForcePathIndex].level), 0.7 * 0.63 / 1.5);
}

TEST(GovernorScenario, free_running_a_fixed_level_is_computed_completely_at_any_rate) {
    FreeLoop loop(Law::fixed);
    loop.model_.cost = std::chrono::microseconds(1500);
    EXPECT_LE(loop.windows(1.0).second, 68U);
    EXPECT_FLOAT_EQ(loop.health().recomputed_fraction_least, 1.0F);
    loop.model_.cost = std::chrono::microseconds(100);
    EXPECT_GE(loop.windows(1.0).first, 900U);
    EXPECT_FLOAT_EQ(loop.health().rested, 0.0F);
}

TEST(GovernorScenario, free_running_a_loop_ahead_of_its_goal_rests_if_the_display_could_be_finer) {
    FreeLoop loop(Law::elastic);
    Picture picture{loop, 0.02};
    loop.model_.cost = microseconds(400);
    while (picture.level() > 0.5F) {
        picture.frame();
        for (int turn = 0; turn < 20; ++turn) {  // another program uses the processor most of the time
            loop.cycles(1);
            loop.clock_.advance(milliseconds(2));
        }
    }
    picture.frame();
    EXPECT_LT(picture.level(), 1.0F);
    const auto [least, most] = loop.windows(0.3);
    EXPECT_GE(least, 96U);
    EXPECT_LE(most,
              125U);  // what was lacking before the core became fast, up to half a window, is made up for
    EXPECT_LE(loop.windows(0.2).second, 103U);
    EXPECT_GT(loop.health().rested, 0.3F);
    for (int i = 0; i < 400 && picture.level() < 1.0F; ++i) picture.frame();
    EXPECT_FLOAT_EQ(picture.level(), 1.0F);  // the law detected the spare time
    EXPECT_GE(loop.windows(0.3).first, 200U);
}

TEST(GovernorScenario, hostile_reports_of_the_display_keep_the_levels_within_bounds) {
    for (const double bad : {-1.0, 1e300, 0.0}) {
        Lockstep loop(with_display_goal(Law::elastic, 30.0));
        loop.active();
        Picture picture{loop, 0.05};
        for (int i = 0; i < 20; ++i) {
            picture.report.gui_cpu_s = i % 2 == 0 ? bad : 0.0;
            picture.report.gui_frame += i % 3 == 0 ? 1'000'000'000'000ULL : 0;
            picture.frame();
            picture.report.gui_taken_at_ns = i % 2 == 0 ? INT64_MIN : INT64_MAX;
            picture.report.gui_work_s = bad;
            ++picture.report.gui_frame;
            loop.mailbox_.housekeeping.publish(picture.report);
            loop.cycles(100);
            EXPECT_GE(picture.level(), 0.01F);
            EXPECT_LE(picture.level(), 1.0F);
        }
    }
}

// A step costs up to 500 us, proportional to the level; no display. Goal 4 kHz: steps of 175 us at most.
TEST(GovernorScenario, free_running_the_governor_finds_the_level_that_gives_the_goal) {
    ServoSettings s;
    s.free_running = true;
    s.governor.goal_hz = 4000.0;
    s.watchdogs.timing_latches = false;
    Lockstep loop(s);
    loop.model_.clock = &loop.clock_;
    loop.model_.cost = microseconds(500);
    loop.cycles(30000);
    EXPECT_GE(loop.health().force_rate_hz, 4000.0);
    EXPECT_LE(static_cast<double>(loop.levels().path[kForcePathIndex].level), 0.35);
    EXPECT_GE(static_cast<double>(loop.levels().path[kForcePathIndex].level), 0.23);
    EXPECT_EQ(loop.health().period_ns, 0);
    LatenessTopic lateness{};
    ASSERT_TRUE(loop.region_->lateness.read(lateness));
    EXPECT_EQ(lateness.total, 0U);  // without a plan no cycle is late
}

TEST(GovernorScenario,
     at_a_fixed_rate_the_level_falls_when_steps_cost_too_much_and_returns_when_there_is_time) {
    ServoSettings s;
    s.watchdogs.timing_latches = false;
    Lockstep loop(s);
    loop.model_.clock = &loop.clock_;
    loop.model_.cost = microseconds(1600);
    loop.cycles(20000);
    const float low = loop.levels().path[kForcePathIndex].level;
    EXPECT_LT(low, 0.7F / 1.6F);
    EXPECT_GT(low, 0.31F);  // the row that uses 88 % of the limit
    const std::uint64_t misses = loop.health().deadline_misses;
    loop.cycles(10000);
    EXPECT_EQ(loop.health().deadline_misses, misses);
    loop.model_.cost = microseconds(100);
    loop.cycles(10000);
    EXPECT_FLOAT_EQ(loop.levels().path[kForcePathIndex].level, 1.0F);
    EXPECT_EQ(loop.said(EventCode::level_changed), 2);
    // Each change reports its reason.
    bool fell = false, rose = false;
    RingCursor cursor;
    for (EventTopic e{}; loop.region_->events.next(cursor, e);) {
        if (e.code != static_cast<std::uint16_t>(EventCode::level_changed)) continue;
        const auto why = static_cast<LevelReason>(e.detail);
        fell = fell || why == LevelReason::cost_high || why == LevelReason::deadline_missed;
        rose = rose || why == LevelReason::cost_low;
    }
    EXPECT_TRUE(fell);
    EXPECT_TRUE(rose);
}

TEST(GovernorScenario, the_law_never_lowers_the_force_below_the_least_level_of_the_configuration) {
    for (const double least : {0.5, 1.0}) {
        ServoSettings s;
        s.governor.force_level_min = least;
        s.watchdogs.timing_latches = false;
        Lockstep loop(s);
        loop.model_.clock = &loop.clock_;
        loop.model_.cost = loop.model_.predicted = microseconds(1600);
        loop.cycles(5000);
        EXPECT_NEAR(static_cast<double>(loop.levels().path[kForcePathIndex].level), least, 0.03);
    }
}

// A tool touches: what the model predicts counts before a step has missed its deadline.
TEST(GovernorScenario,
     a_contact_that_is_predicted_to_cost_more_lowers_the_level_before_a_deadline_is_missed) {
    Lockstep loop(ServoSettings{});
    loop.model_.clock = &loop.clock_;
    loop.model_.cost = microseconds(100);
    loop.model_.predicted = microseconds(100);
    loop.cycles(3000);
    EXPECT_FLOAT_EQ(loop.levels().path[kForcePathIndex].level, 1.0F);
    loop.model_.predicted = microseconds(2000);
    loop.cycles(1);
    loop.model_.cost = microseconds(2000);
    loop.cycles(200);
    EXPECT_LE(loop.levels().path[kForcePathIndex].level, 0.3F);
    EXPECT_EQ(loop.health().deadline_misses, 0U);
    EXPECT_EQ(loop.health().overruns, 0U);
}

TEST(GovernorScenario, with_a_gui_the_display_is_reduced_and_the_force_keeps_its_level) {
    ServoSettings s;
    s.free_running = true;
    s.governor.goal_hz = 1000.0;
    s.watchdogs.timing_latches = false;
    Lockstep loop(s);
    loop.model_.clock = &loop.clock_;
    loop.model_.cost = microseconds(300);
    for (int i = 0; i < 20; ++i) {
        loop.mailbox_.housekeeping.publish(gui_at(loop.clock_.now()));
        for (int turn = 0; turn < 100; ++turn) {  // other programs use the processor most of the time
            loop.cycles(1);
            loop.clock_.advance(milliseconds(2));
        }
        if (loop.levels().path[kDisplayPathIndex].level > 0.011F) {
            EXPECT_FLOAT_EQ(loop.levels().path[kForcePathIndex].level, 1.0F);
        }
    }
    EXPECT_LT(loop.levels().path[kDisplayPathIndex].level, 0.5F);
    EXPECT_EQ(loop.levels().path[kDisplayPathIndex].items_max, 10000U);
}

}  // namespace
}  // namespace tact::governor_scenario_test
