// The rows of the events panel.
#include <gtest/gtest.h>

#include "gui/window/show_controller.hpp"
#include "ipc/topics/event.hpp"
#include "tests/unit/gui_dashboard_fixture.hpp"

namespace tact::gui_events_test {
namespace {

EventLine line(EventCode code, const char* text, Grade grade, std::int64_t at_ns = 0) {
    return {at_ns, static_cast<std::uint16_t>(code), 1, text, grade};
}

TEST(EventRows, overruns_and_levels_have_one_row_each_with_the_newest_text) {
    std::deque<EventLine> events;
    for (int i = 0; i < 5; ++i) {
        add_event(line(EventCode::overrun, i == 4 ? "last" : "overrun", Grade::watch, i), events);
        add_event(line(EventCode::level_changed, "level", Grade::good, i), events);
    }
    add_event(line(EventCode::fault_latched, "fault", Grade::bad, 9), events);
    add_event(line(EventCode::overrun, "newest", Grade::watch, 10), events);
    ASSERT_EQ(events.size(), 3U);
    EXPECT_EQ(events[0].text, "newest");
    EXPECT_EQ(events[0].count, 6U);
    EXPECT_EQ(events[0].taken_at_ns, 10);
    EXPECT_EQ(events[1].text, "fault");
    EXPECT_EQ(events[2].count, 5U);
}

TEST(EventRows, each_kind_of_warning_has_one_row_and_ordinary_events_never_count) {
    std::deque<EventLine> events;
    for (int i = 0; i < 3; ++i) add_event(line(EventCode::force_limited, "limit", Grade::watch), events);
    add_event(line(EventCode::hand_left, "left", Grade::good), events);
    add_event(line(EventCode::hand_left, "left", Grade::good), events);
    add_event(line(EventCode::force_limited, "limit", Grade::watch), events);
    ASSERT_EQ(events.size(), 3U);
    EXPECT_EQ(events[0].count, 4U);
    EXPECT_EQ(events[1].count, 1U);
    add_event(line(EventCode::gui_silent, "silent", Grade::watch), events);
    EXPECT_EQ(events.size(), 4U);
}

// A row is found where the mouse reaches it: in a replay a click on it asks for its moment.
TEST(EventRows, the_filter_shows_warnings_or_faults_alone) {
    test::TestDashboard d(1280.0F, 720.0F, 1.0F);
    d.state.replay.shown = true;
    d.state.replay.now.duration_s = 60.0;
    add_event(line(EventCode::hand_left, "ordinary", Grade::good, 1'000'000'000), d.state.events);
    add_event(line(EventCode::force_limited, "warning", Grade::watch, 2'000'000'000), d.state.events);
    add_event(line(EventCode::fault_latched, "fault", Grade::bad, 3'000'000'000), d.state.events);
    const auto rows = [&] {
        std::vector<double> found;
        d.frame();
        const Layout l =
            layout_for(d.theme, 1280.0F, 720.0F, middle_card(d.state, d.panels), strip_of(d.state));
        for (float y = l.events.y + 26.0F; y < l.events.y + l.events.height - 4.0F; y += 3.0F) {
            d.click({l.events.x + 56.0F, y});
            for (const TimelineRequest& r : d.state.replay.requests)
                if (found.empty() || found.back() != r.value) found.push_back(r.value);
            d.state.replay.requests.clear();
        }
        return found;
    };
    EXPECT_EQ(rows(), (std::vector{3.0, 2.0, 1.0}));
    d.click("Events", "warnings");
    EXPECT_EQ(rows(), (std::vector{3.0, 2.0}));
    d.click("Events", "faults");
    EXPECT_EQ(rows(), (std::vector{3.0}));
    d.click("Events", "all");
    EXPECT_EQ(rows().size(), 3U);
}

}  // namespace
}  // namespace tact::gui_events_test
