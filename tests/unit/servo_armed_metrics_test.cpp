// Metrics of the armed cycles, compared with sums computed by hand.
#include "rt/servo/armed_metrics.hpp"

#include <gtest/gtest.h>

namespace tact::servo_armed_metrics_test {
namespace {

using std::chrono::milliseconds;

constexpr Instant at_ms(std::int64_t ms) { return instant_from_ns(1'000'000'000 + ms * 1'000'000); }

TEST(ArmedMetrics, only_cycles_with_force_count) {
    ArmedMetrics m;
    EXPECT_LT(m.level_settled_s(), 0.0);
    for (int i = 0; i < 10; ++i) m.add({.armed = false, .deadline_missed = true}, at_ms(i));
    EXPECT_EQ(m.cycles(), 0U);
    EXPECT_EQ(m.deadline_misses(), 0U);
    for (int i = 10; i < 110; ++i)
        m.add({.armed = true, .deadline_missed = i % 25 == 0, .error_n = 0.5}, at_ms(i));
    EXPECT_EQ(m.cycles(), 100U);
    EXPECT_EQ(m.deadline_misses(), 4U);
    EXPECT_EQ(m.missed_at(), at_ms(100));
    EXPECT_NEAR(m.force_error_n_p50(), 0.5, 0.5 / 16.0);
}

TEST(ArmedMetrics, the_miss_fraction_covers_the_last_second_alone) {
    ArmedMetrics m;
    for (int i = 0; i < 1000; ++i) m.add({.armed = true, .deadline_missed = i < 250}, at_ms(i));
    m.second_over();
    EXPECT_DOUBLE_EQ(m.last_second_share(), 0.25);
    for (int i = 1000; i < 2000; ++i) m.add({.armed = true}, at_ms(i));
    m.second_over();
    EXPECT_DOUBLE_EQ(m.last_second_share(), 0.0);
    EXPECT_EQ(m.deadline_misses(), 250U);
}

TEST(ArmedMetrics, the_largest_force_step_is_between_consecutive_armed_cycles) {
    ArmedMetrics m;
    m.add({.armed = true, .force_world_n = Vec3(0.0, 0.0, 1.0)}, at_ms(0));
    m.add({.armed = true, .force_world_n = Vec3(0.3, 0.4, 1.0)}, at_ms(1));
    EXPECT_NEAR(m.force_step_n_max(), 0.5, 1e-12);
    m.add({.armed = false}, at_ms(2));
    m.add({.armed = true, .force_world_n = Vec3(9.0, 0.0, 0.0)},
          at_ms(3));  // newly armed: no force step
    EXPECT_NEAR(m.force_step_n_max(), 0.5, 1e-12);
}

TEST(LevelHistory, a_level_has_settled_once_it_stays_within_five_percent_of_its_present_value) {
    LevelHistory h;
    h.start(at_ms(0));
    for (int i = 0; i < 5000; ++i) {
        const double level = i < 800 ? 0.2 + 0.001 * i : i < 1200 ? 0.5 : 0.8 + 0.005 * (i % 2);
        h.add(level, at_ms(i));
    }
    EXPECT_NEAR(h.settled_s(), 1.199, 1e-9);
    for (int i = 5000; i < 6000; ++i) h.add(0.8, at_ms(i));
    EXPECT_NEAR(h.settled_s(), 1.199, 1e-9);
    h.add(0.5, at_ms(6000));
    EXPECT_NEAR(h.settled_s(), 5.999, 1e-9);
    h.start(at_ms(6000));
    h.add(0.5, at_ms(6000));
    EXPECT_EQ(h.settled_s(), 0.0);
}

}  // namespace
}  // namespace tact::servo_armed_metrics_test
