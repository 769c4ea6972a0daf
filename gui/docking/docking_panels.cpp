// Scene card of docking: the tabs for bodies and contours, and the loaded data with its display options.
#include "gui/docking/docking_panels.hpp"

#include <array>
#include <span>

#include "gui/dashboard/widgets.hpp"
#include "gui/docking/fit_colours.hpp"
#include "gui/render/looks.hpp"
#include "ipc/base/units.hpp"

namespace tact {
namespace {

void scene_rows(const Theme& theme, const DashboardState& state, const DockingSummary& s) {
    row(theme, "Contour", format("%.4g", s.contour), format("map units, %.2f σ", s.contour_sigma));
    row(theme, "Map", format("%u × %u × %u", s.voxels[0], s.voxels[1], s.voxels[2]),
        format("%.1f Å", s.resolution_m / kAngstromM));
    row(theme, "Structure", grouped(s.atoms),
        s.bodies == 1 ? std::string("atoms, 1 body") : format("atoms, %zu bodies", s.bodies));
    row(theme, "Surface", grouped(state.load.vertices_drawn),
        format("of %s vertices", grouped(state.scene.vertices_max).c_str()));
    if (state.scene.mesh_error_m > 0.0) {
        ImGui::SameLine();
        text_coloured(colour::kDim, format("±%.2g Å", state.scene.mesh_error_m / kAngstromM));
    }
}

// What the colours of residues mean.
void fit_legend(const Theme& theme, bool current, float from) {
    ImGui::NewLine();
    ImGui::SameLine(from);
    text_small(theme, colour::kDim, format("%.1f", kPoorFit));
    ImGui::SameLine();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    constexpr int kSteps = 24;
    const float width = theme.px(96.0F), height = theme.px(10.0F);
    for (int i = 0; i < kSteps; ++i) {
        const Rgb8 c = fit_colour(kPoorFit + (kGoodFit - kPoorFit) * (i + 0.5) / kSteps);
        const float left = at.x + width * static_cast<float>(i) / kSteps, right = left + width / kSteps;
        ImGui::GetWindowDrawList()->AddRectFilled({left, at.y + theme.px(2.0F)},
                                                  {right, at.y + theme.px(2.0F) + height},
                                                  IM_COL32(c[0], c[1], c[2], 255));
    }
    ImGui::Dummy({width, height});
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip(
            "%s",
            "correlation about the mean of map and bodies, in windows of nine residues along the chain");
    ImGui::SameLine();
    text_small(theme, colour::kDim, format("%.1f%s", kGoodFit, current ? "" : "  computing"));
}

void toggles(const Theme& theme, SceneToggles& t, bool residues_current) {
    const float second = theme.px(104.0F), third = theme.px(196.0F);
    ImGui::Checkbox("Surface", &t.surface);
    ImGui::SameLine(second);
    ImGui::Checkbox("Bodies", &t.backbone);
    ImGui::SameLine(third);
    ImGui::Checkbox("Force", &t.force);
    ImGui::Checkbox("Codebook", &t.codebook);
    ImGui::SameLine(second);
    ImGui::Checkbox("Graph", &t.graph);
    ImGui::SameLine(third);
    ImGui::Checkbox("Map box", &t.box);
    ImGui::Checkbox("Frame times", &t.frame_times);
    static constexpr std::array<const char*, 6> kMolecule{"trace",   "tube",    "sticks",
                                                          "spheres", "cartoon", "surface"};
    static constexpr std::array<const char*, 4> kColouring{"chain", "element", "body", "fit"};
    static constexpr std::array<const char*, 3> kSurface{"glass", "solid", "wire"};
    const auto choice = [&](const char* what, std::span<const char* const> words, int& chosen) {
        text_coloured(colour::kDim, what);
        ImGui::SameLine(second);
        ImGui::PushID(what);
        choose(theme, words, chosen);
        ImGui::PopID();
    };
    choice("Bodies as", kMolecule, t.molecule);
    choice("Coloured by", kColouring, t.colouring);
    if (t.colouring == static_cast<int>(Colouring::fit)) fit_legend(theme, residues_current, second);
    choice("Surface as", kSurface, t.style);
}

}  // namespace

void DockingPanels::draw_in_scene_card(const Theme& theme, DashboardState& state) {
    static constexpr const char* kTabs[] = {"Bodies", "Search", "Contours", "View"};
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(theme.px(2.0F), theme.px(1.0F)));
    ImGui::SameLine(0.0F, theme.px(14.0F));
    choose(theme, kTabs, state.tab);
    if (state.tab == 0) {
        draw_bodies_tab(theme, state, fitting);
    } else if (state.tab == 1) {
        draw_search_tab(theme, state, fitting);
    } else if (state.tab == 2) {
        draw_contours_tab(theme, contours);
    } else {
        toggles(theme, state.toggles, fit.residues_current);
        scene_rows(theme, state, scene);
    }
    ImGui::PopStyleVar();
}

void DockingPanels::add_legend(const DashboardState& state, std::vector<LegendLine>& lines) const {
    if (!fitting.message.empty() && state.now_ns < message_until_ns)
        lines.push_back({grade_colour(fitting.message_grade), fitting.message});
    const auto style = static_cast<MoleculeStyle>(state.toggles.molecule);
    if (style == MoleculeStyle::surface) {
        if (!surfaces.error.empty())
            lines.push_back({colour::kWatch, "no surface, tubes instead: " + surfaces.error});
        else if (surfaces.awaited > 0)
            lines.push_back({colour::kDim, "computing the surface"});
        else if (surfaces.coarse > 0)
            lines.push_back(
                {colour::kWatch, "surfaces are slow in software rendering: coarse while anything moves"});
    }
    if (drawn_as_tubes == 0) return;
    lines.push_back({colour::kWatch, format("%s are slow in software rendering: tubes while anything moves",
                                            style == MoleculeStyle::spheres   ? "spheres"
                                            : style == MoleculeStyle::surface ? "surfaces"
                                                                              : "sticks")});
}

void DockingPanels::draw_over_view(const OverlayPen& pen, const DashboardState& state,
                                   const PixelRect& view) const {
    ImFont* const font =
        state.toggles.labels == static_cast<int>(LabelKind::chains) ? pen.theme.bold : pen.theme.small;
    for (const ViewLabel& label : labels) {
        const float left = 0.5F * pen.width(font, label.text), up = 0.5F * font->FontSize;
        pen.text(font, {view.x + label.x * view.width - left, view.y + label.y * view.height - up},
                 IM_COL32(label.colour[0], label.colour[1], label.colour[2], 255), label.text);
    }
}

std::string DockingPanels::drawn_text(const DashboardState& state) const {
    return format("%s vertices", grouped(state.load.vertices_drawn).c_str());
}

}  // namespace tact
