// A replay in the window: its card, its timeline, and what the window sends.
#include <gtest/gtest.h>

#include <cstring>

#include "gui/link/command_sender.hpp"
#include "gui/link/region_checks.hpp"
#include "gui/window/timeline_sender.hpp"
#include "tests/unit/gui_dashboard_fixture.hpp"

namespace tact::gui_timeline_test {
namespace {

ReplayTopic replay_at(double at_s, ReplayAct act = ReplayAct::paused) {
    ReplayTopic r{};
    r.at_s = at_s;
    r.duration_s = 20.0;
    r.speed = 1.0;
    r.seek_share = 1.0;
    r.step = static_cast<std::uint64_t>(1000.0 * at_s);
    r.steps = 20000;
    r.act = static_cast<std::uint8_t>(act);
    r.plays = act == ReplayAct::playing ? 1 : 0;
    r.exact = r.whole = r.can_run = 1;
    std::strcpy(r.name, "run.h5");
    return r;
}

class Timeline : public ::testing::Test {
protected:
    Timeline() {
        DashboardState& s = dashboard_.state;
        s.attached = s.have_health = true;
        s.health.state = static_cast<std::uint8_t>(RunState::ready);
        s.replay.shown = true;
        s.replay.now = replay_at(5.0);
        dashboard_.frame();
        dashboard_.frame();
    }
    std::vector<TimelineRequest>& requests() { return dashboard_.state.replay.requests; }
    [[nodiscard]] Layout layout() {
        return layout_for(dashboard_.theme, 1280.0F, 720.0F, middle_card(dashboard_.state, dashboard_.panels),
                          strip_of(dashboard_.state));
    }

