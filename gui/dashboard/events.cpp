// Events panel: newest first, with their age.
#include <algorithm>

#include "gui/dashboard/panels.hpp"
#include "gui/dashboard/widgets.hpp"

namespace tact {
namespace {

std::string age_text(std::int64_t ns) {
    const double s = 1e-9 * static_cast<double>(ns);
    if (s < 99.5) return format("%.0f s", s < 0.0 ? 0.0 : s);
    if (s < 5970.0) return format("%.0f min", s / 60.0);
    return format("%.0f h", s / 3600.0);
}

}  // namespace

void draw_events(const Theme& theme, DashboardState& state, const PixelRect& card) {
    begin_card(theme, "Events", card, true);
    ImGui::SameLine(0.0F, theme.px(14.0F));
    ImGui::PushFont(theme.small);
    static constexpr const char* kChoices[] = {"all", "warnings", "faults"};
    choose(theme, kChoices, state.events_choice);
    ImGui::PopFont();
    if (state.events_missed > 0) {
        ImGui::SameLine();
        text_small(theme, colour::kWatch,
                   format("%llu missed", static_cast<unsigned long long>(state.events_missed)), false);
    }
    const auto chosen = [&](const EventLine& e) {
        return state.events_choice == 0 || e.grade == Grade::bad ||
               (state.events_choice == 1 && e.grade == Grade::watch);
    };
    if (std::none_of(state.events.begin(), state.events.end(), chosen))
        text_small(theme, colour::kDim, state.events.empty() ? "none yet" : "none of these");
    ImGui::PushFont(theme.small);
    for (const EventLine& e : state.events) {
        if (!chosen(e)) continue;
        text_coloured(colour::kDim, age_text(state.now_ns - e.taken_at_ns));
        ImGui::SameLine(theme.px(44.0F));
        ImGui::PushTextWrapPos(0.0F);
        text_coloured(
            e.grade == Grade::good || e.grade == Grade::unknown ? colour::kText : grade_colour(e.grade),
            e.count > 1 ? e.text + format("  (%llu times)", static_cast<unsigned long long>(e.count))
                        : e.text);
        ImGui::PopTextWrapPos();
        if (!state.replay.shown) continue;
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("click: show this moment");
        if (ImGui::IsItemClicked())
            state.replay.requests.push_back({TimelineAction::seek, state.history.at_s(e.taken_at_ns)});
    }
    ImGui::PopFont();
    end_card();
}

}  // namespace tact
