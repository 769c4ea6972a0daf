// Faults of a running controller and the required reactions: the rows of the design's fault table that need no
// hardware.
#include <gtest/gtest.h>
#include <pwd.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <random>

#include "tests/scenario/rig.hpp"

namespace tact::scenario {
namespace {

constexpr double kForceMaxN = 3.3;  // default of the safety chain

double length(const float (&v)[3]) {
    return std::hypot(static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2]));
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// A second person's window: it marks a place and ends the force; the run's own window stays in charge of all else.
TEST(Instructor, marks_a_place_and_disarms_and_the_runs_window_can_arm_again) {
    const Rig rig;
    Controller rt(rig, {});
    Watch watch(rig);
    ASSERT_TRUE(watch.attach()) << rt.said();
    Visual visual(rig);
    ASSERT_TRUE(bring_to_force(visual, watch)) << rt.said();
    LinkClient instructor(rig.session(), -1, LinkRole::instructor);
    ASSERT_TRUE(until([&] { return instructor.poll().arrived; })) << instructor.status_text();
    ASSERT_TRUE(instructor.order(LinkOrder::mark, {0.01, -0.02, 0.03}));
    MarkTopic mark{};
    ASSERT_TRUE(until([&] {
        visual.frame();
        return watch.region().mark.read(mark) && mark.count == 1;
    }));
    EXPECT_EQ(mark.pos_model_m[1], -0.02);
    EXPECT_EQ(mark.pid, static_cast<std::uint32_t>(getpid()));
    EXPECT_EQ(watch.state(), RunState::active);  // a mark stops nothing
    ASSERT_TRUE(instructor.order(LinkOrder::stop));
    ASSERT_TRUE(until([&] {
        visual.frame();
        return watch.state() == RunState::ready;
    }));
    ASSERT_TRUE(until([&] { return watch.force_n() == 0.0; }));  // the ramp out takes 50 ms
    EXPECT_EQ(command(visual, watch, CommandKind::arm), CommandResult::done) << rt.said();
}

// Each of these signals stops the loop in the same way.
class StopSignal : public ::testing::TestWithParam<int> {};

TEST_P(StopSignal, the_force_falls_to_zero_within_a_hundred_cycles_and_the_exit_code_is_0) {
    const Rig rig;
    Controller rt(rig, {});
    Watch watch(rig);
    ASSERT_TRUE(watch.attach()) << rt.said();
    Visual visual(rig);
    ASSERT_TRUE(bring_to_force(visual, watch)) << rt.said();
    ASSERT_TRUE(watch.cycles_pass(600));  // the ramp-in takes 500
    RingCursor events = watch.region().events.tail();
    kill(rt.child().pid(), GetParam());
    const auto& ending = rt.child().wait(std::chrono::minutes(1));
    ASSERT_TRUE(ending) << "the controller did not end";
    EXPECT_TRUE(ending->clean()) << ending->text() << "\n" << rt.said();

    // The region outlives the controller, so its last records can be read afterwards.
    std::vector<TraceTopic> cycles;
    TraceTopic t{};
    RingCursor trace;
    while (watch.region().trace.next(trace, t)) cycles.push_back(t);
    const auto active = [](const TraceTopic& c) {
        return (c.status & 0xFFU) == static_cast<unsigned>(RunState::active);
    };
    const auto last_active = std::find_if(cycles.rbegin(), cycles.rend(), active);
    ASSERT_NE(last_active, cycles.rend()) << "the controller was never active";
    const auto left_active = static_cast<std::size_t>(last_active.base() - cycles.begin());
    ASSERT_LT(left_active, cycles.size()) << "the controller never left the state active";
    std::size_t last_force = left_active;
    for (std::size_t i = left_active; i < cycles.size(); ++i)
        if (length(cycles[i].force_world_n) > 0.0) last_force = i;
    EXPECT_LT(last_force + 1, cycles.size()) << "the last cycle still had a force";
    EXPECT_LE(last_force - left_active, 100U);
    // If the machine paused so long that the device dropped the force, there is nothing to ramp.
    bool dropped = false;
    for (EventTopic e{}; watch.region().events.next(events, e);)
        dropped = dropped || e.code == static_cast<std::uint16_t>(EventCode::device_watchdog);
    if (!dropped) {
        EXPECT_GT(length(cycles[left_active].force_world_n), 0.0) << "the force was cut, not ramped";
    }
    EXPECT_EQ(watch.force_n(), 0.0);
    EXPECT_EQ(watch.state(), RunState::off);
    std::printf("signal %d: zero force %zu cycles, %.1f ms after the stop began\n", GetParam(),
                last_force - left_active,
                static_cast<double>(cycles[last_force].taken_at_ns - cycles[left_active].taken_at_ns) * 1e-6);
    EXPECT_FALSE(std::filesystem::exists(rig.socket()));
    EXPECT_TRUE(rig.lock_is_free());
}

INSTANTIATE_TEST_SUITE_P(Signals, StopSignal, ::testing::Values(SIGTERM, SIGINT, SIGHUP));

TEST(SecondController, is_refused_with_session_and_process_and_does_not_disturb_the_first) {
    const Rig rig;
    Controller first(rig, {});
    Watch watch(rig);
    ASSERT_TRUE(watch.attach()) << first.said();
    Visual visual(rig);
    ASSERT_TRUE(bring_to_force(visual, watch)) << first.said();
    const std::uint64_t generation = watch.generation();
    const auto second = run_to_end(
        rig, rt_program(), {rig.scene().string(), "--session", rig.session(), "--priority", "0", "--arm"});
    ASSERT_TRUE(second) << "the second controller did not end";
    EXPECT_FALSE(second->ending.by_signal);
    EXPECT_EQ(second->ending.number, 1);
    EXPECT_TRUE(has(second->text, "process " + std::to_string(first.child().pid()))) << second->text;
    EXPECT_TRUE(has(second->text, "--session")) << second->text;
    visual.frame();
    ASSERT_TRUE(watch.cycles_pass(100));
    EXPECT_EQ(watch.generation(), generation);
    EXPECT_EQ(watch.state(), RunState::active);
    EXPECT_FALSE(first.child().poll());
}

// Random bytes that cannot be a disarm order: the kind's high byte is set.
CommandTopic random_command(std::mt19937& random) {
    CommandTopic c{};
    auto* const bytes = reinterpret_cast<unsigned char*>(&c);
    for (std::size_t i = 0; i < sizeof c; ++i) bytes[i] = static_cast<unsigned char>(random());
    c.kind = static_cast<std::uint16_t>(c.kind | 0x0100U);
    return c;
}

// A nearly valid order to bodies: any id; a value or pose that may be valid or not a number.
CommandTopic random_body_order(std::mt19937& random) {
    constexpr auto kFirst = static_cast<unsigned>(CommandKind::select_body),
                   kLast = static_cast<unsigned>(kLastCommand);
    CommandTopic c{};
    c.sequence = 1000 + random() % 1000;  // not those of the test's own commands
    c.kind = static_cast<std::uint16_t>(kFirst + random() % (kLast - kFirst + 1));
    c.body = static_cast<std::uint32_t>(random() % 4 == 0 ? random() : random() % 20);
    c.value = random() % 5 == 0 ? std::nan("") : static_cast<double>(random() % 2);
    std::uniform_real_distribution<double> near(-60e-10, 60e-10);
    for (double& p : c.pos_model_m) p = random() % 8 == 0 ? HUGE_VAL : near(random);
    c.quat_model_body_xyzw[random() % 4] = random() % 8 == 0 ? 1e200 : 1.0;
    return c;
}

TEST(HostileVisualProcess, a_flood_of_orders_to_bodies_keeps_the_force_within_bounds) {
    const Rig rig;
    Controller rt(rig, {"--copies", "4"});
    Watch watch(rig);
    ASSERT_TRUE(watch.attach()) << rt.said();
    Visual visual(rig);
    ASSERT_TRUE(bring_to_force(visual, watch)) << rt.said();
    std::mt19937 random(20261121);
    for (int burst = 0; burst < 60; ++burst) {
        for (int i = 0; i < 20; ++i) visual.region().commands.push(random_body_order(random));
        visual.frame();
        ASSERT_TRUE(watch.cycles_pass(5));
        EXPECT_EQ(watch.state(), RunState::active);
        EXPECT_LE(watch.force_n(), kForceMaxN + 1e-9);
        const auto bodies = launch::newest(watch.region().bodies);
        ASSERT_TRUE(bodies);
        ASSERT_LE(bodies->count, kBodiesMax);
        EXPECT_GT(bodies->count, 0U);
        EXPECT_TRUE(bodies->active == kNoBody || bodies->active < bodies->count);
        for (std::uint32_t i = 0; i < bodies->count; ++i)
            EXPECT_TRUE(std::isfinite(bodies->body[i].pos_model_m[0]));
    }
    const HealthTopic h = watch.health();
    EXPECT_EQ(h.allocations, 0U);
    EXPECT_EQ(h.locks, 0U);
    EXPECT_EQ(command(visual, watch, CommandKind::disarm), CommandResult::done);
}

TEST(HostileVisualProcess, garbage_is_refused_and_counted_and_the_force_continues) {
    const Rig rig;
    Controller rt(rig, {});
    Watch watch(rig);
    ASSERT_TRUE(watch.attach()) << rt.said();
    Visual visual(rig);
    ASSERT_TRUE(bring_to_force(visual, watch)) << rt.said();
    const std::uint64_t refused = watch.health().bad_input;
    std::mt19937 random(20261120);
    int commands = 0, loads = 0;
    for (int burst = 0; burst < 100; ++burst) {
        for (int i = 0; i < 20; ++i, ++commands) visual.region().commands.push(random_command(random));
        // Valid kinds of orders with impossible content.
        CommandTopic c{};
        c.sequence = 1;  // old numbers: sequence numbers run backwards
        c.kind = static_cast<std::uint16_t>(CommandKind::set_goal_hz);
        for (const double bad : {std::nan(""), -1.0, HUGE_VAL, 0.0, 1e300}) {
            c.value = bad;
            visual.region().commands.push(c);
            ++commands;
        }
        c.kind = static_cast<std::uint16_t>(CommandKind::set_law);
        std::memset(c.text, 'A', sizeof c.text);  // not terminated
        visual.region().commands.push(c);
        ++commands;
        LoadTopic load{};
        auto* const bytes = reinterpret_cast<unsigned char*>(&load);
        for (std::size_t i = 0; i < sizeof load; ++i) bytes[i] = static_cast<unsigned char>(random());
        load.frame_s = burst % 2 == 0 ? std::nan("") : -1.0;
        visual.region().load.publish(load);
        ++loads;
        FramesTopic frames{};
        auto* const words = reinterpret_cast<unsigned char*>(&frames);
        for (std::size_t i = 0; i < sizeof frames; ++i) words[i] = static_cast<unsigned char>(random());
        frames.metrics.late = frames.metrics.frames + 1;
        visual.region().frames.publish(frames);
        ASSERT_TRUE(watch.cycles_pass(5));
        EXPECT_EQ(watch.state(), RunState::active);
        EXPECT_LE(watch.force_n(), kForceMaxN + 1e-9);
    }
    // And random bytes anywhere in the shared memory: counters, sequences, records. The first bytes of the ring stay
    // unchanged, so that no burst of old records is read as new orders.
    auto* const memory = reinterpret_cast<unsigned char*>(&visual.region().load);
    for (int i = 0; i < 200; ++i) {
        for (std::size_t k = 0; k < sizeof visual.region().load; ++k)
            memory[k] = static_cast<unsigned char>(random());
        ASSERT_TRUE(watch.cycles_pass(2));
    }
    ASSERT_TRUE(until([&] { return watch.health().bad_input > refused + 1000; })) << watch.health().bad_input;
    ASSERT_TRUE(watch.cycles_pass(200));
    const HealthTopic h = watch.health();
    EXPECT_EQ(h.state, static_cast<std::uint8_t>(RunState::active));
    EXPECT_EQ(h.allocations, 0U);
    EXPECT_TRUE(std::isfinite(watch.force_n()));
    EXPECT_LE(watch.force_n(), kForceMaxN + 1e-9);
    std::printf("%d impossible commands and %d loads sent, %llu refusals counted\n", commands, loads,
                static_cast<unsigned long long>(h.bad_input - refused));
    // None of its impossible values were passed on; possible ones are.
    DisplayTopic picture{};
    EXPECT_TRUE(!watch.region().picture.read(picture) || plausible(picture.metrics));
    FramesTopic frames{};
    frames.metrics.frames = 4321;
    visual.region().frames.publish(frames);
    EXPECT_TRUE(
        until([&] { return watch.region().picture.read(picture) && picture.metrics.frames == 4321; }));
    // Valid commands are still accepted.
    EXPECT_EQ(command(visual, watch, CommandKind::disarm), CommandResult::done);
    EXPECT_EQ(watch.state(), RunState::ready);
}

TEST(HostileVisualProcess, a_ring_with_a_wild_count_costs_bounded_work_and_no_cycle) {
    const Rig rig;
    Controller rt(rig, {});
    Watch watch(rig);
    ASSERT_TRUE(watch.attach()) << rt.said();
    Visual visual(rig);
    ASSERT_TRUE(bring_to_force(visual, watch)) << rt.said();
    // The count is the first word of the ring.
    auto* const count = reinterpret_cast<std::atomic<std::uint64_t>*>(&visual.region().commands);
    const std::uint64_t refused = watch.health().bad_input;
    for (const std::uint64_t wild : {~0ULL, 1ULL, 1ULL << 63U, 0ULL, 12345678901ULL, 2ULL}) {
        count->store(wild);
        visual.frame();
        ASSERT_TRUE(watch.cycles_pass(50));
        EXPECT_EQ(watch.state(), RunState::active);
    }
    EXPECT_TRUE(until([&] { return watch.health().bad_input > refused; }));
    EXPECT_FALSE(rt.child().poll());
}

TEST(SilentVisualProcess, by_default_the_force_continues_and_the_silence_is_reported) {
    const Rig rig;
    Controller rt(rig, {});
    Watch watch(rig);
    ASSERT_TRUE(watch.attach()) << rt.said();
    Visual visual(rig);
    RingCursor events;
    ASSERT_TRUE(bring_to_force(visual, watch)) << rt.said();
    bool said = false;
    ASSERT_TRUE(until([&] {  // it hangs: no more frames
        EventTopic e{};
        while (watch.region().events.next(events, e))
            said = said || e.code == static_cast<std::uint16_t>(EventCode::gui_silent);
        return said;
    }));
    ASSERT_TRUE(watch.cycles_pass(200));
    EXPECT_EQ(watch.state(), RunState::active);
    EXPECT_TRUE(until([&] { return watch.health().gui_heartbeat_age_ns > 500'000'000; }));
    ASSERT_TRUE(until([&] { return watch.force_n() > 0.01; }));
}

TEST(SilentVisualProcess, if_configured_the_force_ramps_out_until_a_person_arms_again) {
    const Rig rig;
    Controller rt(rig, {}, "[safety]\non_gui_silent = \"ramp\"\n");
    Watch watch(rig);
    ASSERT_TRUE(watch.attach()) << rt.said();
    Visual visual(rig);
    ASSERT_TRUE(bring_to_force(visual, watch)) << rt.said();
    ASSERT_TRUE(until([&] { return watch.state() == RunState::ready; })) << rt.said();
    EXPECT_EQ(watch.health().reason, static_cast<std::uint8_t>(RunReason::gui_silent));
    ASSERT_TRUE(until([&] { return watch.force_n() == 0.0; }));
    for (int i = 0; i < 100; ++i) {  // its return alone changes nothing
        visual.frame();
        ASSERT_TRUE(watch.cycles_pass(5));
        EXPECT_EQ(watch.state(), RunState::ready);
        EXPECT_EQ(watch.force_n(), 0.0);
    }
    EXPECT_TRUE(bring_to_force(visual, watch)) << rt.said();
}

TEST(StartPoses, come_from_the_file_and_a_wrong_file_is_refused_with_a_fix) {
    const Rig rig;
    const std::string body = R"({"structure": 0, "name": "rod", "pos_model_a": [20, 25, 30],
        "quat_model_body_xyzw": [0, 0, 1, 0], "fixed": )";
    const auto good =
        rig.file("good.json", "{\"bodies\": [" + body + "true}, " + body + "false, \"in_hand\": true}]}");
    {
        Controller rt(rig, {"--poses", good.string()});
        Watch watch(rig);
        ASSERT_TRUE(watch.attach()) << rt.said();
        ASSERT_TRUE(watch.cycles_pass(10));
        const auto bodies = launch::newest(watch.region().bodies);
        ASSERT_TRUE(bodies);
        ASSERT_EQ(bodies->count, 2U);
        EXPECT_EQ(bodies->active, 1U);
        EXPECT_EQ(bodies->body[0].flags, kBodyFixed);
        EXPECT_NEAR(bodies->body[0].pos_model_m[1], 25e-10, 1e-15);
        EXPECT_NEAR(std::abs(bodies->body[0].quat_model_body_xyzw[2]), 1.0, 1e-9);
    }
    const auto far = rig.file("far.json", R"({"bodies": [{"structure": 0, "pos_model_a": [1e9, 0, 0],
        "quat_model_body_xyzw": [0, 0, 0, 1]}]})");
    for (const auto& bad :
         {far, rig.file("bad.json", "{\"bodies\": [" + body + "3}]}"), rig.folder() / "none"}) {
        const auto said = run_to_end(
            rig, rt_program(), {rig.scene().string(), "--priority", "0", "--check", "--poses", bad.string()});
        ASSERT_TRUE(said);
        EXPECT_EQ(said->ending.number, 1);
        EXPECT_TRUE(has(said->text, "fix: ")) << said->text;
    }
}