    test::TestDashboard dashboard_{1280.0F, 720.0F, 1.0F};
};

// The top left card alone tells it: its title, and no button that acts.
TEST_F(Timeline, the_card_says_replay_and_none_of_its_buttons_acts) {
    EXPECT_NE(ImGui::FindWindowByName("Replay"), nullptr);
    ImGuiWindow* const controller = ImGui::FindWindowByName("Controller");
    EXPECT_TRUE(controller == nullptr || !controller->Active);
    for (const RunState state : {RunState::ready, RunState::active, RunState::fault}) {
        dashboard_.state.health.state = static_cast<std::uint8_t>(state);
        for (const char* button : {"Arm", "Disarm", "Reset"})
            if (const ImVec2 at = dashboard_.find("Replay", button); at.x > 0.0F) dashboard_.click(at);
        EXPECT_TRUE(dashboard_.state.requests.empty());
    }
    dashboard_.state.replay.shown = false;
    dashboard_.state.health.state = static_cast<std::uint8_t>(RunState::active);
    dashboard_.frame();
    dashboard_.click("Controller", "Disarm");
    EXPECT_EQ(dashboard_.state.requests.size(), 1U);  // the same clicks act in a live run
}

TEST_F(Timeline, lies_between_the_view_and_the_plots_and_covers_neither) {
    const Layout l = layout();
    EXPECT_GT(l.timeline.height, 40.0F);
    EXPECT_GE(l.timeline.y, l.view.y + l.view.height);
    EXPECT_LE(l.timeline.y + l.timeline.height, l.plots.y);
    dashboard_.state.replay.shown = false;
    EXPECT_EQ(layout().timeline.height, 0.0F);
}

// The place on the line is a time; a mark under the mouse is a moment of its own.
TEST_F(Timeline, of_a_live_run_a_click_looks_back) {
    DashboardState& s = dashboard_.state;
    s.replay.shown = false;
    s.past.shown = true;
    s.past.marks = {{10.0, Grade::watch, "overrun"}};
    dashboard_.frame();
    const Layout l = layout();
    EXPECT_GT(l.timeline.height, 25.0F);
    EXPECT_LE(l.timeline.y + l.timeline.height, l.plots.y);
    ImGuiWindow* const window = ImGui::FindWindowByName("Timeline");
    ASSERT_NE(window, nullptr);
    const ImVec2 somewhere = dashboard_.find("Timeline", "##past");
    const ImGuiID line = window->GetID("##past");
    float left = 1e9F, right = 0.0F;
    for (float x = l.timeline.x; x < l.timeline.x + l.timeline.width; x += 1.0F) {
        dashboard_.move({x, somewhere.y});
        if (ImGui::GetCurrentContext()->HoveredId != line) continue;
        left = std::min(left, x);
        right = std::max(right, x);
    }
    ASSERT_GT(right, left + 300.0F);
    for (const double ago_s : {25.0, 10.05, 2.0}) {
        const float x = right - (right - left) * static_cast<float>(ago_s / PastState::kLengthS);
        dashboard_.click({x, somewhere.y});
        EXPECT_NEAR(s.past.wanted_ago_s, ago_s, 0.15);
        if (ago_s == 10.05) {
            EXPECT_EQ(s.past.wanted_ago_s, 10.0) << "the mark is at 10 s";
        }
        s.past.wanted_ago_s = -1.0;
    }
    s.past.shown = false;
    EXPECT_EQ(layout().timeline.height, 0.0F);
}

TEST_F(Timeline, its_buttons_play_step_and_run) {
    for (const auto& [label, action, value] :
         {std::tuple{"|<", TimelineAction::seek, 0.0}, std::tuple{"<", TimelineAction::step, -1.0},
          std::tuple{"Play", TimelineAction::play, 0.0}, std::tuple{">", TimelineAction::step, 1.0},
          std::tuple{"Run from here", TimelineAction::run, 0.0}}) {
        dashboard_.click("Timeline", label);
        ASSERT_EQ(requests().size(), 1U) << label;
        EXPECT_EQ(requests()[0].action, action) << label;
        EXPECT_EQ(requests()[0].value, value) << label;
        requests().clear();
    }
    dashboard_.state.replay.now.can_run = 0;
    dashboard_.frame();
    EXPECT_EQ(dashboard_.find("Timeline", "Run from here").x, 0.0F);
}

TEST_F(Timeline, a_place_is_looked_for_when_the_mouse_is_let_go_and_a_mark_attracts) {
    ReplayMarks& marks = dashboard_.state.replay.marks;
    marks.count = 1;
    marks.mark[0] = {.at_s = 16.0,
                     .code = static_cast<std::uint16_t>(EventCode::fault_latched),
                     .detail = 0,
                     .grade = 2,
                     .reserved = {}};
    dashboard_.move({1.0F, 1.0F});
    ImGuiWindow* const window = ImGui::FindWindowByName("Timeline");
    ASSERT_NE(window, nullptr);
    const ImVec2 middle = dashboard_.find("Timeline", "##line");
    ASSERT_GT(middle.x, 0.0F);
    // The line spans from its first hit to the card's right edge.
    const float left = middle.x - 2.0F, right = window->Pos.x + window->Size.x - 12.0F;
    const auto at = [&](double s) {
        return ImVec2{left + static_cast<float>(s / 20.0) * (right - left), middle.y};
    };
    dashboard_.press(at(4.0));
    dashboard_.move(at(10.0));
    EXPECT_TRUE(requests().empty());
    EXPECT_NEAR(dashboard_.state.replay.dragged_s, 10.0, 0.3);
    dashboard_.release();
    ASSERT_EQ(requests().size(), 1U);
    EXPECT_EQ(requests()[0].action, TimelineAction::seek);
    EXPECT_NEAR(requests()[0].value, 10.0, 0.3);
    EXPECT_LT(dashboard_.state.replay.dragged_s, 0.0);
    requests().clear();
    dashboard_.click(at(16.03));
    ASSERT_EQ(requests().size(), 1U);
    EXPECT_EQ(requests()[0].value, 16.0);
}

TEST_F(Timeline, a_click_on_an_event_shows_its_moment) {
    DashboardState& s = dashboard_.state;
    s.history.first_ns = 1'000'000'000;
    s.now_ns = 6'000'000'000;
    s.events.push_front({4'500'000'000, 1, 1, "state changed: armed to active", Grade::good});
    dashboard_.frame();
    const Layout l = layout();
    bool found = false;
    for (float y = l.events.y + 34.0F; y < l.events.y + 90.0F && !found; y += 4.0F) {
        dashboard_.click({l.events.x + 100.0F, y});
        found = !requests().empty();
    }
    ASSERT_TRUE(found);
    EXPECT_EQ(requests()[0].action, TimelineAction::seek);
    EXPECT_NEAR(requests()[0].value, 3.5, 1e-9);
}

TEST(ReplayText, tells_what_the_replay_does) {
    EXPECT_EQ(replay_text(replay_at(5.0)), "paused at 5.000 s of 20.0 s");
    EXPECT_EQ(replay_text(replay_at(5.0, ReplayAct::playing)), "playing at 1 x, 5.000 s of 20.0 s");
    EXPECT_EQ(replay_text(replay_at(20.0, ReplayAct::ended)), "at the end, 20.000 s of 20.0 s");
    ReplayTopic seeking = replay_at(5.0, ReplayAct::seeking);
    seeking.seek_share = 0.43;
    EXPECT_EQ(replay_text(seeking), "computing the way there: 43 %");
}

class Sender : public ::testing::Test {
protected:
    TimelineTopic after(TimelineAction action, double value, const ReplayTopic& replay) {
        sender_.send({action, value}, replay, 7);
        TimelineTopic t{};
        EXPECT_TRUE(to_->read(t));
        EXPECT_TRUE(sensible(t));
        return t;
    }
    std::unique_ptr<Latest<TimelineTopic>> to_ = std::make_unique<Latest<TimelineTopic>>();
    TimelineSender sender_{*to_};
};

TEST_F(Sender, changes_one_thing_and_keeps_the_others) {
    TimelineTopic t = after(TimelineAction::play, 0.0, replay_at(5.0));
    EXPECT_EQ(t.playing, 1);
    EXPECT_EQ(t.seeks, 0U);
    t = after(TimelineAction::speed, 4.0, replay_at(5.0, ReplayAct::playing));
    EXPECT_EQ(t.playing, 1);
    EXPECT_EQ(t.speed, 4.0);
    t = after(TimelineAction::play, 0.0, replay_at(5.0, ReplayAct::playing));
    EXPECT_EQ(t.playing, 0);
    t = after(TimelineAction::seek, 50.0, replay_at(5.0));
    EXPECT_EQ(t.seeks, 1U);
    EXPECT_EQ(t.seek_s, 20.0);  // not beyond the end
    t = after(TimelineAction::run, 0.0, replay_at(5.0, ReplayAct::playing));
    EXPECT_EQ(t.runs, 1U);
    EXPECT_EQ(t.playing, 0);
    EXPECT_EQ(t.seeks, 1U);
}

TEST_F(Sender, at_the_end_play_begins_anew) {
    const TimelineTopic t = after(TimelineAction::play, 0.0, replay_at(20.0, ReplayAct::ended));
    EXPECT_EQ(t.playing, 1);
    EXPECT_EQ(t.seeks, 1U);
    EXPECT_EQ(t.seek_s, 0.0);
}

TEST_F(Sender, steps_add_up_while_a_place_is_looked_for) {
    ReplayTopic replay = replay_at(5.0);
    EXPECT_EQ(after(TimelineAction::step, -1.0, replay).seek_step, 4999U);
    EXPECT_TRUE(sender_.waits(replay));
    EXPECT_EQ(after(TimelineAction::step, -1.0, replay).seek_step, 4998U);
    replay.seeks = 2;  // found
    replay.step = 4998;
    EXPECT_FALSE(sender_.waits(replay));
    EXPECT_EQ(after(TimelineAction::step, 1.0, replay).seek_step, 4999U);
    EXPECT_EQ(after(TimelineAction::step, -1e6, replay).seek_step, 1U);
}

TEST(ReplayCommands, are_not_sent_and_say_why) {
    auto queue = std::make_unique<CommandQueue>();
    CommandSender sender(*queue);
    sender.close("nothing is sent in a replay");
    EXPECT_TRUE(sender.send({.kind = CommandKind::arm}, 1));
    EXPECT_EQ(sender.sequence(), 0U);
    EXPECT_EQ(sender.stage(), CommandSender::Stage::refused);
    EXPECT_EQ(sender.text(), "arm: nothing is sent in a replay");
    sender.close("");
    EXPECT_TRUE(sender.send({.kind = CommandKind::arm}, 1));
    EXPECT_EQ(sender.sequence(), 1U);
}

TEST(ReplayTopics, that_are_impossible_are_refused) {
    const ReplayTopic good = replay_at(5.0);
    EXPECT_TRUE(sensible(good));
    const auto bad = [&](auto change) {
        ReplayTopic r = good;
        change(r);
        return !sensible(r);
    };
    EXPECT_TRUE(bad([](auto& r) { r.at_s = -1.0; }));
    EXPECT_TRUE(bad([](auto& r) { r.duration_s = std::nan(""); }));
    EXPECT_TRUE(bad([](auto& r) { r.speed = 0.0; }));
    EXPECT_TRUE(bad([](auto& r) { r.seek_share = 1.5; }));
    EXPECT_TRUE(bad([](auto& r) { r.act = 9; }));
    EXPECT_TRUE(bad([](auto& r) { std::memset(r.name, 'x', sizeof r.name); }));
    ReplayMarks marks{};
    marks.count = 1;
    EXPECT_TRUE(sensible(marks));
    marks.mark[0].at_s = std::nan("");
    EXPECT_FALSE(sensible(marks));
    marks.count = 1000;
    EXPECT_FALSE(sensible(marks));
}

}  // namespace
}  // namespace tact::gui_timeline_test
