// A pointer leads the emulated hand: smoothly, within bounds, and not for longer than its targets are fresh.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "hal/sim/sim_device.hpp"

namespace tact::hal_mouse_hand_test {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

class MouseHandTest : public testing::Test {
protected:
    explicit MouseHandTest(const char* script = "mouse") : device_(settings(script)) {
        info_ = device_.open();
        now_ += std::chrono::seconds(100);
    }
    SimSettings settings(const char* script) {
        SimSettings s;
        s.hand.script = script;
        s.mouse = &mailbox_;
        return s;
    }
    void send(const Vec3& at_m, const Quat& q = Quat::Identity(), std::uint32_t buttons = 0,
              bool holds = true) {
        MouseTarget t{};
        t.arrived_ns = to_ns(now_);
        for (int i = 0; i < 3; ++i) t.pos_dev_m[i] = at_m[i];
        for (int i = 0; i < 4; ++i) t.quat_dev_tool_xyzw[i] = q.coeffs()[i];
        t.buttons = buttons;
        t.holds = holds ? 1 : 0;
        mailbox_.publish(t);
    }
    // One millisecond of the servo, with this force on the hand.
    DeviceSample step(const Vec3& force_n = Vec3::Zero()) {
        now_ += milliseconds(1);
        DeviceSample sample;
        EXPECT_EQ(device_.read(sample, now_), IoStatus::ok);
        DeviceCommand command;
        command.enable = true;
        command.heartbeat = ++heartbeat_;
        command.wrench_dev.force_n = force_n;
        EXPECT_EQ(device_.write(command, now_), IoStatus::ok);
        return sample;
    }
    [[nodiscard]] Vec3 hand() const { return device_.hand_pose().p_m; }

