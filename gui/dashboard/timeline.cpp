#include "gui/dashboard/timeline.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "gui/dashboard/widgets.hpp"
#include "ipc/topics/text.hpp"

namespace tact {
namespace {

constexpr std::array<double, 7> kSpeeds{0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0};

ReplayAct act_of(const ReplayTopic& replay) { return static_cast<ReplayAct>(replay.act); }

std::string speed_text(double speed) { return format("%g x", speed); }

ImU32 mark_colour(std::uint8_t grade) {
    return grade >= 2 ? colour::kBad : grade == 1 ? colour::kWatch : colour::kDim;
}

void transport(const Theme& theme, ReplayState& state) {
    const ReplayTopic& now = state.now;
    const auto button = [&](const char* name, float width, const char* tip, TimelineRequest request) {
        if (ImGui::Button(name, {theme.px(width), 0.0F})) state.requests.push_back(request);
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tip);
        ImGui::SameLine();
    };
    button("|<", 30.0F, "to the start", {TimelineAction::seek, 0.0});
    button("<", 30.0F, "one step back (,)", {TimelineAction::step, -1.0});
    button(now.plays != 0 && act_of(now) != ReplayAct::ended ? "Pause" : "Play", 60.0F,
           "play or pause (Space)", {TimelineAction::play, 0.0});
    button(">", 30.0F, "one step on (.)", {TimelineAction::step, 1.0});
    ImGui::SetNextItemWidth(theme.px(76.0F));
    if (ImGui::BeginCombo("##speed", speed_text(now.speed).c_str())) {
        for (const double speed : kSpeeds)
            if (ImGui::Selectable(speed_text(speed).c_str(), speed == now.speed))
                state.requests.push_back({TimelineAction::speed, speed});
        ImGui::EndCombo();
    }
    ImGui::SameLine();
}

// Where the mouse is, or -1.
double marks(const Theme& theme, const ReplayState& state, ImVec2 at, ImVec2 size, double mouse_s) {
    ImDrawList* const draw = ImGui::GetWindowDrawList();
    const ReplayTopic& now = state.now;
    const double length_s = std::max(now.duration_s, 1e-6), reach_s = 4.0 / size.x * length_s;
    const auto x = [&](double s) {
        return at.x + static_cast<float>(std::clamp(s / length_s, 0.0, 1.0)) * size.x;
    };
    const float middle = at.y + 0.5F * size.y, half = theme.px(3.0F);
    draw->AddRectFilled({at.x, middle - half}, {at.x + size.x, middle + half}, colour::kGrid, half);
    draw->AddRectFilled({at.x, middle - half}, {x(now.at_s), middle + half}, colour::kAccent, half);
    const ReplayMark* near = nullptr;
    for (std::uint8_t grade = 0; grade <= 2; ++grade)  // the graver ones on top
        for (std::uint32_t i = 0; i < std::min<std::uint32_t>(state.marks.count, ReplayMarks::kMost); ++i) {
            const ReplayMark& m = state.marks.mark[i];
            if (m.grade != grade) continue;
            const float high = theme.px(grade == 0 ? 5.0F : 9.0F);
            draw->AddRectFilled({x(m.at_s) - theme.px(1.0F), middle - high},
                                {x(m.at_s) + theme.px(1.0F), middle + high}, mark_colour(grade));
            if (mouse_s >= 0.0 && std::abs(m.at_s - mouse_s) < reach_s) near = &m;
        }
    const double knob_s = state.dragged_s >= 0.0 ? state.dragged_s : now.at_s;
    draw->AddCircleFilled({x(knob_s), middle}, theme.px(7.0F), colour::kText, 20);
    if (mouse_s < 0.0) return -1.0;
    if (near == nullptr) {
        ImGui::SetTooltip("%.3f s", mouse_s);
        return mouse_s;
    }
    ImGui::SetTooltip("%.3f s: %s", near->at_s, event_code_text(static_cast<EventCode>(near->code)));
    return near->at_s;
}

void line(const Theme& theme, ReplayState& state) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 size{std::max(ImGui::GetContentRegionAvail().x - theme.px(4.0F), theme.px(40.0F)),
                      ImGui::GetFrameHeight()};
    ImGui::InvisibleButton("##line", size);
    const bool held = ImGui::IsItemActive(), over = held || ImGui::IsItemHovered();
    const double share =
        std::clamp(static_cast<double>((ImGui::GetIO().MousePos.x - at.x) / size.x), 0.0, 1.0);
    const double snapped_s = marks(theme, state, at, size, over ? share * state.now.duration_s : -1.0);
    if (held) state.dragged_s = snapped_s;
    // A place is looked for when the mouse is let go: the way back takes a while.
    if (!held && state.dragged_s >= 0.0) {
        state.requests.push_back({TimelineAction::seek, state.dragged_s});
        state.dragged_s = -1.0;
    }
}

void run_from_here(const Theme& theme, ReplayState& state) {
    if (state.now.can_run == 0) return;
    constexpr const char* kName = "Run from here";
    ImGui::PushFont(theme.small);
    const float width = ImGui::CalcTextSize(kName).x + theme.px(16.0F);
    ImGui::SameLine(ImGui::GetWindowWidth() - width - theme.px(12.0F));
    ImGui::BeginDisabled(act_of(state.now) == ReplayAct::seeking);
    if (ImGui::SmallButton(kName)) state.requests.push_back({TimelineAction::run, 0.0});
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
        ImGui::SetTooltip(
            "Ends the replay and starts a live run, not armed, with the bodies and the bone of this moment.");
    ImGui::PopFont();
}

}  // namespace

std::string replay_text(const ReplayTopic& r) {
    std::string of = format("%.3f s of %.1f s", r.at_s, r.duration_s);
    switch (act_of(r)) {
        case ReplayAct::paused:
            return "paused at " + of;
        case ReplayAct::playing:
            return "playing at " + speed_text(r.speed) + ", " + of;
        case ReplayAct::seeking:
            return format("computing the way there: %.0f %%", 100.0 * r.seek_share);
        case ReplayAct::ended:
            return "at the end, " + of;
    }
    return of;
}

void draw_timeline(const Theme& theme, ReplayState& state, const PixelRect& card) {
    begin_card(theme, "Timeline", card);
    const ReplayTopic& now = state.now;
    ImGui::SameLine();
    text_small(theme, colour::kText, replay_text(now), false);
    ImGui::SameLine(0.0F, theme.px(16.0F));
    text_small(theme, colour::kDim,
               format("step %llu of %llu", static_cast<unsigned long long>(now.step),
                      static_cast<unsigned long long>(now.steps)),
               false);
    ImGui::SameLine(0.0F, theme.px(16.0F));
    if (now.whole == 0)
        text_small(theme, colour::kWatch, "begins in the middle of a run: forces may differ", false);
    else if (now.exact == 0)
        text_small(theme, colour::kWatch, "forces differ from the recording", false);
    else
        text_small(theme, colour::kGood, "forces as recorded, to the bit", false);
    if (state.marks.omitted > 0) {
        ImGui::SameLine(0.0F, theme.px(16.0F));
        text_small(theme, colour::kDim, format("%u lesser events not marked", state.marks.omitted), false);
    }
    run_from_here(theme, state);
    transport(theme, state);
    line(theme, state);
    end_card();
}

}  // namespace tact
