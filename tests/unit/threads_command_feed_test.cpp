// From the queue of the visual process to the servo's orders: arm and disarm past a flood.
#include "rt/threads/command_feed.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

namespace tact::threads_command_feed_test {
namespace {

class CommandFeedTest : public testing::Test {
protected:
    void push(CommandKind kind, double value = 0.0) {
        CommandTopic c{};
        c.sequence = ++sequence_;
        c.kind = static_cast<std::uint16_t>(kind);
        c.value = value;
        queue_->push(c);
    }
    std::uint64_t turn() { return feed_.pass_on(*queue_, {}, orders_); }
    // 0: none was passed on.
    std::uint64_t taken(CommandKind kind) {
        ServoOrder order{};
        return orders_.take(kind, order) ? order.sequence : 0;
    }
    int others() {
        ServoOrder order{};
        int n = 0;
        while (orders_.next(cursor_, order)) ++n;
        return n;
    }

    std::unique_ptr<CommandQueue> queue_{new CommandQueue{}};
    CommandFeed feed_;
    CommandQueue::Cursor cursor_of_queue_;
    ServoOrders orders_;
    RingCursor cursor_;
    std::uint64_t sequence_ = 0;
};

TEST_F(CommandFeedTest, a_disarm_behind_a_flood_is_passed_on_in_the_next_turn) {
    for (const int flood : {10, 40, 61, 70, 10'000}) {
        for (int i = 0; i < flood; ++i) push(CommandKind::mark);
        push(CommandKind::disarm);
        turn();
        EXPECT_EQ(taken(CommandKind::disarm), sequence_) << flood;
        for (int i = 0; i < 8; ++i) turn();
        EXPECT_EQ(taken(CommandKind::disarm), 0U) << flood;  // once
        others();
    }
}

TEST_F(CommandFeedTest, a_disarm_in_front_of_a_flood_is_passed_on_in_the_next_turn) {
    for (const int flood : {10, 60, 70, 10'000}) {
        push(CommandKind::disarm);
        const std::uint64_t sequence = sequence_;
        for (int i = 0; i < flood; ++i) push(CommandKind::mark);
        turn();
        EXPECT_EQ(taken(CommandKind::disarm), sequence) << flood;
    }
}

TEST_F(CommandFeedTest, of_arm_and_disarm_in_one_turn_both_come_the_older_first) {
    for (const bool arm_first : {true, false}) {
        push(arm_first ? CommandKind::arm : CommandKind::disarm);
        push(arm_first ? CommandKind::disarm : CommandKind::arm);
        CommandTopic first{}, second{};
        CommandQueue::Cursor cursor = cursor_of_queue_;
        ASSERT_TRUE(queue_->next(cursor, first));
        ASSERT_TRUE(queue_->next(cursor, second));
        EXPECT_EQ(first.sequence + 1, second.sequence);
        EXPECT_FALSE(queue_->next(cursor, first));
        cursor_of_queue_ = cursor;
        turn();
        EXPECT_EQ(taken(CommandKind::arm), sequence_ - (arm_first ? 1 : 0));
        EXPECT_EQ(taken(CommandKind::disarm), sequence_ - (arm_first ? 0 : 1));
    }
}

// A hostile window may write anything anywhere: what is not an order to arm or disarm is checked like any other.
TEST_F(CommandFeedTest, a_turn_takes_two_orders_to_arm_or_disarm_at_most) {
    for (int i = 0; i < 1000; ++i) push(i % 2 == 0 ? CommandKind::arm : CommandKind::disarm);
    turn();
    EXPECT_EQ(taken(CommandKind::arm), 999U);
    EXPECT_EQ(taken(CommandKind::disarm), 1000U);
    EXPECT_EQ(others(), 0);
}

TEST_F(CommandFeedTest, the_others_come_in_order_so_many_a_turn_and_each_command_once) {
    for (int i = 0; i < 30; ++i) {
        push(CommandKind::mark);
        push(i % 2 == 0 ? CommandKind::arm : CommandKind::disarm);
    }
    EXPECT_EQ(turn(), 0U);
    EXPECT_EQ(taken(CommandKind::arm), 58U);
    EXPECT_EQ(taken(CommandKind::disarm), 60U);
    int passed = others();
    EXPECT_LE(passed, CommandFeed::kOthersPerTurn);
    for (int i = 0; i < 8; ++i) {
        EXPECT_EQ(turn(), 0U);
        passed += others();
    }
    EXPECT_EQ(passed, 30);
    EXPECT_EQ(taken(CommandKind::arm), 0U);
    EXPECT_EQ(taken(CommandKind::disarm), 0U);
}

TEST_F(CommandFeedTest, refused_and_missed_commands_are_counted_and_a_refused_one_is_answered_by_the_servo) {
    push(CommandKind::disarm, std::numeric_limits<double>::quiet_NaN());
    push(CommandKind::set_goal_hz, -1.0);
    EXPECT_EQ(turn(), 2U);
    EXPECT_EQ(taken(CommandKind::disarm), 0U);
    ServoOrder order{};
    for (const std::uint64_t sequence : {1U, 2U}) {
        ASSERT_TRUE(orders_.next(cursor_, order));
        EXPECT_EQ(order.sequence, sequence);
        EXPECT_EQ(order.kind, static_cast<std::uint32_t>(CommandKind::none));
        EXPECT_EQ(order.index, static_cast<std::uint32_t>(CommandResult::refused_value));
    }
    for (int i = 0; i < 100; ++i) push(CommandKind::mark);
    EXPECT_GT(turn(), 0U);
}

TEST_F(CommandFeedTest, what_was_commanded_before_is_not_for_this_controller) {
    push(CommandKind::arm);
    push(CommandKind::mark);
    feed_.restart(*queue_);
    turn();
    EXPECT_EQ(taken(CommandKind::arm), 0U);
    EXPECT_EQ(others(), 0);
    push(CommandKind::arm);
    turn();
    EXPECT_EQ(taken(CommandKind::arm), 3U);
}

}  // namespace
}  // namespace tact::threads_command_feed_test
