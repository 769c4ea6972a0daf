// Planned start times: no drift, no catching up, every period accounted for.
#include "ipc/base/pacer.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace tact::base_pacer_test {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

const Instant kBegin = instant_from_ns(1'000'000'000);

TEST(Pacer, cycles_that_end_in_time_follow_at_exact_periods) {
    Pacer pacer(milliseconds(1), kBegin);
    for (int i = 0; i < 1000; ++i) {
        EXPECT_EQ(pacer.planned(), kBegin + milliseconds(i));
        EXPECT_FALSE(pacer.ended(pacer.planned() + microseconds(999)));
    }
    EXPECT_EQ(pacer.overruns(), 0U);
}

TEST(Pacer, an_overrun_skips_to_the_next_future_period) {
    Pacer pacer(milliseconds(1), kBegin);
    EXPECT_TRUE(pacer.ended(kBegin + microseconds(3400)));
    EXPECT_EQ(pacer.planned(), kBegin + milliseconds(4));
    EXPECT_EQ(pacer.skipped(), 3U);
    EXPECT_EQ(pacer.overruns(), 1U);
}

TEST(Pacer, planned_instants_stay_on_the_grid_ahead_of_the_end_and_cycles_plus_skips_are_all_periods) {
    const bool held = rc::check([] {
        const Duration period = microseconds(*rc::gen::inRange(50, 2000));
        Pacer pacer(period, kBegin);
        const int cycles = *rc::gen::inRange(1, 200);
        for (int i = 0; i < cycles; ++i) {
            const Instant end = pacer.planned() + microseconds(*rc::gen::inRange(0, 10000));
            static_cast<void>(pacer.ended(end));
            RC_ASSERT(pacer.planned() >= end);
            RC_ASSERT((pacer.planned() - kBegin) % period == Duration{0});
        }
        const auto periods = static_cast<std::uint64_t>((pacer.planned() - kBegin) / period);
        RC_ASSERT(periods == static_cast<std::uint64_t>(cycles) + pacer.skipped());
    });
    EXPECT_TRUE(held);
}

}  // namespace
}  // namespace tact::base_pacer_test
