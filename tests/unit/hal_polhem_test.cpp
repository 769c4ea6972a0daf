// Haptikfabriken and Polhem boards: their reports, and the driver of hal/phantom on them with an emulated arm.
#include "hal/polhem/hidraw_port.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <sys/socket.h>
#include <unistd.h>

#include "ipc/base/error.hpp"
#include "tests/contract/haptic_device_contract.hpp"
#include "tests/support/polhem_board.hpp"

namespace tact {
namespace {

using emu::LockstepPolhem;
using std::chrono::milliseconds;
using usb::BusFault;

INSTANTIATE_TEST_SUITE_P(Polhem, HapticDeviceContract,
                         testing::Values(DeviceCase{"polhem",
                                                    [] { return std::make_unique<LockstepPolhem>(); },
                                                    [](Instant now, Duration d) { return now + d; }}),
                         [](const auto& tested) { return tested.param.name; });

std::vector<std::byte> bytes(std::initializer_list<int> values) {
    std::vector<std::byte> out;
    for (const int v : values) out.push_back(static_cast<std::byte>(v));
    return out;
}

TEST(PolhemReports, match_the_documented_format) {
    const polhem::OutReport out{{-3000, 1, 256}, 0, {0, 0, 7}};
    const auto wire = polhem::encode(out);
    const auto expected = bytes({0x48, 0xF4, 0x01, 0x00, 0x00, 0x01, 0, 0, 0, 0, 0, 0, 7, 0});
    EXPECT_TRUE(std::equal(wire.begin(), wire.end(), expected.begin(), expected.end()));
    polhem::InReport in;
    ASSERT_TRUE(polhem::decode(bytes({1, 0, 0xFF, 0xFF, 0, 0x80, 0xFF, 0x7F, 0, 0, 2, 1, 3, 0x80}), in));
    EXPECT_EQ(in.encoder, (std::array<std::int16_t, 6>{1, -1, -32768, 32767, 0, 258}));
    EXPECT_EQ(in.info, 0x8003);
    EXPECT_FALSE(polhem::decode(std::vector<std::byte>(13), in));
    EXPECT_FALSE(polhem::decode(std::vector<std::byte>(65), in));
    EXPECT_TRUE(polhem::decode(std::vector<std::byte>(64), in));
    EXPECT_EQ(in, polhem::InReport{});
}

TEST(PolhemReports, round_trip_through_encode_and_decode) {
    EXPECT_TRUE(rc::check([](std::array<std::int16_t, 6> six, std::uint16_t info) {
        const polhem::InReport in{six, info};
        polhem::InReport in_again;
        RC_ASSERT(polhem::decode(polhem::encode(in), in_again));
        RC_ASSERT(in == in_again);
        const polhem::OutReport out{{six[0], six[1], six[2]}, six[3], {six[4], six[5], six[0]}};
        polhem::OutReport out_again;
        RC_ASSERT(polhem::decode(polhem::encode(out), out_again));
        RC_ASSERT(out == out_again);
    }));
}

TEST(PolhemReports, counts_continue_across_the_wrap_of_an_encoder) {
    polhem::Unwrapped u;
    const std::int32_t first = 32000;
    std::int32_t way = 0;
    for (int i = 0; i < 2000; ++i) {
        const auto low = static_cast<std::int16_t>(static_cast<std::uint16_t>(first + way));
        ASSERT_EQ(u.push({low, 0, 0, 0, 0, 0})[0], first + way) << i;
        way += i < 1000 ? 911 : -1733;
    }
}

class Polhem : public testing::Test {
protected:
    void start() {
        info_ = arm_.open();
        run(20, on_);
        ASSERT_EQ(arm_.sample.state, DeviceState::powered) << device_notice_text(arm_.sample.notice);
    }
    void run(int cycles, const DeviceCommand& command) {
        for (int i = 0; i < cycles; ++i) arm_.cycle(command);
    }
    [[nodiscard]] bool powerless() { return arm_.port().current_ma == std::array<std::int16_t, 3>{}; }

