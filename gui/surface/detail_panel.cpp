// Detail panel: radius of full detail around the tool, coarseness beyond it, and the filter between.
#include <algorithm>
#include <array>
#include <cmath>

#include "gui/dashboard/widgets.hpp"
#include "gui/surface/detail_panel.hpp"

namespace tact {
namespace {

// Fraction of the far error allowed at a distance from the tool (in radii), by the filter's form.
double allowed(const DetailState& d, double distance) {
    const double x = (distance - 1.0) / static_cast<double>(d.width);
    if (x <= 0.0) return 0.0;
    if (d.shape == 0) return 1.0 - std::exp(-x * x);
    static constexpr std::array<std::array<double, 2>, 4> kCorners{
        {{0.0, 0.1}, {0.5, 0.4}, {1.0, 0.7}, {2.0, 1.0}}};
    for (std::size_t i = 1; i < kCorners.size(); ++i) {
        const auto &a = kCorners[i - 1], &b = kCorners[i];
        if (x < b[0]) return a[1] + (x - a[0]) / (b[0] - a[0]) * (b[1] - a[1]);
    }
    return 1.0;
}

void curve(const Theme& theme, const DetailState& d) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 size{ImGui::GetContentRegionAvail().x, theme.px(58.0F)};
    ImGui::InvisibleButton("##filter", {std::max(size.x, 1.0F), size.y});
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("allowed error by distance from the tool (largest of |dx|, |dy|, |dz|)");
    ImDrawList* const draw = ImGui::GetWindowDrawList();
    const double most = 1.0 + 3.0 * static_cast<double>(d.width);
    const auto point = [&](double distance) {
        return ImVec2(at.x + size.x * static_cast<float>(distance / most),
                      at.y + size.y * (1.0F - 0.9F * static_cast<float>(allowed(d, distance))) - 1.0F);
    };
    draw->AddRectFilled(at, {point(1.0).x, at.y + size.y}, IM_COL32(253, 231, 37, 40));  // full detail
    constexpr int kPieces = 96;
    for (int i = 0; i < kPieces; ++i)
        draw->AddLine(point(most * i / kPieces), point(most * (i + 1) / kPieces), colour::kAccent,
                      theme.px(1.5F));
    draw->AddText(theme.small, theme.small->FontSize, {at.x + theme.px(4.0F), at.y}, colour::kDim, "full");
    const std::string end = length_text(most * d.radius_m);
    draw->AddText(
        theme.small, theme.small->FontSize,
        {at.x + size.x - theme.small->CalcTextSizeA(theme.small->FontSize, 1e9F, 0.0F, end.c_str()).x,
         at.y + size.y - theme.small->FontSize},
        colour::kDim, end.c_str());
}

bool number(const Theme& theme, const char* what, const char* id, float& value, DetailState& d) {
    text_coloured(colour::kDim, what);
    ImGui::SameLine(theme.px(104.0F));
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
    const std::string shown =
        format("%%.2f radii, %s", length_text(static_cast<double>(value) * d.radius_m).c_str());
    ImGui::DragFloat(id, &value, 0.01F * value, 0.05F, 20.0F, shown.c_str(),
                     ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    d.editing = d.editing || ImGui::IsItemActive();
    return ImGui::IsItemDeactivatedAfterEdit();
}

void form(const Theme& theme, DetailState& d) {
    static constexpr std::array<const char*, 2> kShapes{"bell", "multiple frustum"};
    text_coloured(colour::kDim, "Filter");
    ImGui::SameLine(theme.px(104.0F));
    const int before = d.shape;
    ImGui::PushID("shape");
    choose(theme, kShapes, d.shape);
    ImGui::PopID();
    d.editing = false;
    bool changed = d.shape != before;
    changed |= number(theme, "Falloff width", "##width", d.width, d);
    changed |= number(theme, "Far error", "##far", d.error_far, d);
    d.changed = d.changed || changed;
    curve(theme, d);
}

void detail_rows(const Theme& theme, const DetailState& d) {
    row(theme, "Full detail", length_text(d.radius_m), "around the tool");
    row(theme, "Active", grouped(d.triangles), format("triangles, %s vertices", grouped(d.vertices).c_str()));
    row(theme, "Elsewhere", "≤ " + length_text(d.deviation_m), "from the full mesh");
    if (d.felt) {
        row(theme, "Update", duration_text(d.turn_s),
            d.turn_predicted_s > 0.0 ? "of 4 ms, " + duration_text(d.turn_predicted_s) + " to build"
                                     : std::string("of 4 ms"));
        text_small(theme, d.full ? colour::kGood : colour::kWatch,
                   d.full ? "Full mesh in use (no refinement error)."
                          : "Not refined here yet; full mesh in use (tree search).");
    } else {
        text_small(theme, colour::kDim,
                   "Display only: the controller uses the full mesh (--mode chr refines it).");
    }
}

}  // namespace

void draw_detail(const Theme& theme, DetailState& d, bool& shown) {
    if (!d.possible) return;
    ImGui::Checkbox("Detail as colour", &shown);
    if (!d.error.empty()) text_small(theme, colour::kWatch, d.error);
    if (!shown) return;
    form(theme, d);
    detail_rows(theme, d);
}

}  // namespace tact
