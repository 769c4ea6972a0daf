// The driver of the Falcon on an emulated device: the contract, the reference marks, faults, and the thread.
#include "hal/falcon/falcon.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "ipc/base/error.hpp"
#include "tests/contract/haptic_device_contract.hpp"
#include "tests/support/falcon_board.hpp"

namespace tact {
namespace {

using emu::FalconBoard;
using emu::LockstepFalcon;
using falcon::Link;
using std::chrono::milliseconds;

INSTANTIATE_TEST_SUITE_P(Falcon, HapticDeviceContract,
                         testing::Values(DeviceCase{"falcon",
                                                    [] { return std::make_unique<LockstepFalcon>(); },
                                                    [](Instant now, Duration d) { return now + d; }}),
                         [](const auto& tested) { return tested.param.name; });

std::vector<std::byte> bytes(const std::string& s) {
    std::vector<std::byte> out;
    for (const char c : s) out.push_back(static_cast<std::byte>(c));
    return out;
}

class FalconArm : public testing::Test {
protected:
    void start() {
        info_ = arm_.open();
        run(20, on_);
        ASSERT_EQ(arm_.sample.state, DeviceState::powered) << device_notice_text(arm_.sample.notice);
        ASSERT_FALSE(powerless());
    }
    void run(int cycles, const DeviceCommand& command) {
        for (int i = 0; i < cycles; ++i) arm_.cycle(command);
    }
    [[nodiscard]] bool powerless() { return board().torque == falcon::Torque3{}; }
    [[nodiscard]] FalconBoard& board() { return arm_.board(); }
    // A person lowers enable and raises it again.
    void rearm() {
        run(20, {});
        run(20, on_);
    }

