// Marks of a recording's timeline.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ipc/topics/command.hpp"
#include "rt/replay/recorded_marks.hpp"

namespace tact::replay_marks_test {
namespace {

EventTopic event(double at_s, EventCode code, double a = 0.0) {
    EventTopic e{};
    e.taken_at_ns = 5'000'000'000 + std::llround(1e9 * at_s);
    e.code = static_cast<std::uint16_t>(code);
    e.a = a;
    return e;
}
ReplayMarks made(const std::vector<EventTopic>& events) { return marks_of(events, 5'000'000'000); }

TEST(ReplayMarks, stand_at_the_time_of_their_event_with_its_grade) {
    const ReplayMarks m = made({event(0.0, EventCode::loop_started), event(1.5, EventCode::overrun),
                                event(2.0, EventCode::command_done, static_cast<double>(CommandKind::mark)),
                                event(2.25, EventCode::command_done, static_cast<double>(CommandKind::arm)),
                                event(3.0, EventCode::fault_latched)});
    ASSERT_EQ(m.count, 5U);
    const double at_s[] = {0.0, 1.5, 2.0, 2.25, 3.0};
    const int grade[] = {0, 1, 1, 0, 2};
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_NEAR(m.mark[i].at_s, at_s[i], 1e-9);
        EXPECT_EQ(m.mark[i].grade, grade[i]) << i;
    }
    EXPECT_EQ(m.mark[4].code, static_cast<std::uint16_t>(EventCode::fault_latched));
}

TEST(ReplayMarks, leave_out_what_happens_all_the_time_and_what_comes_in_a_row) {
    std::vector<EventTopic> events;
    for (int i = 0; i < 100; ++i) {
        events.push_back(event(0.01 * i, EventCode::overrun));
        events.push_back(event(0.01 * i, EventCode::level_changed));
        events.push_back(event(0.01 * i, EventCode::force_limited));
    }
    events.push_back(event(5.0, EventCode::overrun));
    const ReplayMarks m = made(events);
    ASSERT_EQ(m.count, 3U);  // two within the first second, one later
    EXPECT_NEAR(m.mark[2].at_s, 5.0, 1e-9);
}

TEST(ReplayMarks, of_impossible_times_are_finite) {
    EventTopic first = event(0.0, EventCode::hand_left), last = event(0.0, EventCode::fault_latched);
    first.taken_at_ns = std::numeric_limits<std::int64_t>::min();
    last.taken_at_ns = std::numeric_limits<std::int64_t>::max();
    const ReplayMarks m = marks_of({first, last}, std::numeric_limits<std::int64_t>::max());
    ASSERT_EQ(m.count, 2U);
    EXPECT_TRUE(std::isfinite(m.mark[0].at_s) && std::isfinite(m.mark[1].at_s));
    EXPECT_LT(m.mark[0].at_s, m.mark[1].at_s);
}

TEST(ReplayMarks, of_too_many_the_gravest_stay_and_the_others_are_counted) {
    std::vector<EventTopic> events;
    for (int i = 0; i < 400; ++i) events.push_back(event(i, EventCode::hand_left));
    for (int i = 0; i < 100; ++i) events.push_back(event(i + 0.5, EventCode::fault_latched));
    const ReplayMarks m = made(events);
    EXPECT_EQ(m.count, ReplayMarks::kMost);
    EXPECT_EQ(m.omitted, 500U - ReplayMarks::kMost);
    int faults = 0;
    for (std::uint32_t i = 0; i < m.count; ++i) {
        faults += m.mark[i].grade == 2 ? 1 : 0;
        EXPECT_GE(m.mark[i].at_s, m.mark[i > 0 ? i - 1 : 0].at_s);
    }
    EXPECT_EQ(faults, 100);
}

}  // namespace
}  // namespace tact::replay_marks_test
