// Mouse operation of the traces: pause, trigger, cursors, zoom, export; and the strip below the view.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "gui/dashboard/drawn_texts.hpp"
#include "ipc/base/run_state.hpp"
#include "tests/unit/gui_dashboard_fixture.hpp"

namespace tact::gui_traces_panel_test {
namespace {

constexpr char kCard[] = "Over time";

class TracesPanel : public testing::Test {
protected:
    // Adds so many cycles at 1 kHz, with a force that swings between -1 and 1 N five times a second.
    void run(int cycles) {
        for (int i = 0; i < cycles; ++i) {
            TraceTopic t{};
            t.taken_at_ns = 1'000'000'000 + 1'000'000 * ++cycle_;
            t.cycle = static_cast<std::uint64_t>(cycle_);
            t.force_world_n[0] = static_cast<float>(std::sin(0.0314159 * static_cast<double>(cycle_)));
            t.cost_ns = 90'000;
            t.lateness_ns = 2'000;
            t.status = static_cast<std::uint32_t>(RunState::active);
            scope().add(t, 1'000'000);
        }
        dashboard_.frame();
    }
    TraceScope& scope() { return dashboard_.state.traces.scope; }
    void open() {
        dashboard_.click(kCard, "Traces");
        ASSERT_EQ(dashboard_.state.strip, 1);
        run(5000);
    }
    ImVec2 on_lanes(float share) {
        const Layout l = layout_for(dashboard_.theme, 1280.0F, 720.0F,
                                    middle_card(dashboard_.state, dashboard_.panels), {.traces = true});
        return {l.plots.x + dashboard_.theme.px(60.0F) + share * (l.plots.width - dashboard_.theme.px(80.0F)),
                l.plots.y + 0.7F * l.plots.height};
    }

