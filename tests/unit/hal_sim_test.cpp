// The emulated Phantom and hand: the contract, and the physics against closed forms.
#include <gtest/gtest.h>
#include <pthread.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <thread>
#include <vector>

#include "hal/registry.hpp"
#include "hal/sim/sim_device.hpp"
#include "ipc/base/error.hpp"
#include "tests/contract/haptic_device_contract.hpp"

namespace tact {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

INSTANTIATE_TEST_SUITE_P(Sim, HapticDeviceContract,
                         testing::Values(DeviceCase{"sim", [] { return device_driver("sim").make({}); },
                                                    [](Instant now, Duration d) { return now + d; }}),
                         [](const auto& tested) { return tested.param.name; });

// On the real clock, so the watchdog time is long enough for a busy machine.
std::unique_ptr<HapticDevice> make_process() {
    DeviceSettings settings;
    settings.sim.watchdog = milliseconds(300);
    return device_driver("sim-process").make(settings);
}

INSTANTIATE_TEST_SUITE_P(SimProcess, HapticDeviceContract,
                         testing::Values(DeviceCase{"sim_process", &make_process,
                                                    [](Instant, Duration d) {
                                                        std::this_thread::sleep_for(d);
                                                        return Monotonic::now();
                                                    },
                                                    milliseconds(800), milliseconds(3)}),
                         [](const auto& tested) { return tested.param.name; });

bool die_after_fork = false;

TEST(ProcessDevice, a_process_that_dies_at_once_is_reported_without_waiting) {
    ASSERT_EQ(pthread_atfork(nullptr, nullptr,
                             [] {
                                 if (die_after_fork) _exit(7);
                             }),
              0);
    const auto device = make_process();
    die_after_fork = true;
    try {
        (void)device->open();
        ADD_FAILURE() << "open() accepted a dead device";
    } catch (const StartupError& e) {
        EXPECT_NE(std::string(e.what()).find("ended at once with code 7"), std::string::npos) << e.what();
    }
    die_after_fork = false;
}

constexpr double kMass = 0.25, kDamping = 5.0;

TEST(SimHand, moves_like_a_damped_mass_at_any_step) {
    const double t = 0.2, f = 0.7;
    const double exact = f / kDamping * (t - kMass / kDamping * (1.0 - std::exp(-kDamping * t / kMass)));
    for (const int steps : {5, 200, 20000}) {
        SimHand hand({}, Vec3::Constant(1.0));
        for (int i = 0; i < steps; ++i)
            hand.step(Duration(200'000'000 / steps), {Vec3(f, 0.0, 0.0), Vec3::Zero()});
        EXPECT_NEAR(hand.pose().p_m.x(), exact, 1e-9) << steps;
    }
}

TEST(SimHand, turns_about_the_torque_at_the_speed_its_damping_allows) {
    SimHand hand({}, Vec3::Constant(1.0));
    const Vec3 torque(0.0, 0.0, 0.01);
    for (int i = 0; i < 1000; ++i) hand.step(milliseconds(1), {Vec3::Zero(), torque});
    EXPECT_NEAR(hand.twist().angular_rad_s.z(), 0.01 / 0.02, 1e-6);
    EXPECT_NEAR(rotation_vector_rad(hand.pose().q).z(), 0.5 * (1.0 - 1e-4 / 0.02), 1e-3);
}

TEST(SimHand, a_sampled_spring_below_the_stability_bound_comes_to_rest_at_any_servo_rate) {
    for (const Duration dt :
         {Duration(microseconds(50)), Duration(microseconds(1000)), Duration(microseconds(4000))}) {
        // K < b / (T/2 + T): the force of one sample acts until the next sample.
        const double k = 0.5 * kDamping / (1.5 * to_s(dt));
        SimHand hand({}, Vec3::Constant(1.0));
        const Vec3 rest(0.02, -0.01, 0.03);
        for (Duration t{0}; t < std::chrono::seconds(3); t += dt) {
            hand.step(dt, {k * (rest - hand.pose().p_m), Vec3::Zero()});
        }
        EXPECT_LT((hand.pose().p_m - rest).norm(), 1e-6) << to_us(dt);
    }
}

TEST(SimHand, stops_at_the_end_of_the_arm) {
    SimHand hand({}, Vec3::Constant(0.05));
    for (int i = 0; i < 2000; ++i) hand.step(milliseconds(1), {Vec3(5.0, 0.0, 0.0), Vec3::Zero()});
    EXPECT_DOUBLE_EQ(hand.pose().p_m.x(), 0.05);
    EXPECT_DOUBLE_EQ(hand.twist().linear_m_s.x(), 0.0);
}

TEST(SimHand, wanders_smoothly_within_bounds_and_repeats_for_the_same_seed) {
    SimHandSettings settings;
    settings.script = "wander";
    settings.seed = 5;
    SimHand a(settings, Vec3::Constant(0.2)), b(settings, Vec3::Constant(0.2));
    settings.seed = 6;
    SimHand other(settings, Vec3::Constant(0.2));
    double farthest = 0.0, fastest = 0.0;
    for (int i = 0; i < 20000; ++i) {
        for (SimHand* h : {&a, &b, &other}) h->step(milliseconds(1), {});
        ASSERT_EQ(a.pose().p_m, b.pose().p_m);
        farthest = std::max(farthest, a.pose().p_m.norm());
        fastest = std::max(fastest, a.twist().linear_m_s.norm());
    }
    EXPECT_NE(a.pose().p_m, other.pose().p_m);
    EXPECT_GT(farthest, 0.005);
    EXPECT_LT(farthest, 0.06);
    EXPECT_LT(fastest, 0.5);
}

TEST(SimHand, a_stroking_hand_moves_down_and_rests_on_the_surface) {
    SimHandSettings settings;
    settings.script = "stroke";
    SimHand free(settings, Vec3::Constant(0.2)), held(settings, Vec3::Constant(0.2));
    constexpr double kGroundM = -0.01, kGroundN_M = 1000.0;
    double least_n = 1e9, most_n = 0.0, farthest = 0.0;
    for (int i = 0; i < 20000; ++i) {
        free.step(milliseconds(1), {});
        const double push_n = std::max(0.0, kGroundN_M * (kGroundM - held.pose().p_m.y()));
        held.step(milliseconds(1), {Vec3(0.0, push_n, 0.0), Vec3::Zero()});
        if (i < 5000) continue;
        EXPECT_LT(free.pose().p_m.y(), -0.02);
        least_n = std::min(least_n, push_n);
        most_n = std::max(most_n, push_n);
        farthest = std::max(farthest, Vec3(held.pose().p_m.x(), 0.0, held.pose().p_m.z()).norm());
    }
    EXPECT_GT(least_n, 0.2);
    EXPECT_LT(most_n, 3.0);
    EXPECT_GT(farthest, 0.005);
}

// A hand in front of a wall 20 mm away; step() gets the wall's stiffness in N/m.
struct Walled {
    SimHand hand;
    double push_n = 0.0;
    explicit Walled(const char* script, std::uint64_t seed = 1)
        : hand(settings(script, seed), Vec3::Constant(0.2)) {}
    static SimHandSettings settings(const char* script, std::uint64_t seed) {
        SimHandSettings s;
        s.script = script;
        s.seed = seed;
        s.at_m = Vec3(0.01, -0.005, 0.0);
        return s;
    }
    void step(double n_m, bool powered = true) {
        push_n = powered ? std::max(0.0, n_m * (-0.02 - hand.pose().p_m.z())) : 0.0;
        hand.step(milliseconds(1), {Vec3(0.0, 0.0, push_n), Vec3::Zero()}, powered);
    }
};

TEST(SimSurgeon, presses_and_strokes_at_its_start_and_lifts_hand_and_pedal_in_between) {
    Walled a("surgeon"), again("surgeon"), other("surgeon", 2);
    EXPECT_EQ(a.hand.pose().p_m, Vec3(0.01, -0.005, 0.0));
    double most_n = 0.0, aside_m = 0.0;
    int pressed = 0, lifted = 0, while_lifted = 0;
    for (int i = 0; i < 30000; ++i) {
        for (Walled* w : {&a, &again, &other}) w->step(1500.0);
        ASSERT_EQ(a.hand.pose().p_m, again.hand.pose().p_m);
        most_n = std::max(most_n, a.push_n);
        aside_m = std::max(aside_m, (a.hand.pose().p_m - Vec3(0.01, -0.005, 0.0)).head<2>().norm());
        const bool pedal = (a.hand.buttons() & 2U) != 0;
        pressed += pedal && a.push_n > 0.2;
        lifted += !pedal && a.hand.pose().p_m.z() > -0.018 && i > 6000;
        while_lifted += !pedal && a.push_n > 0.0 && i > 6000;
    }
    EXPECT_NE(a.hand.pose().p_m, other.hand.pose().p_m);
    EXPECT_GT(most_n, 0.7);
    EXPECT_LT(most_n, 2.5);
    EXPECT_GT(aside_m, 2e-3);
    EXPECT_LT(aside_m, 10e-3);
    EXPECT_GT(pressed, 12000);
    EXPECT_GT(lifted, 1000);
    EXPECT_LT(while_lifted, 1000);  // on the way up
}

TEST(SimSurgeon, keeps_still_until_the_device_is_on_and_returns_when_it_goes_off) {
    Walled w("surgeon");
    const Vec3 begin_m = w.hand.pose().p_m;
    for (int i = 0; i < 3000; ++i) w.step(1500.0, false);
    EXPECT_LT((w.hand.pose().p_m - begin_m).norm(), 1e-6);
    for (int i = 0; i < 6000; ++i) w.step(1500.0);
    EXPECT_GT((w.hand.pose().p_m - begin_m).norm(), 0.01);
    for (int i = 0; i < 3000; ++i) w.step(1500.0, false);
    EXPECT_LT((w.hand.pose().p_m - begin_m).norm(), 1e-4);
    EXPECT_EQ(w.hand.buttons(), 0U);
}

TEST(SimSurgeon, continues_after_a_short_loss_of_power) {
    Walled w("surgeon");
    for (int i = 0; i < 9000; ++i) w.step(1500.0);
    const double deep_m = w.hand.pose().p_m.z();
    for (int i = 0; i < 100; ++i) w.step(1500.0, false);
    for (int i = 0; i < 1000; ++i) w.step(1500.0);
    EXPECT_NEAR(w.hand.pose().p_m.z(), deep_m, 2e-3);
    EXPECT_GT(w.push_n, 0.2);
    EXPECT_EQ(w.hand.buttons(), 2U);
}

TEST(SimSurgeon, tries_another_position_if_it_finds_no_bone) {
    Walled w("surgeon");
    double deepest_m = 0.0;
    std::vector<Vec3> tries;  // positions of the attempts
    for (int i = 0; i < 10000; ++i) {
        const bool above = w.hand.pose().p_m.z() > -0.04;
        w.step(0.0);
        deepest_m = std::min(deepest_m, w.hand.pose().p_m.z());
        if (above && w.hand.pose().p_m.z() <= -0.04) tries.push_back(w.hand.pose().p_m);
        EXPECT_EQ(w.hand.buttons(), 0U);
    }
    EXPECT_NEAR(deepest_m, -SimSurgeon::kReachM, 3e-3);
    ASSERT_GE(tries.size(), 2U);
    EXPECT_NEAR((tries[0] - Vec3(0.01, -0.005, 0.0)).head<2>().norm(), 0.0, 1e-3);
    EXPECT_NEAR((tries[1] - Vec3(0.01, -0.005, 0.0)).head<2>().norm(), 8e-3, 1e-3);
}

TEST(SimSurgeon, the_hand_with_the_suction_tube_touches_lightly_and_keeps_beside_the_burr) {
    Walled burr("surgeon"), suction_tube("suction-tube");
    double most_n = 0.0, nearest_m = 1.0;
    bool in_the_middle = false;
    for (int i = 0; i < 30000; ++i) {
        burr.step(1500.0);
        suction_tube.step(1500.0);
        most_n = std::max(most_n, suction_tube.push_n);
        const double apart_m = (burr.hand.pose().p_m - suction_tube.hand.pose().p_m).norm();
        if (burr.push_n > 0.0) nearest_m = std::min(nearest_m, apart_m);
        const double off_m = (suction_tube.hand.pose().p_m - Vec3(0.01, -0.005, 0.0)).head<2>().norm();
        in_the_middle = in_the_middle || off_m < 3e-3;
    }
    EXPECT_GT(most_n, 0.1);
    EXPECT_LT(most_n, 0.8);
    EXPECT_GT(nearest_m, 1e-3);
    EXPECT_TRUE(in_the_middle);
    EXPECT_EQ(suction_tube.hand.buttons(), 2U);
}

TEST(SimHand, an_unknown_script_is_refused) {
    SimHandSettings settings;
    settings.script = "dance";
    EXPECT_THROW(SimHand(settings, Vec3::Ones()), StartupError);
}

TEST(SimDevice, the_watchdog_drops_the_amplifier_exactly_on_time) {
    // Force lasts exactly 10 ms after the last heartbeat, independent of the read times.
    const auto way = [](std::initializer_list<int> looks_ms) {
        SimDevice device({});
        static_cast<void>(device.open());
        const Instant begin = instant_from_ns(1'000'000);
        DeviceSample s;
        static_cast<void>(device.read(s, begin));
        DeviceCommand c;
        c.enable = true;
        c.heartbeat = 1;
        c.wrench_dev.force_n = {1.0, 0.0, 0.0};
        static_cast<void>(device.write(c, begin));
        for (const int ms : looks_ms) static_cast<void>(device.read(s, begin + milliseconds(ms)));
        EXPECT_EQ(s.state, DeviceState::watchdog_tripped);
        EXPECT_TRUE(device.shown_dev().force_n.isZero(0.0));
        return device.hand_pose().p_m.x();
    };
    EXPECT_NEAR(way({30}), way({1, 2, 3, 9, 10, 11, 17, 30}), 1e-12);
    SimHand free({}, Vec3::Constant(1.0));
    free.step(milliseconds(10), {Vec3(1.0, 0.0, 0.0), Vec3::Zero()});
    free.step(milliseconds(20), {});
    EXPECT_NEAR(way({30}), free.pose().p_m.x(), 1e-12);
}

TEST(SimDevice, positions_are_multiples_of_the_encoder_step) {
    SimDevice device({});
    const DeviceInfo info = device.open();
    Instant now = instant_from_ns(1'000'000);
    DeviceSample s;
    DeviceCommand c;
    c.enable = true;
    c.wrench_dev.force_n = {0.3, 0.2, 0.1};
    for (int i = 0; i < 300; ++i) {
        now += milliseconds(1);
        static_cast<void>(device.read(s, now));
        ++c.heartbeat;
        static_cast<void>(device.write(c, now));
        for (const double x : s.T_dev_tool.p_m) {
            const double steps = x / info.position_step_m;
            ASSERT_NEAR(steps, std::round(steps), 1e-6);
        }
    }
    EXPECT_GT(s.T_dev_tool.p_m.norm(), 20 * info.position_step_m);
}

TEST(SimDevice, the_estimated_speed_is_that_of_the_hand) {
    SimDevice device({});
    static_cast<void>(device.open());
    Instant now = instant_from_ns(1'000'000);
    DeviceSample s;
    DeviceCommand c;
    c.enable = true;
    c.wrench_dev.force_n = {0.5, 0.0, 0.0};
    for (int i = 0; i < 500; ++i) {
        now += milliseconds(1);
        static_cast<void>(device.read(s, now));
        ++c.heartbeat;
        static_cast<void>(device.write(c, now));
    }
    EXPECT_NEAR(s.twist_dev.linear_m_s.x(), 0.5 / kDamping, 0.01);
}

TEST(SimDevice, excess_force_is_reduced_and_keeps_its_direction) {
    SimDevice device({});
    const DeviceInfo info = device.open();
    DeviceSample s;
    static_cast<void>(device.read(s, instant_from_ns(1)));
    DeviceCommand c;
    c.enable = true;
    c.heartbeat = 1;
    c.wrench_dev.force_n = {300.0, 400.0, 0.0};
    static_cast<void>(device.write(c, instant_from_ns(2)));
    EXPECT_TRUE(device.shown_dev().force_n.isApprox(Vec3(0.6, 0.8, 0.0) * info.force_n_max, 1e-12));
}

TEST(SimDevice, an_unplugged_device_stays_lost_until_reopened) {
    SimDevice device({});
    static_cast<void>(device.open());
    DeviceSample s;
    device.inject(SimFault::unplugged);
    EXPECT_EQ(device.read(s, instant_from_ns(1'000'000)), IoStatus::lost);
    device.inject(SimFault::none);
    EXPECT_EQ(device.read(s, instant_from_ns(2'000'000)), IoStatus::lost);
    EXPECT_EQ(device.write({.wrench_dev = {}, .enable = true, .heartbeat = 3}, instant_from_ns(2'000'000)),
              IoStatus::lost);
    static_cast<void>(device.open());
    EXPECT_EQ(device.read(s, instant_from_ns(3'000'000)), IoStatus::ok);
    EXPECT_EQ(s.state, DeviceState::ready);
}

TEST(Registry, an_unknown_driver_is_refused_with_the_known_names) {
    try {
        static_cast<void>(device_driver("omega"));
        FAIL();
    } catch (const StartupError& e) {
        EXPECT_NE(std::strstr(e.what(), "omega"), nullptr);
        EXPECT_NE(std::strstr(e.what(), "sim"), nullptr);
    }
}

}  // namespace
}  // namespace tact
