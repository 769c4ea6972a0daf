// The emulated arm and its board, tested through their packets.
#include "tests/emu/board.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "hal/arm/arm_drive.hpp"

namespace tact::emu::emu_board_test {
namespace {

using phantom::AmplifierState;
using phantom::Order;
using phantom::PacketFault;

class Board : public testing::Test {
protected:
    explicit Board(bool ritual = false) : board_(with(ritual)) {}
    static BoardSettings with(bool ritual) {
        BoardSettings s;
        s.ritual = ritual;
        return s;
    }
    void ask() { board_.receive(encode(phantom::Query{}), now_us_); }
    // Returns all packets of `ms` milliseconds. Sends `command`, if given, before each.
    std::vector<phantom::State> run(int ms, phantom::Command* command = nullptr) {
        std::vector<phantom::State> states;
        for (int i = 0; i < ms; ++i) {
            if (command != nullptr) {
                ++command->sequence;
                ++command->heartbeat;
                board_.receive(encode(*command), now_us_);
            }
            now_us_ += 1000;
            board_.tick(now_us_);
            std::array<std::byte, 64> packet;
            std::size_t size = 0;
            while (board_.next_packet(packet, size)) {
                phantom::State s;
                const std::span<const std::byte> bytes = std::span(packet).first(size);
                const PacketFault fault = decode(bytes, s);
                if (fault == PacketFault::none)
                    states.push_back(s);
                else if (fault == PacketFault::kind || fault == PacketFault::version)
                    infos_ += 1;
                else
                    ++refused_;
            }
        }
        return states;
    }
    phantom::Command command(const Wrench& wrench, bool enable) const {
        Joint6 q;
        static_cast<void>(board_.arm().inverse(board_.tool_pose(), q));
        const ArmKinematics& arm = board_.arm();
        const DriveCurrents drive =
            drive_currents(arm, q, wrench, arm.gravity_n_m(q), arm.parameters().current_a_max);
        phantom::Command c{.enable = enable, .boot = 1};
        for (std::size_t i = 0; i < 6; ++i)
            c.current_ma[i] =
                static_cast<std::int16_t>(std::lround(drive.current_a[static_cast<Eigen::Index>(i)] * 1e3));
        return c;
    }