    test::TestDashboard dashboard_{1280.0F, 720.0F, 1.0F};
    std::int64_t cycle_ = 0;
};

TEST_F(TracesPanel, replace_the_plots_with_a_higher_strip) {
    const float before =
        layout_for(dashboard_.theme, 1280.0F, 720.0F, middle_card(dashboard_.state, dashboard_.panels), {})
            .plots.height;
    open();
    EXPECT_GT(layout_for(dashboard_.theme, 1280.0F, 720.0F, middle_card(dashboard_.state, dashboard_.panels),
                         {.traces = true})
                  .plots.height,
              1.4F * before);
    dashboard_.click(kCard, "Load and detail");
    EXPECT_EQ(dashboard_.state.strip, 0);
}

TEST_F(TracesPanel, pause_freezes_the_traces_and_run_resumes) {
    open();
    dashboard_.click(kCard, "Pause");
    EXPECT_TRUE(scope().held());
    const std::int64_t end_ns = scope().end_ns();
    run(1000);
    EXPECT_EQ(scope().end_ns(), end_ns);
    dashboard_.click(kCard, "Run");
    EXPECT_FALSE(scope().held());
    EXPECT_GT(scope().end_ns(), end_ns);
}

TEST_F(TracesPanel, every_control_has_the_same_place_in_all_modes) {
    open();
    std::map<std::string, ImVec2> place;
    const auto check = [&](const std::string& mode) {
        dashboard_.frame();
        std::size_t seen = 0;
        for (const DrawnText& t : drawn_texts(*ImGui::GetDrawData())) {
            if (t.owner != kCard) continue;
            for (const char* const name : {"Pause", "roll", "auto", "normal", "single", "Channels", "Cursors",
                                           "Export", "trigger on", "50 % before", "rising", "Arm trigger"}) {
                if (t.text != name) continue;
                ++seen;
                const ImVec2 first = place.try_emplace(t.text, ImVec2(t.x, t.y)).first->second;
                EXPECT_EQ(t.x, first.x) << t.text << " in mode " << mode;
                EXPECT_EQ(t.y, first.y) << t.text << " in mode " << mode;
            }
        }
        EXPECT_GE(seen, 10U) << mode;
    };
    for (const TriggerSource source : {TriggerSource::channel, TriggerSource::overrun, TriggerSource::fault})
        for (int run = 0; run < 4; ++run) {
            TriggerSettings s = scope().trigger();
            s.source = source;
            s.level = 5.0;
            scope().set_trigger(s);
            scope().choose_run(static_cast<TraceRun>(run));
            check(std::to_string(run) + ", source " + std::to_string(static_cast<int>(source)));
        }
    EXPECT_EQ(place.count("Arm trigger"), 1U);
    EXPECT_EQ(place.count("rising"), 1U);
}

TEST_F(TracesPanel, a_single_capture_waits_for_the_trigger_and_captures_once) {
    open();
    TriggerSettings s = scope().trigger();
    s.channel = TraceChannel::force_x;
    s.level = 5.0;  // a level that is never reached
    scope().set_trigger(s);
    scope().set_span(0.1);
    dashboard_.click(kCard, "single");
    EXPECT_EQ(scope().run(), TraceRun::single);
    run(1000);
    EXPECT_EQ(scope().captures(), 0U);
    s.level = 0.5;
    scope().set_trigger(s);
    run(1000);
    EXPECT_EQ(scope().captures(), 1U);
    EXPECT_STREQ(scope().status(), "captured");
    dashboard_.click(kCard, "Arm trigger");
    EXPECT_STREQ(scope().status(), "waiting for the trigger");
    run(1000);
    EXPECT_STREQ(scope().status(), "captured");
}

TEST_F(TracesPanel, a_click_reverses_the_edge) {
    open();
    dashboard_.click(kCard, "normal");
    EXPECT_TRUE(scope().trigger().rising);
    dashboard_.click(kCard, "rising");
    EXPECT_FALSE(scope().trigger().rising);
}

TEST_F(TracesPanel, dragging_moves_the_cursor_under_the_mouse_or_else_the_traces) {
    open();
    dashboard_.click(kCard, "Cursors");
    EXPECT_TRUE(scope().cursors);
    const double begun_s = scope().span_s();
    const Layout l = layout_for(dashboard_.theme, 1280.0F, 720.0F,
                                middle_card(dashboard_.state, dashboard_.panels), {.traces = true});
    // The lanes begin to the right of their numbers, which are 44 wide, inside the card's padding.
    const float x0 = l.plots.x + 10.0F + 44.0F, x1 = l.plots.x + l.plots.width - 10.0F - 1.0F;
    const float y = l.plots.y + 0.7F * l.plots.height;
    const auto x = [&](double share) { return x0 + static_cast<float>(share) * (x1 - x0); };
    dashboard_.drag({x(scope().cursor[0]), y}, {x(0.5), y});
    EXPECT_NEAR(scope().cursor[0], 0.5, 0.02);
    EXPECT_FALSE(scope().held());
    EXPECT_EQ(scope().span_s(), begun_s);
    const std::int64_t end_ns = scope().end_ns();
    dashboard_.drag({x(0.1), y}, {x(0.3), y});
    EXPECT_TRUE(scope().held());
    EXPECT_NEAR(1e-9 * static_cast<double>(end_ns - scope().end_ns()), 0.2, 0.03);
    EXPECT_NEAR(scope().cursor[0], 0.5, 0.02);
}

TEST_F(TracesPanel, the_wheel_zooms_around_the_mouse) {
    open();
    dashboard_.click(kCard, "Pause");
    const ImVec2 at = on_lanes(0.5F);
    const double before = scope().span_s();
    dashboard_.wheel(at, 3.0F);
    EXPECT_NEAR(scope().span_s(), before * std::pow(0.8, 3.0), 1e-6);
    dashboard_.wheel(at, -3.0F);
    EXPECT_NEAR(scope().span_s(), before, 1e-6);
}

TEST_F(TracesPanel, export_is_requested_from_the_application) {
    dashboard_.click(kCard, "Traces");
    dashboard_.click(kCard, "Export");
    EXPECT_FALSE(dashboard_.state.traces.export_wanted);  // there is nothing to export yet
    run(100);
    dashboard_.click(kCard, "Export");
    EXPECT_TRUE(dashboard_.state.traces.export_wanted);
}

TEST_F(TracesPanel, no_data_garbage_and_every_mode_can_be_drawn) {
    for (int strip : {0, 1}) {
        dashboard_.state.strip = strip;
        dashboard_.frame();
        for (int mode = 0; mode < 4; ++mode) {
            scope().choose_run(static_cast<TraceRun>(mode));
            run(300);
        }
    }
    for (int i = 0; i < 50; ++i) {
        TraceTopic t{};
        std::memset(static_cast<void*>(&t), 0xFF, sizeof t);
        t.taken_at_ns = 1'000'000'000 + 1'000'000 * ++cycle_;
        scope().add(t, 1'000'000);
    }
    dashboard_.state.traces.channels.set();
    scope().cursors = true;
    run(10);
    dashboard_.state.traces.channels.reset();
    dashboard_.frame();
    SUCCEED();
}

}  // namespace
}  // namespace tact::gui_traces_panel_test