TEST(PermissionDenied, a_runtime_folder_writable_by_others_is_refused_with_a_fix) {
    const Rig rig;
    const auto open_to_all = rig.folder() / "open";
    std::filesystem::create_directory(open_to_all);
    std::filesystem::permissions(open_to_all, std::filesystem::perms::all);
    const auto said =
        run_to_end(rig, rt_program(), {rig.scene().string(), "--priority", "0"}, open_to_all.string());
    ASSERT_TRUE(said);
    EXPECT_EQ(said->ending.number, 1);
    EXPECT_TRUE(has(said->text, open_to_all.string())) << said->text;
    EXPECT_TRUE(has(said->text, "fix: ")) << said->text;
}

// The same programs as an unprivileged user, by setpriv of util-linux.
class WithoutPrivilege : public ::testing::Test {
protected:
    void SetUp() override {
        if (getuid() != 0) return;  // the test itself has no privileges
        const passwd* const nobody = getpwnam("nobody");
        setpriv_ = launch::find_in_path("setpriv");
        if (nobody == nullptr || setpriv_.empty()) GTEST_SKIP() << "root without setpriv or a user nobody";
        ASSERT_EQ(chmod(rig_.folder().c_str(), 0711), 0);
        private_ = rig_.folder() / "private";
        std::filesystem::create_directory(private_);
        std::filesystem::permissions(private_, std::filesystem::perms::owner_all);
        ASSERT_EQ(chown(private_.c_str(), nobody->pw_uid, nobody->pw_gid), 0);
        words_ = {"--reuid=" + std::to_string(nobody->pw_uid), "--regid=" + std::to_string(nobody->pw_gid),
                  "--clear-groups", "--"};
        const auto can = run({rt_program().string(), "--help"});
        if (!can || !can->ending.clean()) GTEST_SKIP() << "the user nobody cannot reach the programs' folder";
    }
    std::optional<Said> run(std::vector<std::string> line) {
        std::filesystem::path program = line.front();
        line.erase(line.begin());
        if (words_.empty()) return run_to_end(rig_, program, line);
        std::vector<std::string> all = words_;
        all.push_back(program.string());
        all.insert(all.end(), line.begin(), line.end());
        return run_to_end(rig_, setpriv_, all, private_.string());
    }
    Rig rig_;
    std::filesystem::path setpriv_, private_;
    std::vector<std::string> words_;
};

