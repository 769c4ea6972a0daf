#include "gui/surface/surface_panels.hpp"

#include <array>
#include <cmath>

#include "gui/dashboard/widgets.hpp"
#include "ipc/base/units.hpp"

namespace tact {
namespace {

// Rounds up to 1, 2 or 5 times a power of ten.
double round_up(double least) {
    const double power = std::pow(10.0, std::floor(std::log10(least) + 1e-9));
    for (const double times : {1.0, 2.0, 5.0})
        if (least <= times * power * (1.0 + 1e-6)) return times * power;
    return 10.0 * power;
}

}  // namespace

void SurfacePanels::draw_in_scene_card(const Theme& theme, DashboardState& state) {
    row(theme, "Surface", grouped(state.load.vertices_drawn),
        format("of %s vertices", grouped(state.scene.vertices_max).c_str()));
    ImGui::Checkbox("Surface", &state.toggles.surface);
    ImGui::SameLine(theme.px(104.0F));
    ImGui::Checkbox("Frame times", &state.toggles.frame_times);
    static constexpr std::array<const char*, 3> kStyles{"glass", "solid", "wire"};
    text_coloured(colour::kDim, "Surface as");
    ImGui::SameLine(theme.px(104.0F));
    choose(theme, kStyles, state.toggles.style);
    draw_detail(theme, detail, state.toggles.detail);
}

void SurfacePanels::add_legend(const DashboardState& state, std::vector<LegendLine>& lines) const {
    if (state.toggles.force && state.attached)
        lines.push_back({colour::kNormal, "contact points and forces"});
}

std::string SurfacePanels::drawn_text(const DashboardState& state) const {
    return format("%s vertices", grouped(state.load.vertices_drawn).c_str());
}

// Short edges at the top.
void SurfacePanels::draw_over_view(const OverlayPen& pen, const DashboardState& state,
                                   const PixelRect& v) const {
    const DetailState& d = detail;
    if (!state.toggles.detail || !(d.finest_m > 0.0)) return;
    const float w = pen.theme.px(12.0F), h = pen.theme.px(132.0F);
    const float x = v.x + v.width - pen.theme.px(100.0F), y0 = v.y + pen.theme.px(84.0F);
    pen.text(pen.theme.small, {x, y0 - pen.theme.px(22.0F)}, colour::kText, "edge length");
    const auto steps = static_cast<float>(d.colours.size());
    for (std::size_t i = 0; i < d.colours.size(); ++i) {
        const float top = y0 + h * static_cast<float>(i) / steps;
        pen.draw->AddRectFilled({x, top}, {x + w, top + h / steps + 1.0F}, d.colours[i]);
    }
    // Round lengths between the ends, at least one text line apart.
    const double octaves = std::log2(d.coarsest_m / d.finest_m);
    float last = y0 - h;
    double length = round_up(d.finest_m);
    while (length <= d.coarsest_m * 1.001) {
        const float y = y0 + h * static_cast<float>(std::log2(length / d.finest_m) / octaves);
        if (y >= last + 1.1F * pen.theme.small->FontSize) {
            last = y;
            pen.draw->AddRectFilled({x + w, y - 0.5F}, {x + w + pen.theme.px(4.0F), y + 0.5F}, colour::kText);
            pen.text(pen.theme.small, {x + w + pen.theme.px(8.0F), y - 0.5F * pen.theme.small->FontSize},
                     colour::kText, length_text(length));
        }
        length = round_up(1.001 * length);
    }
}

}  // namespace tact
