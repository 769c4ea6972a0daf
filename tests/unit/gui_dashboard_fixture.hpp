// The dashboard without a window: ImGui on a virtual display, with a mouse that the test moves.
#pragma once

#include <gtest/gtest.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "gui/dashboard/letters.hpp"
#include "gui/docking/docking_panels.hpp"
#include "gui/window/layout.hpp"

namespace tact::test {

class TestDashboard {
public:
    TestDashboard(float width_px, float height_px, float scale) : width_(width_px), height_(height_px) {
        IMGUI_CHECKVERSION();
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.LogFilename = nullptr;
        io.DisplaySize = {width_, height_};
        letters_on_screen().clear();
        build_theme(theme, scale);
        upload();
        frame();
        frame();
    }
    ~TestDashboard() { ImGui::DestroyContext(); }
    TestDashboard(const TestDashboard&) = delete;
    TestDashboard& operator=(const TestDashboard&) = delete;

    void frame() {
        ImGui::GetIO().DeltaTime = 1.0F / 60.0F;
        ImGui::NewFrame();
        draw_dashboard(theme, state, panels, width_, height_);
        ImGui::Render();
    }
    // As the window does before a frame, and again when the search is over. True: there are new letters.
    bool find_letters(Instant at) {
        bool found = follow_letters(theme, at);
        if (theme.finding.valid()) {
            theme.finding.wait();
            found = follow_letters(theme, at) || found;
        }
        if (found) upload();
        return found;
    }
    void move(ImVec2 to) {
        ImGui::GetIO().MousePos = to;
        frame();
    }
    void press(ImVec2 at) {
        move(at);
        ImGui::GetIO().MouseDown[0] = true;
        frame();
    }
    void release() {
        ImGui::GetIO().MouseDown[0] = false;
        frame();
        frame();
    }
    void click(ImVec2 at) {
        press(at);
        release();
    }
    void drag(ImVec2 from, ImVec2 to) {
        press(from);
        move({0.5F * (from.x + to.x), 0.5F * (from.y + to.y)});
        move(to);
        release();
    }
    void wheel(ImVec2 at, float by) {
        move(at);
        ImGui::GetIO().MouseWheel = by;
        frame();
        ImGui::GetIO().MouseWheel = 0.0F;
        frame();
    }
    // The middle of the area in which the mouse hits an item of a card. {0, 0} if there is none.
    ImVec2 find(const char* card, const char* label) {
        ImGuiWindow* const window = ImGui::FindWindowByName(card);
        if (window == nullptr) return {};
        const ImGuiID id = window->GetID(label);
        const float step = 5.0F * theme.scale;
        for (float y = window->Pos.y + 3.0F; y < window->Pos.y + window->Size.y; y += step)
            for (float x = window->Pos.x + 3.0F; x < window->Pos.x + window->Size.x; x += step) {
                move({x, y});
                if (ImGui::GetCurrentContext()->HoveredId != id) continue;
                return {x + 2.0F, y + 2.0F};
            }
        return {};
    }
    void click(const char* card, const char* label) {
        const ImVec2 at = find(card, label);
        ASSERT_GT(at.x, 0.0F) << label << " was not found on the card " << card;
        click(at);
    }

    Theme theme;
    PanelState state;
    DockingPanels panels;

private:
    static void upload() {
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        ImGui::GetIO().Fonts->GetTexDataAsAlpha8(&pixels, &width, &height);
    }
    float width_, height_;
};

}  // namespace tact::test
