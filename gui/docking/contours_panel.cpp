// Contours tab: the map's histogram with the levels, and for each its unit, sigma and enclosed volume.
#include <algorithm>
#include <array>
#include <cmath>

#include "gui/dashboard/widgets.hpp"
#include "gui/docking/docking_panels.hpp"

namespace tact {
namespace {

ImU32 colour_of(const ContourRow& c) {
    const auto byte = [](float v) {
        return static_cast<int>(std::lround(255.0F * std::clamp(v, 0.0F, 1.0F)));
    };
    return IM_COL32(byte(c.colour[0]), byte(c.colour[1]), byte(c.colour[2]), 255);
}

// Counts on a logarithmic scale; a drag moves the nearest level.
void histogram(const Theme& theme, ContourRowState& state) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 size{ImGui::GetContentRegionAvail().x, theme.px(54.0F)};
    ImGui::InvisibleButton("##histogram", {std::max(size.x, 1.0F), size.y});
    const double span = state.greatest - state.least;
    if (!(span > 0.0) || state.histogram.empty()) return;
    const auto x_of = [&](double level) {
        return at.x + size.x * static_cast<float>((level - state.least) / span);
    };
    if (ImGui::IsItemActive()) {
        const double level =
            state.least + span * static_cast<double>((ImGui::GetIO().MousePos.x - at.x) / size.x);
        if (ImGui::IsItemActivated()) {
            const auto nearest = std::min_element(
                state.row.begin(), state.row.end(), [&](const ContourRow& a, const ContourRow& b) {
                    return std::abs(a.level - level) < std::abs(b.level - level);
                });
            state.dragged = static_cast<std::size_t>(nearest - state.row.begin());
        }
        if (state.dragged < state.row.size()) {
            state.row[state.dragged].level = std::clamp(level, state.least, state.greatest);
            state.changed = true;
        }
    }
    ImDrawList* const draw = ImGui::GetWindowDrawList();
    const std::uint64_t most = *std::max_element(state.histogram.begin(), state.histogram.end());
    const float top = std::log1p(static_cast<float>(most));
    const float width = size.x / static_cast<float>(state.histogram.size());
    for (std::size_t i = 0; i < state.histogram.size(); ++i) {
        const float h = size.y * std::log1p(static_cast<float>(state.histogram[i])) / std::max(top, 1e-6F);
        const float x = at.x + width * static_cast<float>(i);
        draw->AddRectFilled({x, at.y + size.y - h}, {x + std::max(width - 1.0F, 1.0F), at.y + size.y},
                            colour::kGrid);
    }
    for (const ContourRow& c : state.row)
        draw->AddRectFilled({x_of(c.level) - 1.0F, at.y}, {x_of(c.level) + 1.0F, at.y + size.y},
                            colour_of(c));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("voxels at each density, log scale; drag a level");
}

void one(const Theme& theme, ContourRowState& state, std::size_t i) {
    static constexpr std::array<const char*, 4> kStyles{"as view", "glass", "solid", "wire"};
    ContourRow& c = state.row[i];
    ImGui::PushID(static_cast<int>(i));
    if (state.row.size() > 1 && i == state.chosen_row()) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        ImGui::GetWindowDrawList()->AddRectFilled({at.x - theme.px(5.0F), at.y},
                                                  {at.x - theme.px(2.0F), at.y + ImGui::GetFrameHeight()},
                                                  colour::kAccent);
    }
    bool changed = ImGui::Checkbox("##shown", &c.shown);
    ImGui::SameLine();
    changed |=
        ImGui::ColorEdit3("##colour", c.colour, ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_NoLabel);
    ImGui::SameLine();
    ImGui::SetNextItemWidth(theme.px(92.0F));
    auto level = static_cast<float>(c.level);
    const auto step = static_cast<float>((state.greatest - state.least) / 400.0);
    if (ImGui::DragFloat("##level", &level, step, static_cast<float>(state.least),
                         static_cast<float>(state.greatest), "%.4g")) {
        c.level = static_cast<double>(level);
        changed = true;
    }
    ImGui::SameLine();
    text_coloured(colour::kText, format("%.2f σ", c.sigma));
    ImGui::SameLine();
    text_coloured(colour::kDim, format("%.2f %% inside", 100.0 * c.fraction_inside));
    ImGui::SetNextItemWidth(theme.px(86.0F));
    changed |= ImGui::Combo("##style", &c.style, kStyles.data(), static_cast<int>(kStyles.size()));
    ImGui::SameLine();
    ImGui::SetNextItemWidth(theme.px(92.0F));
    changed |= ImGui::SliderFloat("##opacity", &c.opacity, 0.1F, 1.0F, "opacity %.1f");
    if (state.row.size() > 1) {
        ImGui::SameLine();
        if (ImGui::SmallButton("remove")) state.removed = i;
    }
    if (!c.error.empty()) text_small(theme, colour::kWatch, c.error);
    state.changed |= changed;
    ImGui::PopID();
}

}  // namespace

void draw_contours_tab(const Theme& theme, ContourRowState& state) {
    histogram(theme, state);
    for (std::size_t i = 0; i < state.row.size(); ++i) one(theme, state, i);
    if (state.removed < state.row.size()) {
        state.row.erase(state.row.begin() + static_cast<std::ptrdiff_t>(state.removed));
        state.changed = true;
    }
    state.removed = ContourRowState::kNone;
    ImGui::BeginDisabled(state.row.size() >= state.rows_max);
    if (ImGui::Button("Add a contour")) state.add = true;
    ImGui::EndDisabled();
    if (state.row.size() > 1)
        text_small(theme, colour::kDim, "Alt+wheel moves the marked one, Ctrl+wheel marks another");
    const auto moving = std::any_of(state.row.begin(), state.row.end(),
                                    [](const ContourRow& c) { return c.shown && !c.final; });
    if (moving) text_small(theme, colour::kDim, "coarse while dragging; the full surface follows");
}

}  // namespace tact
