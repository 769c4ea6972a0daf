#include "gui/field/field_panels.hpp"

#include <array>

#include "gui/dashboard/widgets.hpp"

namespace tact {

void FieldPanels::draw_card(const Theme& theme, const PixelRect& card, DashboardState& /*state*/) const {
    begin_card(theme, "Field at the tool", card);
    const FieldState& f = field;
    if (!f.known) {
        text_small(theme, colour::kDim, "no tool: waiting for the controller");
    } else {
        const char* const unit = f.unit.empty() ? "units" : f.unit.c_str();
        row(theme, "Potential", f.inside ? format("%.4g", f.potential) : "outside", unit);
        row(theme, "Slope", f.inside ? format("%.4g", f.slope) : "0", format("%s per m of the field", unit));
        row(theme, "Force", format("%.2f N", f.force_n), format("at most %.2f N", f.force_n_max));
    }
    row(theme, "Range", format("%.4g to %.4g", f.low, f.high), f.unit);
    row(theme, "Probe", f.probe_mm > 0.0 ? format("%.3g mm", f.probe_mm) : std::string("point"),
        f.probe_mm > 0.0 ? "radius of the ball" : "");
    row(theme, "Stiffness", format("up to %.0f N/m", f.stiffness_n_m));
    end_card();
}

void FieldPanels::draw_in_scene_card(const Theme& theme, DashboardState& state) {
    row(theme, "Surfaces", grouped(state.load.vertices_drawn),
        format("of %s vertices", grouped(state.scene.vertices_max).c_str()));
    ImGui::Checkbox("Surfaces", &state.toggles.surface);
    ImGui::SameLine(theme.px(104.0F));
    ImGui::Checkbox("Frame times", &state.toggles.frame_times);
    static constexpr std::array<const char*, 3> kStyles{"glass", "solid", "wire"};
    text_coloured(colour::kDim, "Surfaces as");
    ImGui::SameLine(theme.px(104.0F));
    choose(theme, kStyles, state.toggles.style);
    ImGui::Checkbox("Force", &state.toggles.force);
    ImGui::SameLine(theme.px(104.0F));
    ImGui::Checkbox("Box", &state.toggles.box);
}

std::string FieldPanels::drawn_text(const DashboardState& state) const {
    return format("%s vertices", grouped(state.load.vertices_drawn).c_str());
}

}  // namespace tact
