// The driver of Force Dimension's arms behind the contract: a substitute that is loaded like the real library.
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "tests/support/forcedimension_driver.hpp"
#include "tests/support/pumped_case.hpp"

namespace tact {
namespace {

using std::chrono::milliseconds;

FdClock fd_contract_clock;

INSTANTIATE_TEST_SUITE_P(ForceDimension, HapticDeviceContract,
                         testing::Values(pumped_case<ForceDimension>(
                             "forcedimension", fd_contract_clock,
                             [] {
                                 fake_fd_library().reset();
                                 return std::make_unique<ForceDimension>(fd_settings(), fd_contract_clock);
                             })),
                         [](const auto& tested) { return tested.param.name; });

TEST_F(ForceDimensionTest, axes_and_centre_of_an_omega_become_those_of_tact) {
    open();
    EXPECT_EQ(info.name, "Force Dimension omega.3");
    EXPECT_EQ(info.serial, "1001");
    EXPECT_EQ(info.torque_n_m_max, 0.0);
    EXPECT_DOUBLE_EQ(info.force_n_max, 12.0);
    EXPECT_LT((info.workspace_half_m - Vec3(0.075, 0.075, 0.0525)).norm(), 1e-12);
    arm().position_m[0] = 0.01;  // to the user
    arm().position_m[1] = 0.02;  // right
    arm().position_m[2] = 0.03;  // up
    ASSERT_EQ(cycle(Vec3::Zero(), false), IoStatus::ok);
    EXPECT_LT((sample.T_dev_tool.p_m - Vec3(0.02, 0.03, 0.01)).norm(), 1e-12);
    EXPECT_LT((sample.T_dev_tool.q.matrix() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_TRUE(sample.hand_present);
    power();
    cycle(Vec3(1.0, 2.0, 3.0), true);
    EXPECT_EQ(arm().force_n[0].load(), 3.0);
    EXPECT_EQ(arm().force_n[1].load(), 1.0);
    EXPECT_EQ(arm().force_n[2].load(), 2.0);
    cycles(500, Vec3(1.0, 0.0, 0.0), true);
    EXPECT_NEAR(sample.twist_dev.linear_m_s.x(), 1.0 / 5.0, 1e-3);  // force over damping
}

TEST_F(ForceDimensionTest, a_wrist_turns_in_the_same_axes_and_gets_its_torque) {
    arm().type = 104;  // sigma.7
    arm().wrist = arm().torque = arm().gripper = true;
    arm().turn = {{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}};  // a quarter turn about z, which is up
    arm().angular_rad_s[2] = 0.5;
    open();
    EXPECT_DOUBLE_EQ(info.torque_n_m_max, 0.2);
    cycle(Vec3::Zero(), false);
    // A quarter turn about up, y of Tact: z goes to x.
    EXPECT_LT((sample.T_dev_tool.q * Vec3::UnitZ() - Vec3::UnitX()).norm(), 1e-12);
    EXPECT_LT((sample.T_dev_tool.q * Vec3::UnitY() - Vec3::UnitY()).norm(), 1e-12);
    EXPECT_LT((sample.twist_dev.angular_rad_s - Vec3(0.0, 0.5, 0.0)).norm(), 1e-12);
    // The middle of a right-handed sigma.7.
    EXPECT_LT((sample.T_dev_tool.p_m - Vec3(0.02, 0.0, -0.01)).norm(), 1e-12);
    command.wrench_dev.torque_n_m = Vec3(0.01, 0.02, 0.03);
    power();
    EXPECT_DOUBLE_EQ(arm().torque_n_m[0].load(), 0.03);
    EXPECT_DOUBLE_EQ(arm().torque_n_m[1].load(), 0.01);
    EXPECT_DOUBLE_EQ(arm().torque_n_m[2].load(), 0.02);
    command.wrench_dev.torque_n_m = Vec3(0.0, 3.0, 4.0);
    cycle(Vec3(0.0, 0.0, 100.0), true);
    EXPECT_NEAR(arm().force_n[0].load(), 12.0, 1e-12);  // within the limits, direction kept
    EXPECT_NEAR(arm().torque_n_m[0].load(), 0.16, 1e-12);
    EXPECT_NEAR(arm().torque_n_m[2].load(), 0.12, 1e-12);
    EXPECT_EQ(arm().gripper_n.load(), 0.0);
}

TEST_F(ForceDimensionTest, a_closed_gripper_is_the_first_button_on_both_hands) {
    for (const bool left : {false, true}) {
        fake().reset();
        arm().type = left ? 37 : 35;  // omega.7
        arm().wrist = arm().gripper = true;
        arm().left = left;
        open();
        EXPECT_EQ(info.torque_n_m_max, 0.0);  // its wrist has no motors
        cycle(Vec3::Zero(), false);
        EXPECT_EQ(sample.buttons, 0U) << left;
        arm().gripper_rad = 0.05;
        cycle(Vec3::Zero(), false);
        EXPECT_EQ(sample.buttons, 1U) << left;
        arm().gripper_rad = 0.15;  // between the thresholds: stays
        cycle(Vec3::Zero(), false);
        EXPECT_EQ(sample.buttons, 1U) << left;
        arm().gripper_rad = 0.2;
        arm().buttons = 4;
        cycle(Vec3::Zero(), false);
        EXPECT_EQ(sample.buttons, 4U) << left;
    }
}

TEST_F(ForceDimensionTest, it_is_set_up_with_watchdog_short_velocity_windows_and_brakes_while_off) {
    open();
    EXPECT_EQ(arm().watchdog_eighths.load(), 80);  // 10 ms
    EXPECT_EQ(arm().linear_window_ms, 5);
    EXPECT_EQ(arm().time_guard_us, -1);  // the library's own: it reads once per round
    EXPECT_TRUE(arm().brakes.load());
    EXPECT_FALSE(arm().force.load());
    power();
    EXPECT_FALSE(arm().brakes.load());
    cycle(Vec3::Zero(), false);
    EXPECT_TRUE(arm().brakes.load());
    EXPECT_FALSE(arm().force.load());
    power();
    const unsigned stops = arm().stops.load();
    clock.device = nullptr;
    device.reset();
    EXPECT_EQ(arm().stops.load(), stops + 1);  // the library's own stop, before it is closed
    EXPECT_TRUE(arm().brakes.load());
    EXPECT_FALSE(arm().force.load());
    EXPECT_FALSE(arm().open.load());
    arm().no_watchdog = true;
    said().clear();
    open();
    EXPECT_TRUE(says(said(), {"no watchdog of its own"})) << said();
}

// The library's default is on.
TEST_F(ForceDimensionTest, the_library_holds_the_arm_only_if_the_settings_say_so) {
    said().clear();
    open();
    power();
    EXPECT_FALSE(arm().gravity.load());
    EXPECT_EQ(said(), "");
    arm().gravity = true;
    arm().no_gravity_call = true;
    open();
    EXPECT_TRUE(says(said(), {"did not confirm that its gravity compensation is off", "fix:"})) << said();
    said().clear();
    settings.gravity = true;
    open();
    EXPECT_TRUE(says(said(), {"device.fd_gravity", "does not hold the weight"})) << said();
    said().clear();
    arm().gravity = arm().no_gravity_call = false;
    open();
    EXPECT_TRUE(arm().gravity.load());
    EXPECT_TRUE(says(said(), {"device.fd_gravity", "none of Tact's limits"})) << said();
}

TEST_F(ForceDimensionTest, a_hung_pump_is_caught_by_the_watchdog_of_the_device) {
    open();
    power();
    clock.device = nullptr;  // no more rounds
    clock.wait_until(clock.now() + milliseconds(15));
    EXPECT_FALSE(arm().force.load());
    clock.device = device.get();
    cycles(100, Vec3(1.0, 0.0, 0.0), true);
    EXPECT_EQ(shown(), Vec3::Zero());
    EXPECT_NE(sample.state, DeviceState::powered);
}

TEST_F(ForceDimensionTest, a_servo_stopped_for_ten_milliseconds_gives_zero_force) {
    open();
    power();
    clock.wait_until(clock.now() + milliseconds(9));
    EXPECT_EQ(shown().x(), 1.0);
    clock.wait_until(clock.now() + milliseconds(3));
    EXPECT_EQ(shown(), Vec3::Zero());
    static_cast<void>(device->read(sample, clock.now()));
    EXPECT_EQ(sample.state, DeviceState::watchdog_tripped);
    EXPECT_EQ(device->counts().watchdog_trips, 1U);
}

TEST_F(ForceDimensionTest, the_delay_is_the_measured_rounds_plus_two_periods_of_the_reported_rate) {
    struct Row {
        double khz;
        Duration delay;
    };
    for (const Row& row : {Row{2.0, milliseconds(3)}, Row{0.5, milliseconds(6)}, Row{0.0, milliseconds(4)},
                           Row{std::nan(""), milliseconds(4)}, Row{1e9, milliseconds(4)}}) {
        fake().reset();
        fake().com_khz = row.khz;
        open();
        EXPECT_EQ(sample.delay, Duration{0});
        cycles(40, Vec3::Zero(), false);
        EXPECT_EQ(sample.delay, row.delay) << row.khz;
        sample = {};
    }
}

TEST_F(ForceDimensionTest, repeated_and_impossible_poses_are_counted_and_the_last_one_ages) {
    for (auto* const spoil : {&fake().not_a_number, &fake().no_rotation, &fake().guarded}) {
        fake().reset();
        arm().type = 34;  // omega.6
        arm().wrist = true;
        open();
        ASSERT_EQ(cycle(Vec3::Zero(), false), IoStatus::ok);
        const std::uint64_t before = sample.sequence;
        *spoil = true;
        EXPECT_EQ(cycle(Vec3::Zero(), false), IoStatus::stale);
        EXPECT_EQ(sample.sequence, before);
        EXPECT_TRUE(sample.T_dev_tool.finite());
        const bool guarded = spoil == &fake().guarded;
        EXPECT_EQ(device->counts().refused_samples, guarded ? 0U : 1U);
        EXPECT_EQ(device->counts().repeated_samples, guarded ? 1U : 0U);
        EXPECT_EQ(cycles(110, Vec3::Zero(), false), IoStatus::lost);
        *spoil = false;
        EXPECT_EQ(cycle(Vec3::Zero(), false), IoStatus::ok);
    }
}

TEST_F(ForceDimensionTest, a_velocity_that_is_not_ready_is_zero_and_no_fault) {
    open();
    power();
    cycles(100, Vec3(1.0, 0.0, 0.0), true);
    fake().fail_velocity = fd::kErrorTimeout;
    EXPECT_EQ(cycle(Vec3(1.0, 0.0, 0.0), true), IoStatus::ok);
    EXPECT_EQ(sample.twist_dev.linear_m_s, Vec3::Zero());
    EXPECT_EQ(device->counts().missing_velocities, 1U);
    EXPECT_EQ(shown().x(), 1.0);
    fake().saturated = true;
    EXPECT_EQ(cycle(Vec3(1.0, 0.0, 0.0), true), IoStatus::ok);
    EXPECT_EQ(device->counts().saturated, 1U);
}

// The thread of the pump and that of the servo, as in reality.
TEST_F(ForceDimensionTest, samples_and_forces_pass_between_the_threads) {
    fake().threaded = true;
    ForceDimensionSettings s = fd_settings();
    s.thread = true;
    s.pump_priority = 0;
    s.first_sample_max = std::chrono::seconds(60);
    ForceDimension own(s);
    static_cast<void>(own.open());
    const Instant end = Monotonic::now() + std::chrono::minutes(1);
    DeviceCommand c;
    bool moved = false;
    for (bool enable = false; !moved && Monotonic::now() < end;) {
        static_cast<void>(own.read(sample, Monotonic::now()));
        if (sample.state == DeviceState::watchdog_tripped || sample.state == DeviceState::fault)
            enable = false;
        c.enable = enable;
        c.wrench_dev.force_n = Vec3(1.0, 0.0, 0.0);
        ++c.heartbeat;
        static_cast<void>(own.write(c, Monotonic::now()));
        if (sample.state == DeviceState::ready) enable = true;
        moved = sample.state == DeviceState::powered && sample.twist_dev.linear_m_s.x() > 0.0;
        std::this_thread::sleep_for(milliseconds(1));
    }
    EXPECT_TRUE(moved);
    own.relax();
    EXPECT_TRUE(sample.T_dev_tool.finite());
}

}  // namespace
}  // namespace tact