    LockstepFalcon arm_;
    DeviceInfo info_;
    const DeviceCommand on_{.wrench_dev = {Vec3(0.0, 0.0, 0.2), Vec3::Zero()}, .enable = true};
};

TEST_F(FalconArm, without_its_marks_it_requests_motion_and_shows_no_force) {
    info_ = arm_.open_only();
    EXPECT_EQ(info_.serial, "FA-1");
    EXPECT_EQ(info_.torque_n_m_max, 0.0);
    run(20, {});
    for (std::uint8_t some = 0; some < falcon::kHomedAll; ++some) {
        board().homed = some;
        run(20, {});
        run(20, on_);
        EXPECT_TRUE(powerless());
        EXPECT_EQ(arm_.sample.notice, DeviceNotice::move_about);
        EXPECT_FALSE(arm_.sample.hand_present);
        EXPECT_EQ(arm_.sample.T_dev_tool.p_m, Vec3(Vec3::Zero()));
        EXPECT_EQ(board().leds, falcon::led::kRed);
    }
    // An enable that was up all the time is not an edge.
    board().push_through();
    run(20, on_);
    EXPECT_TRUE(powerless());
    EXPECT_EQ(board().leds, falcon::led::kBlue);
    rearm();
    EXPECT_FALSE(powerless());
    EXPECT_TRUE(arm_.sample.hand_present);
    EXPECT_EQ(board().leds, falcon::led::kGreen);
}

TEST_F(FalconArm, gives_position_and_speed_of_the_grip) {
    start();
    for (int i = 0; i < 60; ++i) {
        const Vec3 before = board().grip_m();
        run(1, {.wrench_dev = {Vec3(0.5, -0.3, 0.4), Vec3::Zero()}, .enable = true});
        // A reply has the position of up to a cycle ago.
        const double way = (board().grip_m() - before).norm();
        EXPECT_LT((arm_.sample.T_dev_tool.p_m - board().grip_m()).norm(), 2.0 * way + 1e-4);
    }
    const Vec3 here = arm_.sample.T_dev_tool.p_m, then = board().grip_m();
    run(20, {.wrench_dev = {Vec3(0.5, -0.3, 0.4), Vec3::Zero()}, .enable = true});
    const Vec3 speed = (board().grip_m() - then) / 0.02;
    EXPECT_NE(here, arm_.sample.T_dev_tool.p_m);
    EXPECT_LT((arm_.sample.twist_dev.linear_m_s - speed).norm(), 0.2 * speed.norm() + 0.01);
    EXPECT_EQ(arm_.sample.twist_dev.angular_rad_s, Vec3(Vec3::Zero()));
}

TEST_F(FalconArm, force_has_the_requested_direction_and_size) {
    start();
    for (const Vec3& f : {Vec3(0.5, 0.0, 0.0), Vec3(0.0, 0.5, 0.0), Vec3(0.0, 0.0, -0.5)}) {
        run(5, {.wrench_dev = {f, Vec3(9.0, 9.0, 9.0)}, .enable = true});
        EXPECT_LT((board().force_n() - f).norm(), 0.03) << f.transpose();
    }
}

TEST_F(FalconArm, torque_never_exceeds_the_motor_limit) {
    start();
    for (int i = 0; i < 30; ++i) {
        arm_.cycle(
            {.wrench_dev = {Vec3(i % 2 == 0 ? 100.0 : -100.0, 100.0, -100.0), Vec3::Zero()}, .enable = true});
        for (const std::int16_t t : board().torque) ASSERT_LE(std::abs(int{t}), int{falcon::kTorqueMax});
    }
}

TEST_F(FalconArm, buttons_are_reported_with_the_middle_one_as_clutch) {
    start();
    for (const auto& [of_reply, of_sample] :
         {std::pair{0U, 0U}, std::pair{4U, 1U}, std::pair{1U, 2U}, std::pair{2U, 4U}, std::pair{8U, 8U}}) {
        board().buttons = static_cast<std::uint8_t>(of_reply);
        run(3, on_);
        EXPECT_EQ(arm_.sample.buttons, of_sample);
    }
}

TEST_F(FalconArm, the_delay_lasts_until_the_second_reply) {
    start();
    run(20, on_);
    EXPECT_EQ(arm_.sample.delay, milliseconds(2));
}

TEST_F(FalconArm, ten_milliseconds_without_the_servo_give_zero_force_until_a_new_edge) {
    start();
    for (int i = 0; i < 8; ++i) arm_.pass(milliseconds(1));
    EXPECT_FALSE(powerless());
    for (int i = 0; i < 4; ++i) arm_.pass(milliseconds(1));
    EXPECT_TRUE(powerless());
    run(50, on_);
    EXPECT_TRUE(powerless());
    EXPECT_EQ(arm_.sample.notice, DeviceNotice::watchdog_tripped);
    rearm();
    EXPECT_FALSE(powerless());
}

TEST_F(FalconArm, a_zero_is_sent_without_waiting_for_a_reply) {
    start();
    board().reply_after = milliseconds(6);
    arm_.cycle(on_);
    const unsigned before = board().requests;
    arm_.cycle(on_);
    ASSERT_EQ(board().requests, before);  // a request is pending
    arm_.relax();
    arm_.pass(milliseconds(1));
    EXPECT_TRUE(powerless());
    EXPECT_EQ(board().requests, before + 1);
}

TEST_F(FalconArm, corrupt_replies_are_counted_and_change_neither_position_nor_force) {
    start();
    run(20, {});
    const Vec3 before = arm_.sample.T_dev_tool.p_m;
    const std::string good = "<AAAAAAAAAAAAAA>";
    std::uint64_t bad = arm_.news().counts.bad();
    for (std::string text : {std::string(), std::string("<"), good.substr(0, 13) + ">", good.substr(1),
                             std::string(62, '<'), std::string(62, '\xFF'),
                             std::string("<AAAAAAAAAAAA\x20"
                                         "A>"),
                             std::string("<AAAAAAAAAAAAAAA"), std::string("<QAAAAAAAAAAAAA>")}) {
        board().instead = bytes(text);
        board().instead_set = true;
        arm_.cycle({});
        EXPECT_LT((arm_.sample.T_dev_tool.p_m - before).norm(), 2e-3) << text;
        run(25, {});
        EXPECT_GT(arm_.news().counts.bad(), bad) << text;
        bad = arm_.news().counts.bad();
        EXPECT_EQ(arm_.news().link, Link::open) << text;
    }
    rearm();
    EXPECT_FALSE(powerless());
}

// Packets have no checksum, so a digit may change into another valid one.
TEST_F(FalconArm, a_valid_packet_with_impossible_counts_is_ignored) {
    start();
    run(20, {});
    const Vec3 before = arm_.sample.T_dev_tool.p_m;
    for (int i = 0; i < 10; ++i) {
        falcon::Reply wild;
        wild.homed = falcon::kHomedAll;
        wild.counts = {1500, -1500, static_cast<std::int16_t>(i % 2 == 0 ? 1500 : 32767)};
        const auto packet = encode(wild);
        board().instead.assign(packet.begin(), packet.end());
        board().instead_set = true;
        arm_.cycle({});
        arm_.cycle({});
        EXPECT_LT((arm_.sample.T_dev_tool.p_m - before).norm(), 2e-3);
        run(3, {});
    }
    EXPECT_EQ(arm_.news().counts.far, 10U);
    EXPECT_EQ(arm_.news().counts.jumps, 0U);
    rearm();
    EXPECT_FALSE(powerless());
}

TEST_F(FalconArm, persistent_impossible_counts_are_a_jump_that_drops_the_force) {
    start();
    board().shift = {400, -300, 350};
    run(30, on_);
    EXPECT_TRUE(powerless());
    EXPECT_EQ(arm_.sample.notice, DeviceNotice::encoder_jumped) << device_notice_text(arm_.sample.notice);
    EXPECT_EQ(arm_.news().counts.jumps, 1U);
    run(100, on_);
    EXPECT_TRUE(powerless());
    // Without firmware to reload, the driver cannot restart it: marks stay invalid until the device has lost them.
    rearm();
    EXPECT_TRUE(powerless());
    EXPECT_EQ(arm_.sample.notice, DeviceNotice::move_about);
    board().homed = 0;
    run(5, on_);
    board().shift = {};
    board().push_through();
    rearm();
    EXPECT_FALSE(powerless());
}

TEST_F(FalconArm, impossible_combinations_of_counts_are_lost_counts) {
    start();
    run(30, {});
    // Each leg moves at a possible speed, into a combination that the legs cannot have.
    for (int i = 0; i < 60; ++i) {
        board().shift = {static_cast<std::int16_t>(-40 * i), static_cast<std::int16_t>(40 * i),
                         static_cast<std::int16_t>(40 * i)};
        run(1, on_);
        EXPECT_TRUE(arm_.sample.T_dev_tool.finite());
    }
    EXPECT_EQ(arm_.news().counts.jumps, 0U);
    EXPECT_TRUE(powerless());
    EXPECT_EQ(arm_.sample.notice, DeviceNotice::count_lost) << device_notice_text(arm_.sample.notice);
    EXPECT_FALSE(arm_.sample.hand_present);
}

TEST_F(FalconArm, lost_marks_drop_the_force_until_found_again_and_re_armed) {
    start();
    board().homed = 5;
    run(3, on_);
    EXPECT_TRUE(powerless());
    EXPECT_EQ(arm_.sample.notice, DeviceNotice::count_lost);
    rearm();
    EXPECT_TRUE(powerless());
    EXPECT_EQ(arm_.sample.notice, DeviceNotice::move_about);
    board().push_through();
    rearm();
    EXPECT_FALSE(powerless());
}

TEST_F(FalconArm, silence_drops_the_force_and_the_request_is_repeated) {
    start();
    board().mute = true;
    run(30, on_);
    EXPECT_EQ(arm_.sample.notice, DeviceNotice::silent);
    EXPECT_TRUE(powerless());  // it still receives
    EXPECT_GT(arm_.news().counts.late, 0U);
    board().mute = false;
    run(50, on_);
    EXPECT_TRUE(powerless());
    rearm();
    EXPECT_FALSE(powerless());
}

TEST_F(FalconArm, a_late_reply_is_not_taken_for_the_next_one) {
    start();
    run(20, {});
    board().late_bytes_survive = true;
    board().reply_after = milliseconds(10);
    run(30, {});
    board().reply_after = std::chrono::microseconds(700);
    run(30, {});
    EXPECT_GT(arm_.news().counts.late, 0U);
    EXPECT_GT(board().forgotten, 0U);
    board().say(encode(falcon::Reply{{100, 100, 100}, 15, falcon::kHomedAll}), Duration{1});
    board().say(encode(falcon::Reply{{100, 100, 100}, 15, falcon::kHomedAll}), Duration{2});
    arm_.pass(milliseconds(1));
    EXPECT_GT(arm_.news().counts.unasked, 0U);
}

TEST_F(FalconArm, after_replugging_it_returns_without_force_and_without_marks) {
    start();
    board().unplug();
    run(3, on_);
    EXPECT_EQ(arm_.cycle(on_), IoStatus::lost);
    EXPECT_EQ(arm_.write_status, IoStatus::lost);
    EXPECT_EQ(arm_.sample.notice, DeviceNotice::gone);
    EXPECT_EQ(arm_.sample.state, DeviceState::closed);
    run(500, on_);
    board().plug();
    board().runs = true;
    run(1500, on_);
    EXPECT_EQ(arm_.news().link, Link::open);
    EXPECT_EQ(arm_.news().counts.reconnects, 1U);
    EXPECT_TRUE(powerless());
    EXPECT_FALSE(arm_.sample.hand_present);
    rearm();
    EXPECT_TRUE(powerless());
    board().push_through();
    run(20, on_);
    EXPECT_TRUE(powerless());
    rearm();
    EXPECT_FALSE(powerless());
}

TEST_F(FalconArm, a_device_that_takes_no_requests_is_reopened) {
    start();
    board().deaf = true;
    run(1000, on_);
    EXPECT_NE(arm_.sample.notice, DeviceNotice::none);
    EXPECT_NE(arm_.news().link, Link::open);
    EXPECT_GT(arm_.news().counts.transfers_failed, 0U);
    board().deaf = false;
    run(5000, on_);
    EXPECT_EQ(arm_.news().link, Link::open);
    EXPECT_TRUE(powerless());
    rearm();
    EXPECT_FALSE(powerless());  // it kept its power, and so its marks
}

TEST_F(FalconArm, a_stall_is_cleared) {
    start();
    board().stall = true;
    run(20, on_);
    EXPECT_EQ(board().stalls_cleared, 1U);
    rearm();
    EXPECT_FALSE(powerless());
}

TEST_F(FalconArm, many_bad_packets_are_reported) {
    start();
    for (int i = 0; i < 1500; ++i) {
        if (i % 8 == 0) {
            board().instead = bytes("<AAAA>");
            board().instead_set = true;
        }
        arm_.cycle(on_);
    }
    run(30, {});
    EXPECT_EQ(arm_.sample.notice, DeviceNotice::states_refused);
    EXPECT_NE(summary(arm_.news().counts).find("refused: frame"), std::string::npos);
}

// With its own thread and the real clock: data between the threads, and the end of the thread.
TEST(FalconThread, reads_writes_relaxes_and_ends_while_the_pump_runs) {
    auto owned = std::make_unique<FalconBoard>();
    FalconBoard& board = *owned;
    board.push_through();
    board.run_in_real_time();
    FalconSettings settings;
    settings.pump_priority = 0;
    settings.hold_max = std::chrono::seconds(60);  // no timing of the test machine may matter
    auto device = std::make_unique<Falcon>(settings, std::move(owned));
    device->relax();
    static_cast<void>(device->open());
    std::atomic<bool> leave{false};
    std::thread other([&] {
        while (!leave.load()) {
            device->relax();
            std::this_thread::yield();
        }
    });
    DeviceSample sample;
    DeviceCommand command;
    const Instant end = Monotonic::now() + std::chrono::minutes(1);
    std::uint64_t first = 0;
    while (Monotonic::now() < end) {
        static_cast<void>(device->read(sample, Monotonic::now()));
        if (first == 0) first = sample.sequence;
        command.enable = !command.enable;
        ++command.heartbeat;
        static_cast<void>(device->write(command, Monotonic::now()));
        if (sample.hand_present && sample.sequence > first + 20) break;
        std::this_thread::sleep_for(std::chrono::microseconds(300));
    }
    leave.store(true);
    other.join();
    EXPECT_TRUE(sample.hand_present);
    EXPECT_GT(sample.sequence, first + 20);
    device.reset();
}

}  // namespace
}  // namespace tact