    LockstepPolhem arm_;
    DeviceInfo info_;
    const DeviceCommand on_{.wrench_dev = {Vec3(0.0, 0.0, 0.3), Vec3::Zero()}, .enable = true};
};

TEST_F(Polhem, is_calibrated_by_a_person_and_then_gives_the_pose_of_the_hand) {
    start();
    EXPECT_EQ(info_.serial, "PH-1");
    EXPECT_NE(info_.name.find("Haptikfabriken"), std::string::npos);
    run(100, on_);
    EXPECT_LT((arm_.sample.T_dev_tool.p_m - arm_.port().board().tool_pose().p_m).norm(), 2e-4);
    EXPECT_EQ(arm_.port().command, 0);
}

TEST_F(Polhem, force_has_the_requested_direction_and_size) {
    start();
    for (const Vec3& f : {Vec3(0.5, 0.0, 0.0), Vec3(0.0, 0.5, 0.0), Vec3(0.0, 0.0, -0.5)}) {
        run(5, {.wrench_dev = {f, Vec3::Zero()}, .enable = true});
        EXPECT_LT((arm_.port().board().shown().force_n - f).norm(), 0.03) << f.transpose();
    }
}

TEST_F(Polhem, currents_never_exceed_the_board_limit) {
    start();
    for (int i = 0; i < 30; ++i) {
        arm_.cycle({.wrench_dev = {Vec3(100.0, 100.0, -100.0), Vec3::Zero()}, .enable = true});
        for (const std::int16_t ma : arm_.port().current_ma)
            ASSERT_LE(std::abs(int{ma}), int{polhem::PolhemBus::kCurrentMaxMa});
    }
}

TEST_F(Polhem, ten_milliseconds_without_the_servo_give_zero_force_before_the_board_watchdog) {
    start();
    run(3, on_);
    ASSERT_FALSE(powerless());
    for (int i = 0; i < 13; ++i) arm_.pass(milliseconds(1));
    EXPECT_TRUE(powerless());
    // The board would accept force again; the driver gives none until a new edge.
    run(700, on_);
    EXPECT_TRUE(powerless());
    run(20, {});
    run(20, on_);
    EXPECT_FALSE(powerless());
}

TEST_F(Polhem, a_replugged_board_returns_without_force_and_uncalibrated) {
    start();
    arm_.port().plugged = false;
    run(300, on_);
    EXPECT_TRUE(arm_.cycle(on_) == IoStatus::lost || arm_.cycle(on_) == IoStatus::fault);
    arm_.port().plugged = true;
    arm_.port().current_ma = {};
    run(1000, on_);
    EXPECT_TRUE(powerless());
    run(50, {});
    EXPECT_EQ(arm_.sample.notice, DeviceNotice::hold_reset_pose) << device_notice_text(arm_.sample.notice);
    run(50, on_);
    EXPECT_TRUE(powerless());
}

TEST_F(Polhem, a_board_that_sends_or_accepts_nothing_is_a_fault) {
    start();
    arm_.port().silent = true;
    run(20, on_);
    EXPECT_TRUE(powerless());
    EXPECT_NE(arm_.sample.notice, DeviceNotice::none);
    arm_.port().silent = false;
    run(50, {});
    run(20, on_);
    EXPECT_FALSE(powerless());
    arm_.port().deaf = true;
    run(300, on_);
    EXPECT_NE(arm_.sample.notice, DeviceNotice::none);
    EXPECT_GT(arm_.bus().counts().write_failed, 0U);
}

TEST_F(Polhem, reports_of_another_size_are_refused_and_counted) {
    start();
    const DeviceSample before = arm_.sample;
    for (int i = 0; i < 5; ++i) {
        arm_.port().reports.emplace_front(3, std::byte{0xFF});
        arm_.cycle(on_);
    }
    EXPECT_EQ(arm_.bus().counts().refused, 5U);
    EXPECT_EQ(arm_.sample.state, DeviceState::powered);
    EXPECT_LT((arm_.sample.T_dev_tool.p_m - before.T_dev_tool.p_m).norm(), 2e-3);
}

TEST_F(Polhem, an_encoder_that_jumps_drops_the_force) {
    start();
    arm_.port().board().faults().jump.fill(3000);
    run(5, on_);
    EXPECT_TRUE(powerless());
    EXPECT_EQ(arm_.sample.notice, DeviceNotice::encoder_jumped) << device_notice_text(arm_.sample.notice);
}

probe::UsbDevice board_of(const std::string& serial) {
    probe::UsbDevice d;
    d.vendor = polhem::kVendor;
    d.product = polhem::kProduct;
    d.serial = serial;
    d.nodes = {{"/dev/hidraw3", true, "tact", 0660}, {"/dev/hidraw4", true, "tact", 0660}};
    return d;
}

TEST(PolhemHidraw, the_board_is_found_by_usb_ids_and_serial_on_its_first_interface) {
    probe::Bus<probe::UsbDevice> usb;
    std::string node;
    EXPECT_EQ(polhem::find_board(usb, "", node).fault, BusFault::missing);
    EXPECT_NE(polhem::find_board(usb, "", node).detail.find("no USB"), std::string::npos);
    usb.visible = true;
    usb.entries = {board_of("A"), probe::UsbDevice{}};
    const usb::BusFinding one = polhem::find_board(usb, "", node);
    EXPECT_EQ(one.fault, BusFault::none);
    EXPECT_EQ(one.serial, "A");
    EXPECT_EQ(node, "/dev/hidraw3");
    usb.entries.push_back(board_of("B"));
    EXPECT_EQ(polhem::find_board(usb, "", node).fault, BusFault::several);
    EXPECT_EQ(polhem::find_board(usb, "B", node).serial, "B");
    EXPECT_EQ(polhem::find_board(usb, "C", node).fault, BusFault::missing);
    EXPECT_EQ(polhem::find_board(usb, "C", node).detail, "A, B");
    usb.entries.push_back(board_of("B"));
    EXPECT_EQ(polhem::find_board(usb, "B", node).fault, BusFault::twins);
    usb.entries = {board_of("")};
    usb.entries[0].nodes.clear();
    EXPECT_EQ(polhem::find_board(usb, "", node).fault, BusFault::not_ready);
    usb.entries = {board_of("")};
    EXPECT_EQ(polhem::find_board(usb, "", node).serial, "no serial");
}

TEST(PolhemHidraw, reports_pass_a_descriptor_and_its_end_is_reported) {
    int ends[2];
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends), 0);
    {
        polhem::HidrawPort port(ends[0]);
        std::array<std::byte, 65> into{};
        EXPECT_EQ(port.read(into, Duration{0}), 0);
        const auto in = polhem::encode(polhem::InReport{{1, 2, 3, 4, 5, 6}, 1});
        ASSERT_EQ(send(ends[1], in.data(), in.size(), 0), 14);
        EXPECT_EQ(port.read(into, std::chrono::seconds(30)), 14);
        EXPECT_TRUE(std::equal(in.begin(), in.end(), into.begin()));
        const auto out = polhem::encode(polhem::OutReport{{9, 8, 7}, 0, {}});
        EXPECT_TRUE(port.write(out));
        ASSERT_EQ(recv(ends[1], into.data(), into.size(), 0), 15);
        EXPECT_EQ(into[0], std::byte{0});  // report number
        EXPECT_TRUE(std::equal(out.begin(), out.end(), into.begin() + 1));
        close(ends[1]);
        EXPECT_EQ(port.read(into, std::chrono::seconds(30)), polhem::kPortGone);
    }
    polhem::HidrawPort nowhere("/nowhere");
    EXPECT_EQ(nowhere.open("").fault, BusFault::missing);
    EXPECT_FALSE(nowhere.write({}));
}

}  // namespace
}  // namespace tact
