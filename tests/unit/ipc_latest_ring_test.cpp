// Latest and Ring in one process: arithmetic of slots and cursors, broken writers, and threads at full speed
// (label tsan: the thread sanitizer checks the same instructions as in the release build).
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <memory>
#include <thread>
#include <vector>

#include "ipc/shm/latest.hpp"
#include "ipc/shm/ring.hpp"
#include "tests/stress/pattern.hpp"

namespace tact {
namespace {

using Pattern = stress::Pattern<40>;

TEST(Latest, zero_bytes_are_an_empty_value) {
    const auto latest = std::make_unique<Latest<Pattern>>();
    Pattern value = stress::pattern<40>(7);
    EXPECT_FALSE(latest->read(value));
    EXPECT_EQ(latest->count(), 0U);
    EXPECT_EQ(value.number(), 7U) << "a failed read changed the caller's value";
}

TEST(Latest, read_returns_the_newest_value_repeatedly) {
    const auto latest = std::make_unique<Latest<Pattern>>();
    for (std::uint64_t n = 1; n < 30; ++n) {
        latest->publish(stress::pattern<40>(n));
        for (int again = 0; again < 2; ++again) {
            Pattern value{};
            ASSERT_TRUE(latest->read(value));
            EXPECT_TRUE(value.whole());
            EXPECT_EQ(value.number(), n);
        }
        EXPECT_EQ(latest->count(), n);
    }
}

// With any bytes in shared memory, a reader returns after a bounded number of tries with the content of a slot or
// nothing.
RC_GTEST_PROP(Latest, any_bytes_are_read_or_rejected_in_bounded_time, ()) {
    using Small = Latest<stress::Pattern<2>>;
    const auto words = *rc::gen::container<std::vector<std::uint64_t>>(
        sizeof(Small) / 8,
        rc::gen::oneOf(rc::gen::inRange<std::uint64_t>(0, 12), rc::gen::arbitrary<std::uint64_t>()));
    const auto latest = std::make_unique<Small>();
    std::memcpy(static_cast<void*>(latest.get()), words.data(), sizeof(Small));
    stress::Pattern<2> value = stress::pattern<2>(5);
    if (!latest->read(value)) RC_ASSERT(value.number() == 5U);
    // A new writer continues, unless the count is near the end of its range.
    if (latest->count() < ~0ULL / 4) {
        latest->publish(stress::pattern<2>(9));
        RC_ASSERT(latest->read(value));
        RC_ASSERT(value.number() == 9U);
    }
}

TEST(Ring, records_arrive_once_in_order_and_complete) {
    const auto ring = std::make_unique<Ring<Pattern, 16>>();
    RingCursor cursor;
    Pattern value{};
    EXPECT_FALSE(ring->next(cursor, value));
    std::uint64_t written = 0, seen = 0;
    for (int round = 0; round < 200; ++round) {
        for (int i = 0; i < round % 8; ++i) ring->push(stress::pattern<40>(++written));
        while (ring->next(cursor, value)) {
            EXPECT_TRUE(value.whole());
            EXPECT_EQ(value.number(), ++seen);
        }
        EXPECT_EQ(seen, written);
    }
    EXPECT_EQ(cursor.missed, 0U);
}

RC_GTEST_PROP(Ring, a_lapped_reader_gets_the_exact_number_of_missed_records, ()) {
    const auto ring = std::make_unique<Ring<stress::Pattern<2>, 16>>();
    RingCursor cursor;
    stress::Pattern<2> value{};
    std::uint64_t written = 0, seen = 0, last = 0;
    for (const int pushes : *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 60))) {
        for (int i = 0; i < pushes; ++i) ring->push(stress::pattern<2>(++written));
        while (ring->next(cursor, value)) {
            RC_ASSERT(value.whole());
            RC_ASSERT(value.number() > last);
            last = value.number();
            ++seen;
        }
        RC_ASSERT(last == written);  // the newest record is never missed
        RC_ASSERT(seen + cursor.missed == written);
    }
}

TEST(Ring, tail_skips_earlier_records) {
    const auto ring = std::make_unique<Ring<Pattern, 16>>();
    for (std::uint64_t n = 1; n <= 5; ++n) ring->push(stress::pattern<40>(n));
    RingCursor cursor = ring->tail();
    Pattern value{};
    EXPECT_FALSE(ring->next(cursor, value));
    ring->push(stress::pattern<40>(6));
    ASSERT_TRUE(ring->next(cursor, value));
    EXPECT_EQ(value.number(), 6U);
    EXPECT_EQ(cursor.missed, 0U);
}

