// The driver on an emulated board without a bus: the contract, and each row of the table in PROTOCOL.md.
#include "hal/phantom/phantom_usb.hpp"

#include <gtest/gtest.h>

#include "ipc/base/error.hpp"
#include "tests/contract/haptic_device_contract.hpp"
#include "tests/support/board_bus.hpp"

namespace tact {
namespace {

using emu::BoardSettings;
using emu::LockstepPhantom;
using usb::BusFault;

INSTANTIATE_TEST_SUITE_P(PhantomUsb, HapticDeviceContract,
                         testing::Values(DeviceCase{"premium_1_5",
                                                    [] { return std::make_unique<LockstepPhantom>(); },
                                                    [](Instant now, Duration d) { return now + d; }}),
                         [](const auto& tested) { return tested.param.name; });

class Phantom : public testing::Test {
protected:
    void start() {
        arm_.open();
        run(20, on_);
        ASSERT_EQ(arm_.sample.state, DeviceState::powered) << device_notice_text(arm_.sample.notice);
    }
    IoStatus run(int cycles, const DeviceCommand& command) {
        IoStatus status = IoStatus::ok;
        for (int i = 0; i < cycles; ++i) status = arm_.cycle(command);
        return status;
    }
    // Returns the number of cycles until the motors are off, at most `most`.
    int cycles_to_zero(int most) {
        for (int i = 0; i < most; ++i) {
            if (arm_.board().amplifier().state() != phantom::AmplifierState::on) return i;
            arm_.cycle(on_);
        }
        return most;
    }
    void expect_latched(DeviceNotice cause) {
        EXPECT_EQ(arm_.sample.notice, cause) << device_notice_text(arm_.sample.notice);
        EXPECT_EQ(arm_.board().amplifier().state() == phantom::AmplifierState::on, false);
        run(200, on_);  // power does not return while enable stays up
        EXPECT_NE(arm_.board().amplifier().state(), phantom::AmplifierState::on);
        EXPECT_NE(arm_.sample.notice, DeviceNotice::none);
        EXPECT_EQ(arm_.board().shown().force_n, Vec3(Vec3::Zero()));
    }
    void expect_recovers() {
        run(20, {});
        EXPECT_EQ(arm_.sample.notice, DeviceNotice::none) << device_notice_text(arm_.sample.notice);
        EXPECT_EQ(arm_.sample.state, DeviceState::ready);
        run(20, on_);
        EXPECT_EQ(arm_.sample.state, DeviceState::powered);
    }
    // After these faults the person must calibrate again; power stays off until then.
    void expect_calibrates_again() {
        run(20, {});
        EXPECT_EQ(arm_.sample.notice, DeviceNotice::hold_reset_pose)
            << device_notice_text(arm_.sample.notice);
        EXPECT_FALSE(arm_.sample.hand_present);
        run(200, on_);
        EXPECT_EQ(arm_.sample.state, DeviceState::ready);
        run(20, {});
        for (int i = 0; i < 40; ++i) {
            arm_.board().press(i >= 10 ? 1 : 0);
            arm_.cycle({});
        }
        arm_.board().press(0);
        EXPECT_EQ(arm_.sample.notice, DeviceNotice::keep_still);
        run(600, {});
        EXPECT_EQ(arm_.sample.notice, DeviceNotice::none) << device_notice_text(arm_.sample.notice);
        expect_recovers();
    }

