// The manufacturer's library behind the contract: a stand-in that is loaded like the real one.
#include "hal/openhaptics/open_haptics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "ipc/base/servo_clock.hpp"
#include "tests/support/openhaptics_driver.hpp"
#include "tests/support/pumped_case.hpp"
#include "tests/support/says.hpp"

namespace tact {
namespace {

using std::chrono::milliseconds;

FakeHd& fake() { return fake_hd_library(); }

HdClock hd_contract_clock;

INSTANTIATE_TEST_SUITE_P(OpenHaptics, HapticDeviceContract,
                         testing::Values(pumped_case<OpenHaptics>("openhaptics", hd_contract_clock,
                                                                  [] {
                                                                      fake().reset();
                                                                      return std::make_unique<OpenHaptics>(
                                                                          hd_settings(), hd_contract_clock);
                                                                  })),
                         [](const auto& tested) { return tested.param.name; });

class OpenHapticsTest : public VendorDriverTest<OpenHaptics, HdClock> {
protected:
    OpenHapticsTest() { fake().reset(); }

    void open() override {
        device = std::make_unique<OpenHaptics>(hd_settings(), clock);
        info = device->open();
    }
    [[nodiscard]] Vec3 shown() const override {
        return {fake().force_n[0].load(), fake().force_n[1].load(), fake().force_n[2].load()};
    }
};

TEST_F(OpenHapticsTest, a_missing_library_is_reported_with_all_searched_paths) {
    try {
        const hd::Library library("");
        GTEST_SKIP() << "the manufacturer's library is installed here: " << library.path();
    } catch (const StartupError& e) {
        EXPECT_TRUE(says(e.what(), {"libHD.so", "/usr/lib/libHD.so", "fix:", "device.hd_library"}))
            << e.what();
    }
    try {
        const hd::Library library("/nowhere/libHD.so");
        ADD_FAILURE();
    } catch (const StartupError& e) {
        EXPECT_TRUE(says(e.what(), {"/nowhere/libHD.so", "No such file"})) << e.what();
    }
}

TEST_F(OpenHapticsTest, a_library_without_a_function_is_refused_with_both_names) {
    try {
        const hd::Library library(TACT_FAKE_HD_OLD);
        ADD_FAILURE();
    } catch (const StartupError& e) {
        EXPECT_TRUE(says(e.what(), {TACT_FAKE_HD_OLD, "no function hdDisableDevice", "fix:"})) << e.what();
    }
}

TEST_F(OpenHapticsTest, millimetres_and_columns_become_a_pose_about_the_workspace_centre) {
    open();
    EXPECT_EQ(info.name, "Fake Arm by OpenHaptics");
    EXPECT_EQ(info.workspace_half_m, Vec3(0.080, 0.060, 0.035));
    EXPECT_DOUBLE_EQ(info.stiffness_n_m_max, 500.0);
    EXPECT_DOUBLE_EQ(info.force_n_max, 3.3);
    EXPECT_EQ(info.torque_n_m_max, 0.0);
    fake().position_mm[0] = 12.0;
    fake().position_mm[1] = 10.0;
    fake().position_mm[2] = -15.0;
    fake().buttons = 3;
    ASSERT_EQ(cycle(Vec3::Zero(), false), IoStatus::ok);
    EXPECT_LT((sample.T_dev_tool.p_m - Vec3(0.012, 0.0, -0.020)).norm(), 1e-12);
    EXPECT_LT((sample.T_dev_tool.q * Vec3::UnitX() - Vec3(0.0, 0.0, -1.0)).norm(), 1e-12);
    EXPECT_LT((sample.T_dev_tool.q * Vec3::UnitZ() - Vec3(1.0, 0.0, 0.0)).norm(), 1e-12);
    EXPECT_EQ(sample.twist_dev.angular_rad_s, Vec3::Constant(0.25));
    EXPECT_EQ(sample.buttons, 3U);
    EXPECT_TRUE(sample.hand_present);
    fake().inkwell = 1;
    cycle(Vec3::Zero(), false);
    EXPECT_FALSE(sample.hand_present);
}

TEST_F(OpenHapticsTest, velocity_is_in_metres_per_second_and_the_force_within_the_limit) {
    open();
    power();
    cycles(500, Vec3(1.0, 0.0, 0.0), true);
    EXPECT_NEAR(sample.twist_dev.linear_m_s.x(), 1.0 / 5.0, 1e-3);  // force over damping
    cycles(2, Vec3(30.0, 40.0, 0.0), true);
    EXPECT_LT((shown() - Vec3(0.6, 0.8, 0.0) * 3.3).norm(), 1e-12);
    EXPECT_FALSE(fake().ramping.load());
    EXPECT_TRUE(fake().clamping.load());
}

TEST_F(OpenHapticsTest, an_arm_with_six_motors_gets_its_torque_in_millinewton_metres) {
    fake().dof = 6;
    open();
    EXPECT_GT(info.torque_n_m_max, 0.0);
    command.wrench_dev.torque_n_m = Vec3(0.0, 0.02, 0.0);
    power();
    EXPECT_NEAR(fake().torque_mn_m[1].load(), 20.0, 1e-9);
    command.wrench_dev.torque_n_m = Vec3(0.0, 2.0, 0.0);
    cycle(Vec3::Zero(), true);
    EXPECT_NEAR(fake().torque_mn_m[1].load(), 1e3 * info.torque_n_m_max, 1e-9);
}

struct Error {
    unsigned code;
    hd::FaultKind kind;
    bool ends;
};

TEST_F(OpenHapticsTest, every_error_drops_the_force_at_once_and_needs_a_new_enable_edge) {
    using Kind = hd::FaultKind;
    for (const Error& e :
         {Error{0x200, Kind::motors_warm, false}, Error{0x201, Kind::limit, false},
          Error{0x202, Kind::limit, false}, Error{0x203, Kind::limit, false},
          Error{0x204, Kind::limit, false}, Error{0x300, Kind::device, false}, Error{0x302, Kind::link, true},
          Error{0x304, Kind::timer, true}, Error{0x400, Kind::timer, true}, Error{0x401, Kind::timer, true},
          Error{0x402, Kind::frame, false}, Error{0x103, Kind::refused, false},
          Error{0x600, Kind::refused, false}, Error{0x999, Kind::refused, false}}) {
        SCOPED_TRACE(e.code);
        fake().reset();
        open();
        power();
        fake().raise(e.code);
        EXPECT_EQ(cycle(Vec3(1.0, 0.0, 0.0), true), e.ends ? IoStatus::lost : IoStatus::fault);
        EXPECT_EQ(shown(), Vec3::Zero());
        EXPECT_EQ(sample.state, DeviceState::fault);
        EXPECT_EQ(sample.notice, hd::meaning(e.code).notice);
        EXPECT_NE(sample.notice, DeviceNotice::none);
        const hd::Counts c = device->counts();
        EXPECT_EQ(c.faults[static_cast<std::size_t>(e.kind)], 1U);
        EXPECT_EQ(c.last_code, e.code);
        EXPECT_EQ(c.last_kind, e.kind);
        // The force stays off over time while enable stays up.
        EXPECT_EQ(cycles(300, Vec3(1.0, 0.0, 0.0), true), e.ends ? IoStatus::lost : IoStatus::fault);
        EXPECT_EQ(shown(), Vec3::Zero());
        cycles(200, Vec3(1.0, 0.0, 0.0), false);
        EXPECT_EQ(shown(), Vec3::Zero());
        cycles(3, Vec3(1.0, 0.0, 0.0), true);
        if (e.ends) {
            EXPECT_EQ(shown(), Vec3::Zero());
            EXPECT_EQ(cycle(Vec3::Zero(), false), IoStatus::lost);
            info = device->open();
            EXPECT_EQ(cycles(2, Vec3::Zero(), false), IoStatus::ok);
            power();
        } else {
            EXPECT_EQ(sample.state, DeviceState::powered);
            EXPECT_EQ(sample.notice, DeviceNotice::none);
            EXPECT_EQ(shown().x(), 1.0);
        }
        EXPECT_FALSE(std::string(hd::meaning(e.code).says).empty());
        EXPECT_FALSE(std::string(hd::meaning(e.code).fixes).empty());
    }
}

TEST_F(OpenHapticsTest, a_fault_persists_with_its_cause_and_ignores_an_edge) {
    open();
    power();
    fake().always = true;
    fake().raise(0x200);
    cycles(150, Vec3::Zero(), false);
    EXPECT_EQ(sample.state, DeviceState::fault);
    EXPECT_EQ(device->counts().faults[static_cast<std::size_t>(hd::FaultKind::motors_warm)], 150U);
    fake().always = false;
    cycles(2, Vec3::Zero(), false);
    cycles(2, Vec3(1.0, 0.0, 0.0), true);  // an edge too early
    cycles(300, Vec3(1.0, 0.0, 0.0), true);
    EXPECT_EQ(shown(), Vec3::Zero());
    cycles(2, Vec3::Zero(), false);
    power();
}

TEST_F(OpenHapticsTest, a_servo_stopped_for_ten_milliseconds_gives_zero_force) {
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

TEST_F(OpenHapticsTest, after_relax_a_new_enable_edge_is_required) {
    open();
    power();
    device->relax();
    cycles(20, Vec3(1.0, 0.0, 0.0), true);
    EXPECT_EQ(shown(), Vec3::Zero());
    cycles(2, Vec3::Zero(), false);
    power();
}

TEST_F(OpenHapticsTest, impossible_poses_are_refused_and_counted_and_the_last_one_ages) {
    for (auto* const spoil : {&fake().not_a_number, &fake().no_rotation}) {
        fake().reset();
        open();
        ASSERT_EQ(cycle(Vec3::Zero(), false), IoStatus::ok);
        const std::uint64_t before = sample.sequence;
        *spoil = true;
        EXPECT_EQ(cycle(Vec3::Zero(), false), IoStatus::stale);
        EXPECT_EQ(sample.sequence, before);
        EXPECT_TRUE(sample.T_dev_tool.finite());
        EXPECT_EQ(device->counts().refused_samples, 1U);
        EXPECT_GT(sample.bus.packets, 0U);
        EXPECT_EQ(cycles(110, Vec3::Zero(), false), IoStatus::lost);
        *spoil = false;
        EXPECT_EQ(cycle(Vec3::Zero(), false), IoStatus::ok);
    }
}

TEST_F(OpenHapticsTest, a_scheduler_that_stops_calling_is_a_lost_device) {
    open();
    power();
    fake().never_calls = true;
    EXPECT_EQ(cycles(50, Vec3::Zero(), true), IoStatus::stale);
    EXPECT_EQ(cycles(60, Vec3::Zero(), true), IoStatus::lost);
    EXPECT_EQ(device->write(command, clock.now()), IoStatus::lost);
}

TEST_F(OpenHapticsTest, a_self_calibrating_arm_is_updated_and_ready) {
    fake().needs_update = true;
    open();
    cycles(3, Vec3::Zero(), false);
    EXPECT_EQ(fake().updates.load(), 1U);
    EXPECT_EQ(device->counts().calibrations, 1U);
    EXPECT_EQ(sample.notice, DeviceNotice::none);
    power();
}

TEST_F(OpenHapticsTest, before_calibration_it_is_at_the_origin_without_hand_and_force) {
    fake().styles = hd::kStyleInkwell;
    fake().needs_manual = true;
    fake().position_mm[0] = 12.0;
    open();
    EXPECT_EQ(cycles(300, Vec3(1.0, 0.0, 0.0), true), IoStatus::ok);
    EXPECT_EQ(sample.notice, DeviceNotice::stylus_into_inkwell);
    EXPECT_FALSE(sample.hand_present);
    EXPECT_EQ(sample.T_dev_tool.p_m, Vec3::Zero());
    EXPECT_EQ(sample.state, DeviceState::ready);
    EXPECT_EQ(shown(), Vec3::Zero());
    EXPECT_EQ(fake().updates.load(), 0U);
    fake().inkwell = 1;
    cycles(3, Vec3::Zero(), true);
    EXPECT_EQ(fake().updates.load(), 1U);
    EXPECT_FALSE(sample.hand_present);  // it is still in the inkwell
    fake().inkwell = 0;
    cycles(3, Vec3(1.0, 0.0, 0.0), true);
    EXPECT_EQ(sample.notice, DeviceNotice::none);
    EXPECT_TRUE(sample.hand_present);
    EXPECT_EQ(sample.state, DeviceState::powered);  // enable was set before and never fell
}

TEST_F(OpenHapticsTest, an_enable_dropped_or_relaxed_before_calibration_powers_nothing) {
    for (const bool relax : {false, true}) {
        fake().reset();
        fake().styles = hd::kStyleInkwell;
        fake().needs_manual = true;
        open();
        cycles(10, Vec3::Zero(), true);
        if (relax)
            device->relax();
        else
            cycles(2, Vec3::Zero(), false);
        fake().inkwell = 1;
        cycles(10, Vec3::Zero(), relax);
        fake().inkwell = 0;
        cycles(10, Vec3(1.0, 0.0, 0.0), relax);
        EXPECT_EQ(sample.notice, DeviceNotice::none);
        EXPECT_EQ(sample.state, DeviceState::ready);
        EXPECT_EQ(shown(), Vec3::Zero());
        power();
    }
}

TEST_F(OpenHapticsTest, the_reset_pose_is_confirmed_by_a_button_after_half_a_second_of_rest) {
    fake().styles = hd::kStyleEncoderReset;
    fake().needs_manual = true;
    fake().buttons = 1;  // pressed from the start
    open();
    cycles(1000, Vec3::Zero(), false);
    EXPECT_EQ(sample.notice, DeviceNotice::hold_reset_pose);
    fake().buttons = 0;
    for (int i = 0; i < 1000; ++i) {  // the arm moves
        fake().position_mm[1] = 0.02 * i;
        fake().buttons = i % 100 == 99 ? 1 : 0;
        cycle(Vec3::Zero(), false);
    }
    EXPECT_EQ(fake().updates.load(), 0U);
    fake().buttons = 0;
    cycles(600, Vec3::Zero(), false);
    fake().buttons = 1;
    cycles(3, Vec3::Zero(), false);
    EXPECT_EQ(fake().updates.load(), 1U);
    EXPECT_EQ(sample.notice, DeviceNotice::none);
}

TEST_F(OpenHapticsTest, no_calibration_under_force_and_lost_counts_request_a_new_one) {
    fake().styles = hd::kStyleInkwell;
    open();
    power();
    fake().needs_update = true;
    fake().inkwell = 1;
    cycles(200, Vec3(1.0, 0.0, 0.0), true);
    EXPECT_EQ(fake().updates.load(), 0U);
    EXPECT_EQ(sample.state, DeviceState::powered);
    cycles(2, Vec3::Zero(), false);
    EXPECT_EQ(fake().updates.load(), 1U);
    fake().inkwell = 0;
    fake().needs_manual = true;
    EXPECT_EQ(cycles(70, Vec3::Zero(), false), IoStatus::fault);
    EXPECT_EQ(sample.notice, DeviceNotice::count_lost);
    EXPECT_EQ(device->counts().last_kind, hd::FaultKind::calibration);
    cycles(200, Vec3::Zero(), false);
    EXPECT_EQ(sample.notice, DeviceNotice::stylus_into_inkwell);
    fake().inkwell = 1;
    cycles(3, Vec3::Zero(), false);
    EXPECT_EQ(fake().updates.load(), 2U);
    fake().inkwell = 0;
    power();
}

// The force of the cycle after a sample moves the next sample; the driver adds an estimate of 2 periods.
TEST_F(OpenHapticsTest, the_delay_is_the_measured_ticks_plus_two_periods_of_the_reported_rate) {
    struct Row {
        int reported_hz;
        Duration delay;
    };
    for (const Row& row : {Row{1000, milliseconds(4)}, Row{500, milliseconds(6)}, Row{0, milliseconds(4)},
                           Row{-5, milliseconds(4)}}) {
        fake().reset();
        fake().rate_hz = row.reported_hz;
        open();
        EXPECT_EQ(sample.delay, Duration{0}) << row.reported_hz;
        cycles(20, Vec3::Zero(), false);
        EXPECT_EQ(sample.delay, row.delay) << row.reported_hz;
        sample = {};
    }
}

TEST_F(OpenHapticsTest, open_errors_are_reported_with_a_fix) {
    fake().init_error = 0x600;
    EXPECT_TRUE(
        says(refusal(), {"default haptic device", "no licence", "0x600", "fix:", "device.hd_device"}));
    fake().reset();
    fake().init_error = 0x302;
    EXPECT_TRUE(says(refusal(), {"0x302", "cable"}));
    fake().reset();
    fake().never_calls = true;
    EXPECT_TRUE(says(refusal(), {"started no cycle"}));
    fake().reset();
    fake().not_a_number = true;
    EXPECT_TRUE(says(refusal(), {"no usable position"}));
    fake().reset();
    fake().force_n_max = std::nan("");
    EXPECT_TRUE(says(refusal(), {"is not plausible"}));
    fake().reset();
    fake().raise(0x304);
    EXPECT_TRUE(says(refusal(), {"scheduler stopped", "fix:"}));
    fake().reset();
    fake().model = "Evil\x1b[2J";
    open();
    EXPECT_EQ(info.name, "Evil?[2J by OpenHaptics");
}

// The library's thread and the servo's thread, as in reality.
TEST_F(OpenHapticsTest, samples_and_forces_pass_between_the_threads) {
    fake().threaded = true;
    OpenHapticsSettings s = hd_settings();
    s.first_sample_max = std::chrono::seconds(60);
    OpenHaptics own(s);
    static_cast<void>(own.open());
    const Instant end = Monotonic::now() + std::chrono::minutes(1);
    DeviceCommand c;
    bool felt = false;
    for (bool enable = false; !felt && Monotonic::now() < end;) {
        static_cast<void>(own.read(sample, Monotonic::now()));
        if (sample.state == DeviceState::watchdog_tripped) enable = false;
        c.enable = enable;
        c.wrench_dev.force_n = Vec3(1.0, 0.0, 0.0);
        ++c.heartbeat;
        static_cast<void>(own.write(c, Monotonic::now()));
        if (sample.state == DeviceState::ready) enable = true;
        felt = sample.state == DeviceState::powered && sample.twist_dev.linear_m_s.x() > 0.0;
        std::this_thread::sleep_for(milliseconds(1));
    }
    EXPECT_TRUE(felt);
    own.relax();
    EXPECT_TRUE(sample.T_dev_tool.finite());
}

}  // namespace
}  // namespace tact
