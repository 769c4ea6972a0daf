// A thread that waits sleeps first.
#include "ipc/base/servo_clock.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace tact::base_servo_clock_test {
namespace {

using std::chrono::microseconds;

TEST(ServoClock, spins_its_tail_and_at_most_half_of_a_wait) {
    const ServoClock clock(microseconds(100));
    EXPECT_EQ(clock.spin(microseconds(900)), microseconds(100));
    EXPECT_EQ(clock.spin(microseconds(200)), microseconds(100));
    EXPECT_EQ(clock.spin(microseconds(75)), Duration(37'500));
    EXPECT_EQ(clock.spin(Duration(0)).count(), 0);
    EXPECT_LE(clock.spin(microseconds(-50)).count(), 0);
    EXPECT_EQ(ServoClock(Duration(0)).spin(microseconds(900)).count(), 0);
    EXPECT_EQ(ServoClock(microseconds(250), 1.0).spin(microseconds(75)), microseconds(75));
}

long sleeps() {
    rusage used{};
    getrusage(RUSAGE_THREAD, &used);
    return used.ru_nvcsw;
}

// At 4 kHz with steps of 70 % of the period: 75 us are left, less than the tail.
TEST(ServoClock, a_wait_that_is_shorter_than_the_tail_sleeps_unless_it_need_not) {
    ServoClock clock(microseconds(100)), spinning(microseconds(100), 1.0);
    const auto slept = [](ServoClock& c) {
        const long before = sleeps();
        for (int i = 0; i < 50; ++i) c.wait_until(c.now() + microseconds(75));
        return sleeps() - before;
    };
    EXPECT_GE(slept(clock), 25);
    EXPECT_LE(slept(spinning), 5);
    const Instant past = clock.now() - microseconds(500);
    const long before = sleeps();
    clock.wait_until(past);
    EXPECT_EQ(sleeps(), before);
}

}  // namespace
}  // namespace tact::base_servo_clock_test