TEST_F(WithoutPrivilege, an_unreadable_scene_is_named_with_the_reason) {
    ASSERT_EQ(chmod(rig_.scene().c_str(), 0000), 0);
    const auto said = run({rt_program().string(), rig_.scene().string(), "--priority", "0", "--check"});
    ASSERT_TRUE(said);
    EXPECT_EQ(said->ending.number, 1);
    EXPECT_TRUE(has(said->text, rig_.scene().string())) << said->text;
    EXPECT_TRUE(has(said->text, "ermission")) << said->text;
    EXPECT_TRUE(has(said->text, "fix: ")) << said->text;
}

TEST_F(WithoutPrivilege, refused_real_time_scheduling_is_reported_with_a_fix_and_the_run_continues) {
    const auto said = run({rt_program().string(), rig_.scene().string(), "--seconds", "0.3"});
    ASSERT_TRUE(said);
    EXPECT_TRUE(said->ending.clean()) << said->text;
    if (has(said->text, "FIFO,")) GTEST_SKIP() << "this user may use real-time scheduling";
    EXPECT_TRUE(has(said->text, "rtprio") || has(said->text, "RLIMIT_RTPRIO")) << said->text;
}

TEST_F(WithoutPrivilege, a_runtime_folder_of_another_user_is_refused) {
    if (words_.empty()) GTEST_SKIP() << "needs a second user";
    const auto theirs = rig_.folder() / "theirs";
    std::filesystem::create_directory(theirs);
    ASSERT_EQ(chown(theirs.c_str(), 12345, 12345), 0);
    std::vector<std::string> all = words_;
    for (const auto& w :
         {rt_program().string(), rig_.scene().string(), std::string("--priority"), std::string("0")})
        all.push_back(w);
    const auto said = run_to_end(rig_, setpriv_, all, theirs.string());
    ASSERT_TRUE(said);
    EXPECT_EQ(said->ending.number, 1);
    EXPECT_TRUE(has(said->text, theirs.string())) << said->text;
    EXPECT_TRUE(has(said->text, "fix: ")) << said->text;
}

}  // namespace
}  // namespace tact::scenario