    Latest<MouseTarget> mailbox_{};
    SimDevice device_;
    DeviceInfo info_;
    Instant now_{};
    std::uint64_t heartbeat_ = 0;
};

TEST_F(MouseHandTest, the_hand_rests_until_a_pointer_takes_it_and_then_comes_to_its_target) {
    for (int i = 0; i < 500; ++i) step();
    EXPECT_EQ(hand(), Vec3(Vec3::Zero()));
    const Vec3 there(0.05, -0.03, 0.02);
    const Quat turned(Eigen::AngleAxisd(0.8, Vec3(1.0, 2.0, -1.0).normalized()));
    for (int i = 0; i < 1500; ++i) {
        if (i % 17 == 0) send(there, turned);
        step();
    }
    EXPECT_LT((hand() - there).norm(), 1e-4);
    EXPECT_LT(turned.angularDistance(device_.hand_pose().q), 1e-3);
}

// A pointer that moves at 0.1 m/s, in 60 steps a second that arrive up to 10 ms late.
TEST_F(MouseHandTest, a_pointer_of_60_hz_moves_the_hand_at_the_rate_of_the_servo_without_steps) {
    constexpr double kSpeed = 0.1;
    std::mt19937_64 random(5);
    double next_ms = 0.0, least = 1.0, most = 0.0, roughest = 0.0, before = kSpeed;
    for (int i = 0; i < 1000; ++i) {
        if (i >= next_ms) {
            send({-0.05 + kSpeed * 1e-3 * i, 0.0, 0.0});
            next_ms =
                1000.0 / 60.0 * std::ceil((i + 1) * 0.06) + 10.0 * 0x1p-64 * static_cast<double>(random());
        }
        const Vec3 from = hand();
        step();
        if (i < 400) continue;
        const double speed = (hand() - from).x() / 1e-3;
        least = std::min(least, speed);
        most = std::max(most, speed);
        if (i > 400) roughest = std::max(roughest, std::abs(speed - before));
        before = speed;
    }
    EXPECT_GT(least, 0.85 * kSpeed);
    EXPECT_LT(most, 1.15 * kSpeed);
    EXPECT_LT(roughest, 0.02 * kSpeed);  // in a millisecond; the pointer itself moves by 16 steps at once
    EXPECT_NEAR(hand().x(), -0.05 + kSpeed, 0.012);  // and is not far behind
}

TEST_F(MouseHandTest, whatever_the_pointer_does_speed_acceleration_and_pull_stay_bounded) {
    std::mt19937_64 random(7);
    const auto uniform = [&](double least, double most) {
        return least + (most - least) * 0x1p-64 * static_cast<double>(random());
    };
    MouseHand mouse(Vec3(0.19, 0.13, 0.09));
    Vec3 before = Vec3::Zero();
    for (int i = 0; i < 20000; ++i) {
        now_ += milliseconds(1);
        MouseTarget t{};
        t.arrived_ns = to_ns(now_);
        for (double& p : t.pos_dev_m) p = uniform(-1.0, 1.0);
        const Quat q(Eigen::AngleAxisd(uniform(-3.1, 3.1), Vec3::Random().normalized()));
        for (int k = 0; k < 4; ++k) t.quat_dev_tool_xyzw[k] = q.coeffs()[k];
        t.holds = 1;
        if (i % 50 == 0) mouse.follow(t, now_, {}, {});
        mouse.step(1e-3);
        const Vec3 v = mouse.target_motion().linear_m_s;
        ASSERT_LE(v.norm(), MouseHand::kSpeedMost * 1.001);
        ASSERT_LE(mouse.target_motion().angular_rad_s.norm(), MouseHand::kTurnMost * 1.001);
        ASSERT_LE((v - before).norm() / 1e-3, 4.0 * MouseHand::kResponse * MouseHand::kSpeedMost);
        before = v;
        for (int k = 0; k < 3; ++k)
            ASSERT_LE(std::abs(mouse.target().p_m[k]), Vec3(0.19, 0.13, 0.09)[k] + 1e-9);
        const Wrench w = mouse.pull({Vec3(uniform(-9, 9), 0, 0), Quat::UnitRandom()}, {});
        ASSERT_LE(w.force_n.norm(), MouseHand::kForceMost * 1.001);
        ASSERT_LE(w.torque_n_m.norm(), MouseHand::kTorqueMost * 1.001);
    }
}

TEST_F(MouseHandTest, a_force_holds_the_tool_back_behind_the_pointer) {
    for (int i = 0; i < 1000; ++i) {
        if (i % 17 == 0) send(Vec3::Zero());
        step({0.0, 1.5, 0.0});
    }
    EXPECT_NEAR(hand().y(), 1.5 / MouseHand::kStiffness, 2e-4);
}

TEST_F(MouseHandTest, a_pointer_that_falls_silent_lets_go_within_a_quarter_of_a_second) {
    for (int i = 0; i < 600; ++i) {
        if (i % 17 == 0) send({0.04, 0.0, 0.0}, Quat::Identity(), 2);
        step();
    }
    const Vec3 held = hand();
    EXPECT_EQ(step().buttons, 2U);
    for (int i = 0; i < 260; ++i) step();
    EXPECT_EQ(step().buttons, 0U);
    EXPECT_LT((hand() - held).norm(), 1e-3);  // stays where it is ...
    for (int i = 0; i < 300; ++i) step({0.0, 0.0, 0.5});
    EXPECT_GT(hand().z(), 0.02);  // ... and a force moves it as a relaxed hand
}

TEST_F(MouseHandTest, letting_go_ends_pull_and_buttons_at_once) {
    for (int i = 0; i < 300; ++i) {
        if (i % 17 == 0) send({0.04, 0.0, 0.0}, Quat::Identity(), 3);
        step();
    }
    send({0.08, 0.0, 0.0}, Quat::Identity(), 3, false);
    const Vec3 held = hand();
    for (int i = 0; i < 500; ++i) EXPECT_EQ(step().buttons, 0U);
    EXPECT_LT((hand() - held).norm(), 5e-3);
}

TEST_F(MouseHandTest, the_tool_does_not_jump_when_it_is_taken) {
    for (int i = 0; i < 300; ++i) step({0.0, 0.5, 0.0});  // it moves
    send({0.0, -0.1, 0.0});
    Vec3 before = device_.hand_pose().p_m;
    double speed_before = 0.5 / 5.0;
    for (int i = 0; i < 400; ++i) {
        if (i % 17 == 0) send({0.0, -0.1, 0.0});
        step();
        const double speed = (hand() - before).y() / 1e-3;
        EXPECT_LT(std::abs(speed - speed_before), i < 3 ? 0.012 : 0.04) << i;
        speed_before = speed;
        before = hand();
    }
}

TEST_F(MouseHandTest, a_target_from_another_time_leads_nothing) {
    send({0.05, 0.0, 0.0});
    now_ += std::chrono::seconds(2);
    for (int i = 0; i < 300; ++i) step();
    EXPECT_EQ(hand(), Vec3(Vec3::Zero()));
    MouseTarget later{};
    later.arrived_ns = to_ns(now_ + std::chrono::seconds(9));
    later.quat_dev_tool_xyzw[3] = 1.0;
    later.pos_dev_m[0] = 0.05;
    later.holds = 1;
    mailbox_.publish(later);
    for (int i = 0; i < 300; ++i) step();
    EXPECT_EQ(hand(), Vec3(Vec3::Zero()));
}

class ScriptedHandTest : public MouseHandTest {
protected:
    ScriptedHandTest() : MouseHandTest("surgeon") {}
};

TEST_F(ScriptedHandTest, a_script_moves_the_hand_until_a_pointer_takes_it_and_not_again) {
    for (int i = 0; i < 1500; ++i) step();
    EXPECT_GT(hand().norm(), 1e-3);
    for (int i = 0; i < 1000; ++i) {
        if (i % 17 == 0) send({0.02, 0.02, 0.02});
        step();
    }
    EXPECT_LT((hand() - Vec3(0.02, 0.02, 0.02)).norm(), 1e-3);
    send({0.02, 0.02, 0.02}, Quat::Identity(), 0, false);
    for (int i = 0; i < 3000; ++i) step();
    EXPECT_LT((hand() - Vec3(0.02, 0.02, 0.02)).norm(), 2e-3);
}

}  // namespace
}  // namespace tact::hal_mouse_hand_test