TEST(Ring, a_count_that_runs_backwards_restarts_the_reader) {
    using Small = Ring<Pattern, 16>;
    const auto ring = std::make_unique<Small>();
    RingCursor cursor;
    Pattern value{};
    for (std::uint64_t n = 1; n <= 10; ++n) ring->push(stress::pattern<40>(n));
    while (ring->next(cursor, value)) {
    }
    std::memset(static_cast<void*>(ring.get()), 0, sizeof(Small));  // a writer that restarts in place
    EXPECT_FALSE(ring->next(cursor, value));
    ring->push(stress::pattern<40>(1));
    ASSERT_TRUE(ring->next(cursor, value));
    EXPECT_EQ(value.number(), 1U);
}

RC_GTEST_PROP(Ring, any_bytes_and_any_cursor_are_read_in_bounded_time,
              (std::uint64_t next, std::uint64_t missed)) {
    using Small = Ring<stress::Pattern<2>, 4>;
    const auto words = *rc::gen::container<std::vector<std::uint64_t>>(
        sizeof(Small) / 8,
        rc::gen::oneOf(rc::gen::inRange<std::uint64_t>(0, 12), rc::gen::arbitrary<std::uint64_t>(),
                       rc::gen::inRange<std::uint64_t>(~0ULL - 12, ~0ULL)));
    const auto ring = std::make_unique<Small>();
    std::memcpy(static_cast<void*>(ring.get()), words.data(), sizeof(Small));
    RingCursor cursor{next, missed};
    stress::Pattern<2> value{};
    int taken = 0;
    while (taken < 100 && ring->next(cursor, value)) ++taken;
    RC_ASSERT(taken <= 4);  // at most the capacity of the ring
}

TEST(LatestThreads, readers_at_full_speed_never_get_a_torn_or_older_value) {
    const auto latest = std::make_unique<Latest<Pattern>>();
    std::atomic<bool> stop{false};
    std::vector<std::thread> readers;
    std::atomic<std::uint64_t> torn{0}, backwards{0}, reads{0};
    for (int r = 0; r < 2; ++r) {
        readers.emplace_back([&] {
            std::uint64_t last = 0;
            Pattern value{};
            while (!stop.load(std::memory_order_relaxed)) {
                if (!latest->read(value)) continue;
                torn += value.whole() ? 0 : 1;
                backwards += value.number() < last ? 1 : 0;
                last = value.number();
                ++reads;
            }
        });
    }
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(500);
    for (std::uint64_t n = 1; std::chrono::steady_clock::now() < end || reads < 100; ++n)
        latest->publish(stress::pattern<40>(n));
    stop = true;
    for (std::thread& t : readers) t.join();
    EXPECT_EQ(torn, 0U);
    EXPECT_EQ(backwards, 0U);
}

TEST(RingThreads, a_reader_at_full_speed_gets_or_counts_every_record) {
    const auto ring = std::make_unique<Ring<Pattern, 64>>();
    std::atomic<std::uint64_t> written{0};
    std::atomic<bool> stop{false};
    std::thread writer([&] {
        std::uint64_t n = 0;
        while (!stop.load(std::memory_order_relaxed)) {
            ring->push(stress::pattern<40>(++n));
            if (n % 64 == 0) std::this_thread::yield();
        }
        written = n;
    });
    RingCursor cursor;
    Pattern value{};
    std::uint64_t seen = 0, last = 0, torn = 0, unordered = 0;
    const auto take = [&] {
        if (!ring->next(cursor, value)) return false;
        torn += value.whole() ? 0 : 1;
        unordered += value.number() <= last ? 1 : 0;
        last = value.number();
        ++seen;
        return true;
    };
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(500);
    while (std::chrono::steady_clock::now() < end || seen < 100) take();
    stop = true;
    writer.join();
    while (take()) {
    }
    EXPECT_EQ(torn, 0U);
    EXPECT_EQ(unordered, 0U);
    EXPECT_EQ(last, written.load());
    EXPECT_EQ(seen + cursor.missed, written.load());
}

}  // namespace
}  // namespace tact
