// The timeline of a live run.
#include <algorithm>
#include <cmath>

#include "gui/dashboard/letters.hpp"
#include "gui/dashboard/timeline.hpp"
#include "gui/dashboard/widgets.hpp"

namespace tact {

void draw_past(const Theme& theme, PastState& state, const PixelRect& card) {
    begin_card(theme, "Timeline", card);
    ImGui::SameLine(0.0F, theme.px(12.0F));
    text_small(theme, colour::kDim, format("-%.0f s", PastState::kLengthS), false);
    ImGui::SameLine(0.0F, theme.px(8.0F));
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 size{std::max(ImGui::GetContentRegionAvail().x - theme.px(52.0F), theme.px(40.0F)),
                      ImGui::GetTextLineHeight()};
    const bool pressed = ImGui::InvisibleButton("##past", size);
    const bool over = ImGui::IsItemHovered();
    const float middle = at.y + 0.5F * size.y, half = theme.px(3.0F);
    const auto x = [&](double ago_s) {
        return at.x + size.x * static_cast<float>(1.0 - std::clamp(ago_s / PastState::kLengthS, 0.0, 1.0));
    };
    ImDrawList* const draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled({at.x, middle - half}, {at.x + size.x, middle + half}, colour::kGrid, half);
    const float mouse_x = ImGui::GetIO().MousePos.x;
    double ago_s =
        PastState::kLengthS * static_cast<double>(1.0F - std::clamp((mouse_x - at.x) / size.x, 0.0F, 1.0F));
    const PastState::Mark* near = nullptr;
    for (const PastState::Mark& m : state.marks) {
        const float mark_x = x(m.ago_s), high = theme.px(m.grade >= Grade::watch ? 8.0F : 5.0F);
        draw->AddRectFilled({mark_x - theme.px(1.0F), middle - high},
                            {mark_x + theme.px(1.0F), middle + high},
                            m.grade >= Grade::watch ? grade_colour(m.grade) : colour::kDim);
        if (over && std::abs(mark_x - mouse_x) < theme.px(4.0F)) near = &m;
    }
    draw->AddCircleFilled({at.x + size.x, middle}, theme.px(5.0F), colour::kGood, 16);
    if (over) {
        if (near != nullptr) ago_s = near->ago_s;
        draw->AddCircle({x(ago_s), middle}, theme.px(6.0F), colour::kText, 16);
        ImGui::SetTooltip(
            "%s%s%.1f s ago; a click looks back to it in a window of its own, while the run goes on",
            near != nullptr ? noted(near->text) : "", near != nullptr ? ", " : "", ago_s);
    }
    if (pressed) state.wanted_ago_s = ago_s;
    ImGui::SameLine(0.0F, theme.px(10.0F));
    text_small(theme, colour::kGood, "live", false);
    end_card();
}

}  // namespace tact
