// Every state of the dashboard at every size: no text is cut, no two lie on each other, nothing is below the edge of a card. Checked with the letters
// that are drawn.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "gui/dashboard/drawn_texts.hpp"
#include "gui/drilling/drilling_panel.hpp"
#include "gui/field/field_panels.hpp"
#include "gui/surface/surface_panels.hpp"
#include "gui/window/start_controller.hpp"
#include "ipc/topics/text.hpp"
#include "tests/unit/gui_dashboard_fixture.hpp"

namespace tact::gui_layout_test {
namespace {

TEST(DrawnTexts, are_what_was_drawn_where_it_was_drawn) {
    test::TestDashboard d(1280.0F, 720.0F, 1.0F);
    ImGui::NewFrame();
    ImDrawList* const draw = ImGui::GetBackgroundDrawList();
    draw->AddRectFilled({0.0F, 0.0F}, {500.0F, 500.0F}, IM_COL32_WHITE, 6.0F);
    draw->AddText({100.0F, 50.0F}, IM_COL32_WHITE, "Arm the arm µ±Å");
    draw->AddText({101.0F, 51.0F}, IM_COL32_WHITE, "Arm the arm µ±Å");
    draw->AddText({100.0F, 90.0F}, IM_COL32_WHITE, "left   more");
    draw->AddText({300.0F, 90.0F}, IM_COL32_WHITE, "right");
    draw->PushClipRect({0.0F, 120.0F}, {330.0F, 200.0F});
    draw->AddText({300.0F, 130.0F}, IM_COL32_WHITE, "cut at the side");
    draw->AddText({100.0F, 192.0F}, IM_COL32_WHITE, "cut below");
    draw->PopClipRect();
    const ImVec4 fine{0.0F, 0.0F, 330.0F, 400.0F};
    draw->AddText(d.theme.text, d.theme.text->FontSize, {300.0F, 230.0F}, IM_COL32_WHITE, "cut by itself",
                  nullptr, 0.0F, &fine);
    draw->AddText({100.0F, 300.0F}, IM_COL32_WHITE, "below");
    draw->AddText({110.0F, 304.0F}, IM_COL32_WHITE, "above");
    ImGui::Render();
    const auto all = drawn_texts(*ImGui::GetDrawData());
    std::vector<DrawnText> texts;
    std::copy_if(all.begin(), all.end(), std::back_inserter(texts),
                 [](const DrawnText& t) { return t.owner.find("Background") != std::string::npos; });
    ASSERT_EQ(texts.size(), 10U);
    EXPECT_EQ(texts[0].text, "Arm the arm µ±Å");
    EXPECT_NEAR(texts[0].x, 100.0F, 2.0F);
    EXPECT_NEAR(texts[0].w,
                d.theme.text->CalcTextSizeA(d.theme.text->FontSize, 1e9F, 0.0F, "Arm the arm µ±Å").x, 3.0F);
    EXPECT_GE(texts[0].y, 48.0F);  // the ring of Å
    EXPECT_LE(texts[0].y + texts[0].h, 51.0F + d.theme.text->FontSize);
    EXPECT_EQ(texts[2].text, "left");
    EXPECT_EQ(texts[3].text, "more");
    EXPECT_EQ(texts[4].text, "right");
    texts.erase(texts.begin() + 3);
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_EQ(texts[i].cut, i == 4 || i == 6) << texts[i].text;
        EXPECT_EQ(texts[i].cut_below, i == 5) << texts[i].text;
    }
    EXPECT_EQ(texts[4].text.substr(0, 3), "cut");
    EXPECT_LE(texts[4].x + texts[4].w, 330.0F);
    EXPECT_LE(texts[6].x + texts[6].w, 330.5F);
    const auto pairs = overlapping(texts);
    ASSERT_EQ(pairs.size(), 1U);
    EXPECT_EQ(texts[pairs[0].first].text + texts[pairs[0].second].text, "belowabove");
    EXPECT_NE(texts_json(texts).find("{\"text\": \"left\", \"owner\": \"##Background\", \"x\": "),
              std::string::npos)
        << texts_json(texts);
}

// Long but possible values everywhere.
void fill_run(PanelState& s) {
    s.now_ns = 500'000'000'000;
    s.attached = s.have_health = s.have_levels = s.have_devices = s.have_tracker = true;
    HealthTopic& h = s.health;
    h.taken_at_ns = s.now_ns - 20'000'000;
    h.cycle = 480'000;
    h.period_ns = 1'000'000;
    h.force_rate_hz = 996.4;
    h.goal_hz = 1000.0;
    h.lateness_p50_ns = 90;
    h.lateness_p99_ns = 112'000;
    h.lateness_max_ns = 8'430'000;
    h.overruns = 118;
    h.overrun_at_ns = s.now_ns - 3'000'000'000;
    h.deadline_misses = 1234;
    h.deadline_miss_share = 0.0123F;
    h.deadline_missed_at_ns = s.now_ns - 500'000'000;
    h.model_ns_max = 600'000;
    h.state = static_cast<std::uint8_t>(RunState::active);
    h.schedule_flags =
        kScheduleFifo | kSchedulePinned | kScheduleLocked | kScheduleDmaLatency | kScheduleIsolated;
    h.gui_attached = 1;
    h.gui_fps = 28.4;
    h.delay_p50_ns = 900'000;
    h.delay_p99_ns = 1'230'000;
    h.stiffness_n_m_max = 1980.0F;
    h.model_n_m = 1790.0F;
    h.field_gain = 0.83F;
    LevelsTopic& l = s.levels;
    l.count = 4;
    l.display_goal_hz = 30.0F;
    for (std::uint32_t i = 0; i < l.count; ++i) {
        std::snprintf(l.path[i].path, sizeof l.path[i].path, "%s",
                      std::array{"gui.mesh", "rt.docking", "gui.molecules", "gui.resolution"}[i]);
        l.path[i].level = 0.43F;
    }
    s.devices.hand[0].valid = 1;
    s.devices.hand[0].state = 2;
    s.scene.loaded = true;
    s.scene.title = "emd_1080_groel_11.5A.mrc and 1kp8A_fitted_in_emd_1080.pdb";
    s.scene.file = "emd_1080_groel_11-d8a2.tact";
    s.scene.vertices_max = 1'234'567;
    s.command_text = "arm: done";
    s.force_n = 2.34;
    s.arrow_a_per_n = 50.0;
    s.a_per_px = 0.2;
    s.load.fps = 28.4;
    s.load.vertices_drawn = 57'726;
    for (int i = 0; i < 12; ++i)
        s.events.push_back({s.now_ns - 1'000'000'000LL * (4 * i + 1), static_cast<std::uint16_t>(i % 5 + 1),
                            37,
                            i % 2 == 0 ? "level changed: display to 0.26, frame rate above goal"
                                       : "overrun: 8.17 ms late, 4 so far",
                            i % 2 == 0 ? Grade::good : Grade::watch});
    for (int i = 0; i < 100; ++i) {
        s.history.rate_hz.add(5.0 * i, 990.0 + i % 7);
        s.history.frame_s.add(5.0 * i, i == 95 ? 1.5 : 0.03);
        s.history.busy_s.add(5.0 * i, 0.02);
    }
    s.history.now_s = 500.0;
    s.situation.controller = s.situation.bodies = true;
    s.past.shown = true;
    s.past.marks = {{4.0, Grade::watch, "overrun: 8.17 ms late, 4 so far"}, {29.0, Grade::good, "armed"}};
}

void fill_docking(DockingPanels& p) {
    p.scene = {.contour = 1.234,
               .contour_sigma = 2.1,
               .resolution_m = 11.5e-10,
               .voxels = {180, 200, 220},
               .bodies = 3,
               .atoms = 26929};
    p.fit.known = true;
    p.fit.status = "computing";
    p.fit.bodies = 3;
    p.fit.body_id = 2;
    p.fit.pose_known = true;
    p.fit.from_file_m = 123.45e-10;
    p.fit.from_file_rad = 3.0;
    p.fit.contour = 1.234;
    p.fit.resolution_m = 11.5e-10;
    for (std::uint32_t i = 1; i <= 5; ++i)
        p.fitting.bodies.push_back({.id = i,
                                    .name = "1kp8A_fitted_in_emd_1080.pdb",
                                    .atoms = 3847,
                                    .in_hand = i == 2,
                                    .fixed = i == 1});
    p.fitting.can_undo = p.fitting.can_redo = p.fitting.can_bend = true;
    p.fitting.message =
        "refined: correlation about the mean 0.9748 (0.8123 before), 4.5 A and 12 degrees away";
    p.fitting.snapshots = {"snapshot 1"};
    for (int i = 0; i < 12; ++i) p.fitting.search.found.push_back({0.87, 12.3, 98e-10, 41});
    p.fitting.search.found_body = 2;
    p.fitting.search.found_name = "1kp8A_fitted_in_emd_1080.pdb";
    p.contours.rows_max = 4;
    p.contours.greatest = 4.0;
    p.contours.histogram.assign(64, 1000);
    for (int i = 0; i < 4; ++i) {
        ContourRow row;
        row.level = 1.2345;
        row.sigma = 2.13;
        row.fraction_inside = 0.0123;
        p.contours.row.push_back(row);
    }
}

struct Size {
    float width = 0.0F, height = 0.0F;
};
constexpr Size kSizes[] = {{320.0F, 240.0F},  {640.0F, 480.0F},   {1280.0F, 720.0F},
                           {1280.0F, 800.0F}, {1920.0F, 1080.0F}, {3840.0F, 2160.0F}};

// What is wrong with the frame that was drawn last. Rows of a list that scrolls may end at its edge.
std::string faults() {
    const auto texts = drawn_texts(*ImGui::GetDrawData());
    std::string found;
    const ImGuiContext& g = *ImGui::GetCurrentContext();
    const auto scrolls = [&](const std::string& name) {
        return std::any_of(g.Windows.begin(), g.Windows.end(), [&](const ImGuiWindow* w) {
            return w->Active && name == w->Name && w->ScrollMax.y > 0.0F &&
                   (w->Flags & ImGuiWindowFlags_NoScrollbar) == 0;
        });
    };
    for (const DrawnText& t : texts)
        if (t.cut || (t.cut_below && !scrolls(t.owner)))
            found += "cut in " + t.owner + ": '" + t.text + "'\n";
    for (const auto& [a, b] : overlapping(texts))
        found +=
            "on each other in " + texts[a].owner + ": '" + texts[a].text + "' and '" + texts[b].text + "'\n";
    for (const ImGuiWindow* w : g.Windows) {
        if (!w->Active || w->Hidden || (w->Flags & ImGuiWindowFlags_ChildWindow) != 0) continue;
        if ((w->Flags & ImGuiWindowFlags_NoScrollbar) != 0 && w->ScrollMax.y > 1.0F)
            found +=
                "below the edge of " + std::string(w->Name) + ": " + std::to_string(w->ScrollMax.y) + " px\n";
        if (w->ScrollMax.x > 1.0F) found += "beside the edge of " + std::string(w->Name) + "\n";
    }
    return found;
}

class Layouts : public testing::TestWithParam<Size> {
protected:
    void expect_clean(const char* state, const std::function<void(PanelState&, DockingPanels&)>& change) {
        SCOPED_TRACE(state);
        const float width = GetParam().width, height = GetParam().height;
        test::TestDashboard d(width, height, theme_scale(static_cast<int>(width), static_cast<int>(height)));
        fill_run(d.state);
        fill_docking(d.panels);
        change(d.state, d.panels);
        for (int i = 0; i < 3; ++i) d.frame();
        EXPECT_EQ(faults(), "");
    }
};

TEST(SmallWindow, has_the_state_and_the_buttons_needed_first_below_a_view_of_its_full_width) {
    test::TestDashboard d(320.0F, 240.0F, theme_scale(320, 240));
    fill_run(d.state);
    fill_docking(d.panels);
    for (int i = 0; i < 3; ++i) d.frame();
    const Layout l = layout_for(d.theme, 320.0F, 240.0F, middle_card(d.state, d.panels), strip_of(d.state));
    EXPECT_TRUE(l.compact);
    EXPECT_EQ(l.view.width, 320.0F);
    EXPECT_GT(l.view.height, 170.0F);
    std::string all;
    for (const DrawnText& t : drawn_texts(*ImGui::GetDrawData())) all += t.text + "\n";
    for (const char* const text : {"ACTIVE", "996 Hz", "Disarm", "model force 2.34 N"})
        EXPECT_NE(all.find(text), std::string::npos) << text << " in\n" << all;
    d.click("Controller", "Disarm");
    ASSERT_EQ(d.state.requests.size(), 1U);
    EXPECT_EQ(d.state.requests[0].kind, CommandKind::disarm);
    EXPECT_FALSE(layout_for(d.theme, 640.0F, 480.0F, {}, {}).compact);
}

TEST_P(Layouts, of_docking_are_clean_in_every_tab) {
    for (int tab = 0; tab < 4; ++tab)
        expect_clean(("tab " + std::to_string(tab)).c_str(),
                     [&](PanelState& s, DockingPanels&) { s.tab = tab; });
    expect_clean("traces", [](PanelState& s, DockingPanels&) { s.strip = 1; });
    expect_clean("coloured by fit", [](PanelState& s, DockingPanels&) {
        s.tab = 3;
        s.toggles.colouring = 3;
    });
    expect_clean("nothing placed", [](PanelState&, DockingPanels& p) {
        p.fit = {};
        p.fitting = {};
        p.contours = {};
    });
}

TEST_P(Layouts, of_every_state_of_a_run_are_clean) {
    expect_clean("waiting", [](PanelState& s, DockingPanels&) {
        const Theme theme;
        s = PanelState{};
        s.link_text = "Waiting for a controller of session default.";
        s.scene.status = "No scene yet: start a controller, or give a scene as an argument.";
    });
    for (const RunState state :
         {RunState::off, RunState::ready, RunState::armed, RunState::active, RunState::fault})
        for (int reason = 0; reason < 24; ++reason) {
            if (state != RunState::fault && reason > 0) continue;
            if (state == RunState::fault &&
                std::string(run_reason_text(static_cast<RunReason>(reason))).empty())
                continue;
            expect_clean((std::string(run_state_text(state)) + ", reason " + std::to_string(reason)).c_str(),
                         [&](PanelState& s, DockingPanels&) {
                             s.health.state = static_cast<std::uint8_t>(state);
                             s.health.reason = static_cast<std::uint8_t>(reason);
                         });
        }
    expect_clean("replay", [](PanelState& s, DockingPanels&) {
        s.replay.shown = true;
        std::snprintf(s.replay.now.name, sizeof s.replay.now.name,
                      "2026-11-28_085312_recording-of-a-long-name.h5");
        s.replay.now.duration_s = 130.0;
        s.replay.now.at_s = 12.345;
    });
    expect_clean("an instructor's window", [](PanelState& s, DockingPanels&) { s.watching = true; });
    expect_clean("a stereo display", [](PanelState& s, DockingPanels&) {
        s.stage = "stereo: side by side; head lost for 12 s";
        s.head_lost = true;
    });
    expect_clean("a stereo display that the driver refused", [](PanelState& s, DockingPanels&) {
        s.stage_refused =
            "Stereo is off, because the driver offers no quad-buffered stereo. To have it, enable stereo in "
            "the settings of the graphics driver, or use another mode: side-by-side, top-bottom, two-windows "
            "or anaglyph (--stereo MODE, or mode in the stage file).";
    });
    expect_clean("a second hand", [](PanelState& s, DockingPanels&) {
        s.second_hand = s.second_at_wall = true;
        s.devices.hand[1] = s.devices.hand[0];
    });
    expect_clean("the table of keys", [](PanelState& s, DockingPanels&) { s.situation.sheet = true; });
    expect_clean("frame times", [](PanelState& s, DockingPanels&) { s.toggles.frame_times = true; });
    expect_clean("how the view is drawn", [](PanelState& s, DockingPanels&) {
        s.picture.open = true;
        s.picture.result = {Grade::good, "saved: /home/somebody/Tact/2026-11-28_113332_picture.png"};
    });
    expect_clean("what SpaceMouse and gamepad do", [](PanelState& s, DockingPanels&) {
        s.input.open = true;
        s.input.choice[0].role = s.input.choice[1].role = static_cast<int>(InputRole::hand);
        s.input.device[0].text =
            "spacenavd does not answer at /var/run/spnav.sock. Start it again: sudo systemctl restart "
            "spacenavd.";
        s.input.device[1] = {true, "Microsoft Xbox Series S|X Controller"};
        s.mouse.waits = "SpaceMouse: not found. Install and start spacenavd.";
        s.mouse.waits_in_vain = true;
    });
    for (const int device : {0, 1})
        expect_clean("a tool that a device leads", [device](PanelState& s, DockingPanels&) {
            s.mouse.holds = true;
            s.mouse.device = device;
        });
    expect_clean("a device that is gone", [](PanelState& s, DockingPanels&) {
        s.mouse.holds = s.mouse.gone = true;
        s.mouse.device = 0;
    });
    expect_clean("labels over a cut, on white",
                 [](PanelState& s, DockingPanels&) { s.toggles.cut = s.toggles.white_ground = true; });
    expect_clean("the list of scenes", [](PanelState& s, DockingPanels&) {
        s.browser.open = true;
        SceneRow row;
        row.path = "/data/em/emd_1080_groel_11.tact";
        row.name = "emd_1080_groel_11.5A.mrc and 1oel.pdb";
        row.place = "/data/em/of/a/long/name/of/a/folder/that/goes/on";
        row.kind = "docking";
        row.size = "123 MB";
        row.when = "3 days ago";
        s.browser.recent.assign(30, row);
        s.browser.message = "The import was cancelled; nothing was written.";
    });
}

TEST_P(Layouts, of_the_other_systems_are_clean) {
    const float width = GetParam().width, height = GetParam().height;
    const auto expect_clean_with = [&](const char* what, SystemPanels& panels,
                                       const std::function<void(PanelState&)>& change) {
        SCOPED_TRACE(what);
        test::TestDashboard d(width, height, theme_scale(static_cast<int>(width), static_cast<int>(height)));
        fill_run(d.state);
        d.state.situation.bodies = false;
        change(d.state);
        for (int i = 0; i < 3; ++i) {
            ImGui::NewFrame();
            draw_dashboard(d.theme, d.state, panels, width, height);
            ImGui::Render();
        }
        EXPECT_EQ(faults(), "");
    };
    SurfacePanels surface;
    surface.detail.finest_m = 1e-4;
    FieldPanels field;
    field.field = {.known = true,
                   .inside = true,
                   .unit = "kcal/(mol e)",
                   .potential = -123.456,
                   .slope = 1.234e-5,
                   .low = -1234.5,
                   .high = 999.4,
                   .force_n = 2.34,
                   .force_n_max = 3.0,
                   .stiffness_n_m = 1234.0,
                   .probe_mm = 1.25};
    DrillingPanels drill;
    DrillingState& s = drill.drilling;
    s.known = s.labelled = s.held_in = true;
    s.burr.valid = s.suction_tube.valid = true;
    s.burr.diameter_m = 6e-3;
    s.burr.rpm = 80000.0;
    s.burr.water = s.suction_tube.suction = true;
    s.removed_m3 = 1234.5e-9;
    s.dust = {123e-9, 1234e-9, 12e-9, 3e-9};
    s.force_n = 2.34;
    s.drilling_s = 1234.0;
    s.excess_s = 12.0;
    s.strokes = 123;
    s.injuries = 2;
    s.stroke_m = 0.012;
    s.stroke_m_s = 0.034;
    s.undoable = s.redoable = 3;
    s.nearness = Grade::bad;
    for (const char* const name : {"facial nerve, vertical part", "sigmoid sinus", "dura of the middle fossa",
                                   "chorda tympani", "lateral semicircular canal"}) {
        DrillingState::Structure structure;
        structure.name = name;
        structure.burr_m = 0.8e-3;
        structure.closing_m_s = 0.01;
        structure.suction_tube_m = 2e-3;
        structure.side = "PL";
        s.structures.push_back(structure);
    }
    drill.voxels = {512, 512, 512};
    drill.voxel_m = 96e-6;
    drill.sound = "no sound device";
    for (const bool open : {false, true}) {
        const auto change = [open](PanelState& state) {
            state.picture.open = open;
            state.toggles.detail = !open;
        };
        expect_clean_with("surface", surface, change);
        expect_clean_with("field", field, change);
        expect_clean_with("drilling", drill, change);
    }
}

TEST_P(Layouts, of_the_start_page_are_clean) {
    const float width = GetParam().width, height = GetParam().height;
    test::TestDashboard d(width, height, theme_scale(static_cast<int>(width), static_cast<int>(height)));
    StartPageState page;
    page.demos = demo_cards();
    SceneRow row;
    row.path = "/home/somebody/.cache/tact/dock-0123456789abcdef.tact";
    row.name = "emd_1080_groel_11.5A.mrc and 1kp8A_fitted_in_emd_1080.pdb and 1oel_without_water.pdb";
    row.kind = "docking";
    row.when = "2026-11-20";
    BrowserState lists;
    const auto expect_clean = [&](const char* what) {
        SCOPED_TRACE(what);
        for (int i = 0; i < 3; ++i) {
            ImGui::NewFrame();
            draw_start_page(d.theme, page, lists, {0.0F, 0.0F, width, height});
            ImGui::Render();
        }
        EXPECT_EQ(faults(), "");
    };
    expect_clean("at first");
    lists.recent.assign(30, row);
    page.device.status = {
        Grade::watch,
        "device.driver = \"phantom-usb\", serial 1234567: the device is there, but its group has "
        "no right to open it"};
    page.computer.status = {Grade::bad,
                            "no OpenGL 3.3: cannot open the driver of the graphics card (and 12 more: "
                            "tact doctor)"};
    expect_clean("long findings");
    page.preparing = true;
    page.share = 0.4;
    page.message.text =
        "Preparing the demo, once: [ 40 %] sampling the bone and its labels at 256 x 256 x 256 voxels";
    expect_clean("a demo is prepared");
}

INSTANTIATE_TEST_SUITE_P(Sizes, Layouts, testing::ValuesIn(kSizes), [](const auto& size) {
    return std::to_string(static_cast<int>(size.param.width)) + "x" +
           std::to_string(static_cast<int>(size.param.height));
});

}  // namespace
}  // namespace tact::gui_layout_test
