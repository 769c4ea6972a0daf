// Targets of a pointer from a window that may be hostile: what reaches a hand, what is refused and counted, what is published.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "rt/threads/mouse_feed.hpp"

namespace tact::threads_mouse_feed_test {
namespace {

using std::chrono::milliseconds;
constexpr std::uint64_t kGeneration = 77;

MouseTopic holding(const Vec3& at_m = {0.01, 0.02, 0.03}, std::uint8_t hand = 0) {
    MouseTopic t{};
    t.generation = kGeneration;
    for (int i = 0; i < 3; ++i) t.pos_world_m[i] = at_m[i];
    t.quat_world_tool_xyzw[3] = 1.0;
    t.hand = hand;
    t.holds = 1;
    return t;
}

class MouseFeedTest : public testing::Test {
protected:
    std::uint64_t turn(const MouseTopic& t) {
        from_.publish(t);
        return feed_.pass_on(from_, now_);
    }
    [[nodiscard]] MouseLead lead(std::size_t hand = 0) const {
        return static_cast<MouseLead>(feed_.state(now_).lead[hand]);
    }

    Latest<MouseTopic> from_{};
    Latest<MouseTarget> hand_[2]{};
    Instant now_{std::chrono::seconds(50)};
    MouseFeed feed_{{{&hand_[0], nullptr}, Pose{Vec3(0.0, 0.0, 0.5), Quat::Identity()}, kGeneration}};
};

TEST_F(MouseFeedTest, a_target_reaches_its_hand_in_the_frame_of_the_device_stamped_on_arrival) {
    MouseTopic t = holding();
    t.taken_at_ns = 1;  // the window's own time is not used
    t.buttons = 2;
    EXPECT_EQ(turn(t), 0U);
    MouseTarget got{};
    ASSERT_TRUE(hand_[0].read(got));
    EXPECT_EQ(got.arrived_ns, to_ns(now_));
    EXPECT_DOUBLE_EQ(got.pos_dev_m[2], 0.53);
    EXPECT_EQ(got.buttons, 2U);
    EXPECT_EQ(lead(), MouseLead::leads);
    EXPECT_EQ(feed_.state(now_).accepted, 1U);
    EXPECT_EQ(feed_.pass_on(from_, now_), 0U);  // once
    EXPECT_EQ(feed_.state(now_).accepted, 1U);
}

TEST_F(MouseFeedTest, impossible_values_are_refused_and_counted_and_move_nothing) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    std::vector<MouseTopic> hostile;
    for (const double p : {nan, HUGE_VAL, -1.01, 1e300}) {
        hostile.push_back(holding());
        hostile.back().pos_world_m[1] = p;
    }
    for (const double w : {nan, 0.0, 1.2, 1e300}) {
        hostile.push_back(holding());
        hostile.back().quat_world_tool_xyzw[3] = w;
    }
    hostile.push_back(holding());
    hostile.back().buttons = 4;
    hostile.push_back(holding());
    hostile.back().hand = 2;
    hostile.push_back(holding());
    hostile.back().holds = 2;
    hostile.push_back(holding());
    hostile.back().device = static_cast<std::uint8_t>(LeadDevice::count);
    std::uint64_t refused = 0;
    for (const MouseTopic& t : hostile) {
        EXPECT_EQ(turn(t), 1U) << refused;
        EXPECT_EQ(feed_.state(now_).refused, ++refused);
    }
    EXPECT_EQ(hand_[0].count(), 0U);
    EXPECT_EQ(lead(), MouseLead::may);
}

TEST_F(MouseFeedTest, a_hand_that_follows_no_pointer_stays_a_persons_own) {
    EXPECT_EQ(lead(1), MouseLead::none);
    EXPECT_EQ(turn(holding({0, 0, 0}, 1)), 1U);
    EXPECT_EQ(hand_[0].count() + hand_[1].count(), 0U);
    EXPECT_EQ(lead(1), MouseLead::none);
    MouseFeed real({{nullptr, nullptr}, Pose{}, kGeneration});
    EXPECT_EQ(real.pass_on(from_, now_), 1U);
    EXPECT_EQ(real.state(now_).refused, 1U);
}

TEST_F(MouseFeedTest, a_target_for_another_controller_is_refused) {
    MouseTopic t = holding();
    t.generation = kGeneration + 1;
    EXPECT_EQ(turn(t), 1U);
    EXPECT_EQ(hand_[0].count(), 0U);
}

TEST_F(MouseFeedTest, what_was_sent_before_the_window_attached_is_ignored) {
    from_.publish(holding());
    feed_.restart(from_);
    EXPECT_EQ(feed_.pass_on(from_, now_), 0U);
    EXPECT_EQ(hand_[0].count(), 0U);
}

TEST_F(MouseFeedTest, silence_is_noticed_after_a_quarter_of_a_second_and_counted_once) {
    turn(holding());
    now_ += milliseconds(240);
    feed_.follow(now_);
    EXPECT_EQ(lead(), MouseLead::leads);
    for (int i = 0; i < 5; ++i) {
        now_ += milliseconds(20);
        feed_.follow(now_);
    }
    EXPECT_EQ(lead(), MouseLead::stale);
    EXPECT_EQ(feed_.state(now_).stale, 1U);
    EXPECT_FALSE(feed_.leads());
    turn(holding());
    EXPECT_EQ(lead(), MouseLead::leads);
}

TEST_F(MouseFeedTest, letting_go_and_a_window_that_leaves_release_the_hand) {
    MouseTopic t = holding();
    t.buttons = 2;
    for (const bool by_window : {true, false}) {
        turn(t);
        if (by_window) {
            t.holds = 0;
            turn(t);
            t.holds = 1;
        } else {
            feed_.let_go();
        }
        MouseTarget got{};
        ASSERT_TRUE(hand_[0].read(got));
        EXPECT_EQ(got.holds, 0U);
        EXPECT_EQ(lead(), MouseLead::may);
    }
}

TEST_F(MouseFeedTest, the_device_that_leads_and_the_one_that_was_asked_for_are_published) {
    MouseFeed feed(
        {{&hand_[0], &hand_[1]}, Pose{}, kGeneration, {LeadDevice::spacemouse, LeadDevice::gamepad}});
    MouseStateTopic state = feed.state(now_);
    EXPECT_TRUE(sensible(state));
    EXPECT_EQ(state.wanted[0], static_cast<std::uint8_t>(LeadDevice::spacemouse));
    EXPECT_EQ(state.wanted[1], static_cast<std::uint8_t>(LeadDevice::gamepad));
    EXPECT_EQ(state.by[0], static_cast<std::uint8_t>(LeadDevice::mouse));
    MouseTopic t = holding();
    t.device = static_cast<std::uint8_t>(LeadDevice::gamepad);
    from_.publish(t);
    EXPECT_EQ(feed.pass_on(from_, now_), 0U);
    state = feed.state(now_);
    EXPECT_EQ(state.by[0], static_cast<std::uint8_t>(LeadDevice::gamepad));
    EXPECT_EQ(state.by[1], static_cast<std::uint8_t>(LeadDevice::mouse));
    state.by[1] = static_cast<std::uint8_t>(LeadDevice::count);
    EXPECT_FALSE(sensible(state));
}

TEST_F(MouseFeedTest, one_pointer_holds_one_hand) {
    MouseFeed both({{&hand_[0], &hand_[1]}, Pose{}, kGeneration});
    from_.publish(holding());
    both.pass_on(from_, now_);
    from_.publish(holding({0, 0, 0}, 1));
    both.pass_on(from_, now_);
    MouseTarget first{}, second{};
    ASSERT_TRUE(hand_[0].read(first) && hand_[1].read(second));
    EXPECT_EQ(first.holds, 0U);
    EXPECT_EQ(second.holds, 1U);
}

TEST_F(MouseFeedTest, random_bytes_never_pass_a_value_out_of_range) {
    std::mt19937_64 random(11);
    for (int i = 0; i < 50000; ++i) {
        MouseTopic t{};
        auto* const bytes = reinterpret_cast<unsigned char*>(&t);
        for (std::size_t k = 0; k < sizeof t; ++k) bytes[k] = static_cast<unsigned char>(random());
        if (i % 2 == 0) t.generation = kGeneration;
        if (i % 4 == 0) {
            t.hand = static_cast<std::uint8_t>(t.hand % 3);
            t.holds = static_cast<std::uint8_t>(t.holds % 3);
            t.device = static_cast<std::uint8_t>(t.device % 4);
            t.buttons %= 5;
            for (double& p : t.pos_world_m) p = std::ldexp(p, -static_cast<int>(random() % 1000));
            if (i % 8 == 0) std::fill_n(t.quat_world_tool_xyzw, 4, 0.5);
        }
        turn(t);
        MouseTarget got{};
        if (!hand_[0].read(got)) continue;
        for (const double p : got.pos_dev_m) ASSERT_LE(std::abs(p), 1.5);
        ASSERT_NEAR(Eigen::Map<const Eigen::Vector4d>(got.quat_dev_tool_xyzw).norm(), 1.0, 1e-9);
        ASSERT_LE(got.buttons, 3U);
    }
    EXPECT_GT(feed_.state(now_).accepted, 100U);
    EXPECT_EQ(hand_[1].count(), 0U);
}

}  // namespace
}  // namespace tact::threads_mouse_feed_test
