// Scene: what is loaded, at which contour, and what of it is drawn.
#include "gui/panels/panels.hpp"
#include "gui/panels/widgets.hpp"
#include "ipc/base/units.hpp"

namespace tact {

void draw_scene(const Theme& theme, DashboardState& state, const PixelRect& card) {
    begin_card(theme, "Scene", card);
    SceneFacts& s = state.scene;
    if (!s.status.empty()) {
        ImGui::PushTextWrapPos(0.0F);
        text_coloured(s.loaded ? colour::kDim : colour::kWatch, s.status);
        ImGui::PopTextWrapPos();
    }
    if (s.loaded) {
        ImGui::SameLine(0.0F, theme.px(10.0F));
        text_coloured(colour::kText, s.title);
        row(theme, "Contour", format("%.4g", s.contour), format("map units, %.2f σ", s.contour_sigma));
        row(theme, "Map", format("%u × %u × %u", s.voxels[0], s.voxels[1], s.voxels[2]),
            s.resolution_m > 0.0 ? format("%.1f Å", s.resolution_m / kAngstromM)
                                 : std::string("resolution not known"));
        row(theme, "Structure", grouped(s.atoms),
            s.bodies == 1 ? std::string("atoms, 1 body") : format("atoms, %zu bodies", s.bodies));
        row(theme, "Surface", grouped(state.load.vertices_drawn),
            format("of %s vertices", grouped(s.vertices_max).c_str()));
        if (s.mesh_error_m > 0.0) {
            ImGui::SameLine();
            text_coloured(colour::kDim, format("±%.2g Å", s.mesh_error_m / kAngstromM));
        }
        SceneToggles& t = state.toggles;
        const float second = theme.px(104.0F), third = theme.px(196.0F);
        ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(theme.px(2.0F), theme.px(1.0F)));
        ImGui::Checkbox("Surface", &t.surface);
        ImGui::SameLine(second);
        ImGui::Checkbox("Backbone", &t.backbone);
        ImGui::SameLine(third);
        ImGui::Checkbox("Force", &t.force);
        ImGui::Checkbox("Codebook", &t.codebook);
        ImGui::SameLine(second);
        ImGui::Checkbox("Graph", &t.graph);
        ImGui::SameLine(third);
        ImGui::Checkbox("Map box", &t.box);
        ImGui::RadioButton("glass", &t.style, 0);
        ImGui::SameLine(second);
        ImGui::RadioButton("solid", &t.style, 1);
        ImGui::SameLine(third);
        ImGui::RadioButton("wire", &t.style, 2);
        ImGui::PopStyleVar();
    }
    if (!s.warning.empty()) text_small(theme, colour::kWatch, s.warning);
    end_card();
}

}  // namespace tact