    LockstepPhantom arm_;
    const DeviceCommand on_{.wrench_dev = {Vec3(0.0, 0.0, 0.1), Vec3::Zero()}, .enable = true};
};

TEST_F(Phantom, the_person_calibrates_it_following_the_notices) {
    arm_.device().open();
    std::vector<DeviceNotice> said;
    bool moved = false;
    for (int i = 0; i < 3000; ++i) {
        arm_.cycle(on_);
        if (said.empty() || said.back() != arm_.sample.notice) said.push_back(arm_.sample.notice);
        const bool calibrated = arm_.device().calibration() == CalibrationState::done;
        if (!calibrated) {
            EXPECT_NE(arm_.board().amplifier().state(), phantom::AmplifierState::on);
            EXPECT_FALSE(arm_.sample.hand_present);
        }
        moved = moved || arm_.sample.T_dev_tool.p_m.norm() > 0.1;
    }
    const std::vector<DeviceNotice> asked{DeviceNotice::hold_reset_pose, DeviceNotice::keep_still,
                                          DeviceNotice::none};
    EXPECT_EQ(said, asked);
    EXPECT_TRUE(moved);  // from the reset pose, outside the workspace, to its centre
}

TEST_F(Phantom, gives_the_pose_and_speed_of_the_hand_within_a_step) {
    start();
    run(50, on_);
    for (int i = 0; i < 300; ++i) {
        arm_.cycle(on_);
        const Vec3 off = arm_.sample.T_dev_tool.p_m - arm_.board().tool_pose().p_m;
        ASSERT_LT(off.norm(), 1e-4) << i;
    }
    // 0.1 N against 5 N s/m
    EXPECT_NEAR(arm_.sample.twist_dev.linear_m_s.z(), 0.02, 0.003);
}

TEST_F(Phantom, the_delay_from_sample_to_motor_is_measured_by_the_board_clock) {
    start();
    EXPECT_EQ(arm_.sample.delay, std::chrono::milliseconds(1));
}

TEST_F(Phantom, force_has_the_requested_direction_and_size) {
    start();
    for (const Vec3& f : {Vec3(0.5, 0.0, 0.0), Vec3(0.0, 0.5, 0.0), Vec3(0.0, 0.0, -0.5)}) {
        run(5, {.wrench_dev = {f, Vec3::Zero()}, .enable = true});
        EXPECT_LT((arm_.board().shown().force_n - f).norm(), 0.02) << f.transpose();
    }
}

TEST_F(Phantom, a_refused_state_is_counted_and_the_last_valid_one_is_kept_for_two_cycles) {
    start();
    for (int i = 0; i < 10; ++i) {
        arm_.board().faults().corrupt = 2;
        run(2, on_);
        EXPECT_EQ(arm_.sample.state, DeviceState::powered);
        run(20, on_);
        EXPECT_EQ(arm_.sample.state, DeviceState::powered);
    }
    const auto counts = arm_.news().counts;
    std::uint64_t refused = 0;
    for (const std::uint64_t r : counts.refused) refused += r;
    EXPECT_EQ(refused, 20U);
    EXPECT_EQ(counts.lost, 20U);
    EXPECT_EQ(arm_.sample.bus.checksum + arm_.sample.bus.refused, 20U);
    EXPECT_EQ(arm_.sample.bus.lost, 20U);
    EXPECT_GT(arm_.sample.bus.packets, 200U);
    EXPECT_EQ(arm_.sample.bus.stalls + arm_.sample.bus.reconnects + arm_.sample.bus.transfers_failed, 0U);
}

TEST_F(Phantom, at_the_third_refused_state_the_force_is_zero_and_latched) {
    start();
    arm_.board().faults().corrupt = 3;
    EXPECT_EQ(run(2, on_), IoStatus::stale);
    EXPECT_EQ(run(1, on_), IoStatus::fault);
    EXPECT_EQ(arm_.sample.notice, DeviceNotice::silent);
    run(1, on_);
    expect_latched(DeviceNotice::silent);
    expect_recovers();
}

TEST_F(Phantom, repeated_and_late_states_change_nothing_and_are_counted) {
    start();
    arm_.board().faults().repeat = 5;
    run(10, on_);
    arm_.board().faults().reorder = 1;
    run(10, on_);
    EXPECT_EQ(arm_.sample.state, DeviceState::powered);
    const auto counts = arm_.news().counts;
    EXPECT_EQ(counts.repeated, 5U);
    EXPECT_EQ(counts.stale, 1U);
}

TEST_F(Phantom, more_than_five_percent_bad_within_a_second_is_a_warning_and_no_fault) {
    start();
    for (int i = 0; i < 220; ++i) {
        arm_.board().faults().corrupt = 1;
        run(10, on_);
    }
    EXPECT_EQ(arm_.sample.state, DeviceState::powered);
    EXPECT_EQ(arm_.sample.notice, DeviceNotice::states_refused);
    EXPECT_GE(arm_.news().counts.bad_seconds, 1U);
}

TEST_F(Phantom, silence_of_the_board_is_a_latched_fault_and_longer_silence_a_lost_device) {
    start();
    arm_.board().faults().frozen = true;
    EXPECT_EQ(run(3, on_), IoStatus::fault);
    EXPECT_EQ(run(100, on_), IoStatus::lost);
    arm_.board().faults().frozen = false;
    run(200, on_);
    expect_latched(DeviceNotice::silent);
    expect_recovers();
}

TEST_F(Phantom, each_amplifier_fault_gives_zero_force_at_once_and_latches) {
    struct Row {
        std::uint16_t bit;
        DeviceNotice notice;
    };
    arm_.open();
    for (const Row& row : {Row{phantom::status::kOverTemperature, DeviceNotice::over_temperature},
                           Row{phantom::status::kSafetyOpen, DeviceNotice::safety_open},
                           Row{phantom::status::kOverCurrent, DeviceNotice::over_current}}) {
        run(20, on_);
        ASSERT_EQ(arm_.sample.state, DeviceState::powered);
        arm_.board().faults().causes = row.bit;
        EXPECT_EQ(run(2, on_), IoStatus::fault);
        expect_latched(row.notice);
        arm_.board().faults().causes = 0;  // the cause is gone, enable is still up
        run(50, on_);
        expect_latched(row.notice);
        expect_recovers();
        run(20, {});
    }
}

TEST_F(Phantom, a_brown_out_needs_a_calibration_again) {
    start();
    arm_.board().faults().causes = phantom::status::kBrownOut;
    EXPECT_EQ(run(2, on_), IoStatus::fault);
    expect_latched(DeviceNotice::brown_out);
    arm_.board().faults().causes = 0;
    expect_calibrates_again();
}

TEST_F(Phantom, a_lost_count_needs_a_calibration_again) {
    start();
    arm_.board().faults().count_lost = true;
    EXPECT_EQ(run(2, on_), IoStatus::fault);
    run(2, on_);
    expect_latched(DeviceNotice::count_lost);
    arm_.board().faults().count_lost = false;
    expect_calibrates_again();
}

TEST_F(Phantom, an_encoder_that_jumps_is_latched_and_calibrated_again) {
    start();
    arm_.board().faults().jump[1] = 2000;
    EXPECT_EQ(run(1, on_), IoStatus::fault);
    run(2, on_);
    expect_latched(DeviceNotice::encoder_jumped);
    expect_calibrates_again();
}

TEST_F(Phantom, a_stuck_encoder_is_detected_while_its_motor_pushes) {
    start();
    arm_.board().faults().stuck_encoder = 0;
    const DeviceCommand push{.wrench_dev = {Vec3(0.8, 0.8, 0.8), Vec3::Zero()}, .enable = true};
    int n = 0;
    while (n < 2000 && arm_.cycle(push) != IoStatus::fault) ++n;
    EXPECT_EQ(arm_.sample.notice, DeviceNotice::encoder_stuck) << n;
    run(2, push);
    EXPECT_NE(arm_.board().amplifier().state(), phantom::AmplifierState::on);
}

TEST_F(Phantom, a_hand_that_resists_the_force_is_no_stuck_encoder) {
    start();
    arm_.board().faults().stuck_encoder = 0;
    const DeviceCommand push{.wrench_dev = {Vec3(0.8, 0.0, 0.0), Vec3::Zero()}, .enable = true};
    run(300, push);
    EXPECT_EQ(arm_.sample.state, DeviceState::powered) << device_notice_text(arm_.sample.notice);
}

TEST_F(Phantom, a_broken_drive_is_detected_within_fifty_milliseconds) {
    start();
    const DeviceCommand push{.wrench_dev = {Vec3(0.0, 3.0, 0.0), Vec3::Zero()}, .enable = true};
    run(3, push);
    arm_.board().faults().dead_drive = 1;
    int n = 0;
    while (n < 200 && arm_.cycle(push) != IoStatus::fault) ++n;
    EXPECT_NEAR(n, 50, 3);
    run(2, push);
    EXPECT_EQ(arm_.sample.notice, DeviceNotice::drive_broken);
    arm_.board().faults().dead_drive = -1;
    expect_recovers();
}

TEST_F(Phantom, a_board_without_commands_turns_its_amplifier_off) {
    start();
    arm_.board().faults().deaf = true;
    EXPECT_LE(cycles_to_zero(30), 11);
    run(2, on_);
    expect_latched(DeviceNotice::watchdog_tripped);
    arm_.board().faults().deaf = false;
    expect_recovers();
}

TEST(PhantomBoards, a_board_five_commands_behind_for_ten_milliseconds_is_a_fault) {
    BoardSettings slow;
    slow.watchdog_ms = 100;
    LockstepPhantom arm(slow, {});
    const DeviceCommand on{.wrench_dev = {}, .enable = true};
    arm.open();
    for (int i = 0; i < 20; ++i) arm.cycle(on);
    ASSERT_EQ(arm.sample.state, DeviceState::powered);
    arm.board().faults().deaf = true;
    int n = 0;
    while (n < 200 && arm.cycle(on) != IoStatus::fault) ++n;
    EXPECT_NEAR(n, 16, 2);
    EXPECT_EQ(arm.sample.notice, DeviceNotice::commands_not_taken);
}

TEST_F(Phantom, after_replugging_it_needs_calibration_and_a_person) {
    start();
    arm_.bus().unplug();
    EXPECT_EQ(run(2, on_), IoStatus::lost);
    EXPECT_EQ(arm_.sample.state, DeviceState::closed);
    EXPECT_EQ(arm_.sample.notice, DeviceNotice::gone);
    run(500, on_);
    EXPECT_EQ(arm_.write_status, IoStatus::lost);
    arm_.bus().plug();
    run(4000, on_);  // calibrated again, enable stayed up
    EXPECT_EQ(arm_.bus().last_serial, "EMU-1");
    EXPECT_EQ(arm_.news().counts.reconnects, 1U);
    EXPECT_EQ(arm_.sample.bus.reconnects, 1U);
    EXPECT_EQ(arm_.device().calibration(), CalibrationState::done);
    expect_latched(DeviceNotice::gone);
    expect_recovers();
}

TEST_F(Phantom, a_board_that_restarts_needs_calibration_again) {
    start();
    arm_.board().restart(static_cast<std::uint32_t>(to_ns(arm_.bus().now()) / 1000));
    run(3000, on_);
    EXPECT_EQ(arm_.news().info.boot, 2);
    expect_latched(DeviceNotice::silent);
    expect_recovers();
}

TEST_F(Phantom, a_stall_is_cleared_without_lasting_fault) {
    start();
    arm_.bus().stalls = 1;
    run(50, on_);
    EXPECT_EQ(arm_.bus().stalls_cleared, 1U);
    EXPECT_EQ(arm_.news().counts.stalls, 1U);
    EXPECT_EQ(arm_.sample.bus.stalls, 1U);
    EXPECT_EQ(run(1, on_), IoStatus::ok);
}

TEST_F(Phantom, an_out_transfer_that_fails_or_hangs_ends_in_zero_force) {
    start();
    arm_.bus().send_fails = 3;
    run(5, on_);
    EXPECT_EQ(arm_.news().counts.transfers_failed, 3U);
    EXPECT_EQ(arm_.sample.state, DeviceState::powered);
    arm_.bus().out_hangs = true;
    EXPECT_LE(cycles_to_zero(30), 11);
    run(2, on_);
    expect_latched(DeviceNotice::watchdog_tripped);
}

TEST_F(Phantom, relax_removes_the_current_within_a_packet_until_enable_has_fallen) {
    start();
    arm_.relax();
    arm_.device().pump().round(Duration{0});
    EXPECT_NE(arm_.board().amplifier().state(), phantom::AmplifierState::on);
    run(50, on_);
    EXPECT_NE(arm_.board().amplifier().state(), phantom::AmplifierState::on);
    EXPECT_EQ(arm_.sample.notice, DeviceNotice::none);
    expect_recovers();
}

TEST_F(Phantom, warm_motors_get_less_current_and_never_reach_their_limit) {
    start();
    const DeviceCommand push{.wrench_dev = {Vec3(0.0, 8.0, 0.0), Vec3::Zero()}, .enable = true};
    for (int i = 0; i < 60'000; ++i) {
        arm_.cycle(push);
        ASSERT_EQ(arm_.sample.state, DeviceState::powered) << i;
    }
    EXPECT_GT(arm_.board().hottest_c(), 80.0);
    EXPECT_LT(arm_.board().hottest_c(), 100.5);
    // The driver estimates the same temperature and reports it.
    EXPECT_NEAR(static_cast<double>(arm_.sample.winding_c), arm_.board().hottest_c(), 5.0);
    EXPECT_FLOAT_EQ(arm_.sample.winding_c_max, 100.0F);
}

TEST_F(Phantom, a_non_finite_wrench_gives_only_gravity_compensation) {
    start();
    run(5, {.wrench_dev = {Vec3(1e300, -1e300, 1e300), Vec3::Constant(1e300)}, .enable = true});
    EXPECT_LT(arm_.board().shown().force_n.norm(), 8.6);
    run(5, {.wrench_dev = {Vec3(NAN, 0.0, 0.0), Vec3::Zero()}, .enable = true});
    EXPECT_LT(arm_.board().shown().force_n.norm(), 0.02);
}

TEST(PhantomOpen, errors_give_a_fix) {
    struct Row {
        BusFault fault;
        const char* detail;
        const char* said;
    };
    for (const Row& row :
         {Row{BusFault::missing, "B-7", "B-7"}, Row{BusFault::several, "A-1, A-2", "A-1, A-2"},
          Row{BusFault::denied, "/dev/bus/usb/001/004", "deploy/install.sh"},
          Row{BusFault::twins, "", "its own serial number"}, Row{BusFault::slow, "", "high-speed"},
          Row{BusFault::busy, "", "another program"}}) {
        LockstepPhantom arm;
        arm.bus().finding = row.fault;
        arm.bus().detail = row.detail;
        try {
            arm.device().open();
            ADD_FAILURE() << "the board was opened";
        } catch (const StartupError& e) {
            EXPECT_NE(std::string(e.what()).find(row.said), std::string::npos) << e.what();
        }
    }
}

std::vector<std::string>& heard() {
    static std::vector<std::string> all;
    return all;
}

TEST(PhantomOpen, open_waits_for_a_board_being_plugged_in_and_reports_it_once) {
    PhantomUsbSettings settings = emu::usual<PhantomUsbSettings>();
    settings.serial = "EMU-1";
    settings.say = [](const char* text) { heard().emplace_back(text); };
    for (const BusFault fault : {BusFault::missing, BusFault::denied, BusFault::busy, BusFault::not_ready}) {
        LockstepPhantom arm(emu::usual<BoardSettings>(), settings);
        arm.bus().finding = fault;
        arm.bus().finds = 20;
        heard().clear();
        EXPECT_EQ(arm.device().open().serial, "EMU-1");
        EXPECT_EQ(arm.bus().opens, 21U);
        ASSERT_EQ(heard().size(), 1U);
        EXPECT_NE(heard()[0].find("waiting up to 5 s for the arm's USB board EMU-1: "), std::string::npos)
            << heard()[0];
    }
}

TEST(PhantomOpen, a_missing_board_is_refused_after_a_bounded_time) {
    LockstepPhantom arm;
    arm.bus().finding = BusFault::missing;
    const Instant begin = arm.bus().now();
    EXPECT_THROW(arm.device().open(), StartupError);
    EXPECT_GE(arm.bus().now() - begin, PhantomUsb::kFindMax);
    EXPECT_LT(arm.bus().now() - begin, PhantomUsb::kFindMax + std::chrono::seconds(1));
}

TEST(PhantomOpen, permanent_faults_are_refused_at_once) {
    for (const BusFault fault : {BusFault::several, BusFault::twins, BusFault::slow, BusFault::failed}) {
        LockstepPhantom arm;
        arm.bus().finding = fault;
        EXPECT_THROW(arm.device().open(), StartupError);
        EXPECT_EQ(arm.bus().opens, 1U);
    }
}

TEST(PhantomOpen, a_board_not_configured_yet_is_tried_again) {
    LockstepPhantom arm;
    arm.bus().finding = BusFault::not_ready;
    EXPECT_THROW(arm.device().open(), StartupError);
    EXPECT_GT(arm.bus().opens, 10U);
}

TEST(PhantomOpen, a_board_that_does_not_answer_is_refused) {
    LockstepPhantom arm;
    arm.board().faults().frozen = true;
    EXPECT_THROW(arm.device().open(), StartupError);
}

TEST(PhantomOpen, a_missing_answer_is_reported_with_the_packets_received) {
    LockstepPhantom arm;
    arm.board().faults().frozen = true;
    const std::array<std::byte, 65> glued{};
    for (int i = 0; i < 7; ++i) arm.bus().push(usb::BusEventKind::packet, glued);
    try {
        arm.device().open();
        ADD_FAILURE() << "the board was opened";
    } catch (const StartupError& e) {
        EXPECT_NE(std::string(e.what()).find("answers 0"), std::string::npos) << e.what();
        EXPECT_NE(std::string(e.what()).find("7 size"), std::string::npos) << e.what();
    }
}

TEST(PhantomOpen, a_watchdog_time_above_the_limit_is_refused) {
    BoardSettings patient;
    patient.watchdog_ms = 3000;
    EXPECT_THROW(LockstepPhantom(patient, {}).device().open(), StartupError);
    PhantomUsbSettings allowed;
    allowed.watchdog_max = std::chrono::seconds(3);
    EXPECT_NO_THROW(LockstepPhantom(patient, allowed).device().open());
}

TEST(PhantomOpen, a_board_with_another_serial_than_its_descriptor_is_refused) {
    LockstepPhantom arm;
    arm.bus().usb_serial = "OTHER";
    EXPECT_THROW(arm.device().open(), StartupError);
}

}  // namespace
}  // namespace tact
