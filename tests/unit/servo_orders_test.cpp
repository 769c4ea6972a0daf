// Orders on their way to the servo: no flood of others holds up or loses arm and disarm.
#include "rt/servo/servo_orders.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <thread>

namespace tact::servo_orders_test {
namespace {

ServoOrder order(CommandKind kind, std::uint64_t sequence) {
    return {.sequence = sequence, .value = 0.0, .kind = static_cast<std::uint32_t>(kind), .index = 0};
}

TEST(ServoOrders, arm_and_disarm_are_taken_past_any_number_of_others) {
    for (const CommandKind kind : {CommandKind::arm, CommandKind::disarm}) {
        for (const std::uint64_t others : {0U, 70U, 10'000U}) {
            ServoOrders orders;
            orders.push(order(kind, 1));
            for (std::uint64_t i = 0; i < others; ++i) orders.push(order(CommandKind::set_level, 2 + i));
            ServoOrder taken{};
            ASSERT_TRUE(orders.take(kind, taken)) << others;
            EXPECT_EQ(taken.sequence, 1U);
            EXPECT_EQ(taken.kind, static_cast<std::uint32_t>(kind));
            EXPECT_FALSE(orders.take(kind, taken));  // once
        }
    }
}

TEST(ServoOrders, the_newest_of_a_kind_counts_and_the_other_kind_is_left_alone) {
    ServoOrders orders;
    for (std::uint64_t i = 1; i <= 3; ++i) orders.push(order(CommandKind::arm, i));
    orders.push(order(CommandKind::disarm, 4));
    ServoOrder taken{};
    ASSERT_TRUE(orders.take(CommandKind::arm, taken));
    EXPECT_EQ(taken.sequence, 3U);
    ASSERT_TRUE(orders.take(CommandKind::disarm, taken));
    EXPECT_EQ(taken.sequence, 4U);
    EXPECT_FALSE(orders.take(CommandKind::arm, taken));
}

TEST(ServoOrders, the_others_come_in_order_and_without_arm_and_disarm) {
    ServoOrders orders;
    for (std::uint64_t i = 1; i <= 9; ++i)
        orders.push(order(i % 3 == 0 ? CommandKind::disarm : CommandKind::mark, i));
    RingCursor cursor;
    ServoOrder taken{};
    for (const std::uint64_t expected : {1U, 2U, 4U, 5U, 7U, 8U}) {
        ASSERT_TRUE(orders.next(cursor, taken));
        EXPECT_EQ(taken.sequence, expected);
    }
    EXPECT_FALSE(orders.next(cursor, taken));
    EXPECT_FALSE(orders.take(CommandKind::mark, taken));
}

TEST(ServoOrders, any_sequence_number_is_an_order) {
    for (const std::uint64_t sequence :
         {std::uint64_t{0}, std::uint64_t{1} << 63U, std::numeric_limits<std::uint64_t>::max()}) {
        ServoOrders orders;
        orders.push(order(CommandKind::disarm, sequence));
        ServoOrder taken{};
        EXPECT_TRUE(orders.take(CommandKind::disarm, taken)) << sequence;
    }
}

// One thread floods, the other takes: of each kind the numbers rise, and the last of each arrives.
TEST(ServoOrders, between_two_threads_the_last_arm_and_disarm_arrive) {
    constexpr std::uint64_t kLast = 20'000;
    ServoOrders orders;
    std::atomic<bool> all_asked{false};
    std::thread asks([&] {
        for (std::uint64_t i = 1; i <= kLast; ++i) {
            orders.push(order(CommandKind::set_level, i));
            orders.push(order(CommandKind::disarm, i));
            orders.push(order(CommandKind::arm, i));
        }
        all_asked.store(true);
    });
    std::uint64_t arm = 0, disarm = 0, other = 0;
    bool rising = true, last = false;
    RingCursor cursor;
    const auto later = [&rising](std::uint64_t& newest, const ServoOrder& taken) {
        rising = rising && taken.sequence > newest;
        newest = taken.sequence;
    };
    while (!last) {
        last = all_asked.load();
        ServoOrder taken{};
        if (orders.take(CommandKind::disarm, taken)) later(disarm, taken);
        if (orders.take(CommandKind::arm, taken)) later(arm, taken);
        for (int i = 0; (last || i < 4) && orders.next(cursor, taken); ++i) later(other, taken);
    }
    asks.join();
    EXPECT_EQ(arm, kLast);
    EXPECT_EQ(disarm, kLast);
    EXPECT_EQ(other, kLast);
    EXPECT_TRUE(rising);
}

}  // namespace
}  // namespace tact::servo_orders_test