    std::uint32_t now_us_ = 0xFFFF'0000U;  // the clock wraps during the test
    EmulatedBoard board_;
    int infos_ = 0, refused_ = 0;
};

class BoardWithRitual : public Board {
protected:
    BoardWithRitual() : Board(true) {}
};

TEST_F(Board, sends_nothing_before_a_query_and_then_states_at_its_rate) {
    EXPECT_TRUE(run(20).empty());
    ask();
    const auto states = run(100);
    EXPECT_EQ(infos_, 1);
    ASSERT_EQ(states.size(), 100U);
    EXPECT_EQ(states.back().sequence - states.front().sequence, 99U);
    EXPECT_EQ(states.back().time_us - states.front().time_us, 99'000U);
}

TEST_F(Board, a_force_moves_the_hand_at_the_speed_that_its_damping_allows) {
    ask();
    phantom::Command off = command({}, false);
    run(2, &off);
    const Vec3 before = board_.tool_pose().p_m;
    phantom::Command c = command({{0.0, 1.0, 0.0}, Vec3::Zero()}, true);
    c.sequence = off.sequence;
    c.heartbeat = off.heartbeat;
    run(100, &c);
    EXPECT_EQ(board_.amplifier().state(), AmplifierState::on);
    // 1 N against 5 N s/m and 0.25 kg: x = F/b (t - m/b (1 - e^(-t b/m))) = 0.2 (0.1 - 0.05 * 0.8647) m.
    const Vec3 moved = board_.tool_pose().p_m - before;
    EXPECT_NEAR(moved.y(), 0.01135, 0.0006);
    EXPECT_NEAR(moved.x(), 0.0, 1e-3);
}

TEST_F(Board, with_the_amplifier_off_the_hand_holds_the_arm) {
    ask();
    run(200);
    EXPECT_EQ(board_.tool_pose().p_m, Vec3(Vec3::Zero()));
}

TEST_F(Board, silence_of_the_pc_trips_the_watchdog) {
    ask();
    phantom::Command c = command({}, false);
    run(2, &c);
    c.enable = true;
    run(5, &c);
    EXPECT_EQ(run(8).back().status & phantom::status::kWatchdogTripped, 0);
    EXPECT_NE(run(5).back().status & phantom::status::kWatchdogTripped, 0);
    EXPECT_EQ(board_.shown().force_n, Vec3(Vec3::Zero()));
}

TEST_F(Board, faults_of_the_link_occur_as_injected) {
    ask();
    run(5);
    board_.faults().corrupt = 3;
    EXPECT_EQ(run(10).size(), 7U);
    EXPECT_EQ(refused_, 3);
    board_.faults().repeat = 2;
    EXPECT_EQ(run(10).size(), 12U);
    board_.faults().drop = 2;
    EXPECT_EQ(run(10).size(), 8U);
    board_.faults().reorder = 1;
    const auto states = run(10);
    ASSERT_EQ(states.size(), 10U);
    EXPECT_EQ(states[0].sequence, states[1].sequence + 1);
    board_.faults().frozen = true;
    EXPECT_TRUE(run(10).empty());
}

TEST_F(Board, faults_of_the_arm_appear_in_its_states) {
    ask();
    const Counts6 before = run(2).back().counts;
    board_.faults().jump[1] = 500;
    EXPECT_EQ(run(1).back().counts[1], before[1] + 500);
    board_.faults().causes = phantom::status::kBrownOut;
    EXPECT_NE(run(1).back().status & phantom::status::kBrownOut, 0);
    board_.restart(now_us_);
    EXPECT_TRUE(run(5).empty());
    ask();
    const phantom::State s = run(5).back();
    EXPECT_EQ(s.boot, 2);
    EXPECT_EQ(s.status & phantom::status::kBrownOut, phantom::status::kBrownOut);  // the cause persists
}

TEST_F(Board, a_stalled_motor_heats_up_and_the_board_reports_it) {
    ask();
    phantom::Command off = command({}, false);
    run(2, &off);
    phantom::Command c = off;
    c.enable = true;
    c.current_ma = {5500, 0, 0, 0, 0, 0};
    // 5.5 A in 2.18 ohm against 3.1 K/W and a time constant of 12 s: 17 K/s at first, 75 K after a few seconds.
    const auto states = run(8000, &c);
    EXPECT_NE(states.back().status & phantom::status::kOverTemperature, 0);
    EXPECT_EQ(board_.amplifier().state(), AmplifierState::fault);
    EXPECT_EQ(states[1000].status & phantom::status::kOverTemperature, 0);
}

TEST_F(BoardWithRitual, the_person_holds_the_reset_pose_confirms_and_moves_to_the_centre) {
    ask();
    const auto states = run(3000);
    int pressed = 0;
    for (const phantom::State& s : states) pressed += s.inputs & 1;
    EXPECT_NEAR(pressed, 200, 2);
    const Counts6 rest{1200, -340, 77, 0, 0, 0};
    for (std::size_t i = 0; i < 1190; ++i) {
        for (std::size_t j = 0; j < 3; ++j) ASSERT_NEAR(states[i].counts[j], rest[j], 1) << i;
    }
    EXPECT_TRUE(board_.hand_free());
    EXPECT_LT(board_.tool_pose().p_m.norm(), 1e-12);
}

TEST_F(BoardWithRitual, the_person_waits_for_a_query_and_repeats_the_calibration_on_request) {
    run(5000);
    EXPECT_FALSE(board_.hand_free()) << "no query yet";
    ask();
    run(3000);
    ASSERT_TRUE(board_.hand_free());
    const Counts6 free = run(1).back().counts;
    board_.calibrate_again();
    EXPECT_FALSE(board_.hand_free());
    const auto back = run(1100);
    EXPECT_NEAR(back.front().counts[1], free[1], 2) << "the hand leads it there without a jump";
    EXPECT_NEAR(back.back().counts[1], -340, 1);
    int pressed = 0;
    for (const phantom::State& s : run(3000)) pressed += s.inputs & 1;
    EXPECT_NEAR(pressed, 200, 2);
    EXPECT_TRUE(board_.hand_free());
}

}  // namespace
}  // namespace tact::emu::emu_board_test
