// Scene: bodies, contours, and what is loaded, at which contour, and what of it is drawn.
#include <array>
#include <span>

#include "gui/dashboard/widgets.hpp"
#include "gui/window/layout.hpp"
#include "ipc/base/units.hpp"

namespace tact {

namespace {

void scene_rows(const Theme& theme, const PanelState& state) {
    const SceneState& s = state.scene;
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
}

// Of a surface to touch, which has neither a map nor bodies.
void surface_card(const Theme& theme, PanelState& state) {
    row(theme, "Surface", grouped(state.load.vertices_drawn),
        format("of %s vertices", grouped(state.scene.vertices_max).c_str()));
    ImGui::Checkbox("Surface", &state.toggles.surface);
    ImGui::SameLine(theme.px(104.0F));
    ImGui::Checkbox("Depth cue", &state.toggles.depth_cue);
    ImGui::SameLine(theme.px(196.0F));
    ImGui::Checkbox("Times", &state.toggles.frame_times);
    static constexpr std::array<const char*, 3> kStyles{"glass", "solid", "wire"};
    text_coloured(colour::kDim, "Surface as");
    ImGui::SameLine(theme.px(104.0F));
    choose(theme, kStyles, state.toggles.style);
    ImGui::Checkbox("Smooth edges", &state.toggles.smooth_edges);
    draw_detail(theme, state.detail, state.toggles.detail);
}

void bone_card(const Theme& theme, PanelState& state) {
    const SceneState& s = state.scene;
    row(theme, "Voxels", format("%u × %u × %u", s.voxels[0], s.voxels[1], s.voxels[2]),
        format("of %.3g mm", 1e3 * s.voxel_m));
    row(theme, "File", s.file, "");
    ImGui::Checkbox("Frame times", &state.toggles.frame_times);
    ImGui::SameLine(theme.px(130.0F));
    ImGui::Checkbox("Smooth edges", &state.toggles.smooth_edges);
}

void toggles(const Theme& theme, SceneToggles& t) {
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
    ImGui::Checkbox("Depth cue", &t.depth_cue);
    ImGui::SameLine(second);
    ImGui::Checkbox("Frame times", &t.frame_times);
    ImGui::SameLine(third);
    ImGui::Checkbox("Smooth", &t.smooth_edges);
    static constexpr std::array<const char*, 4> kMolecule{"trace", "tube", "sticks", "spheres"};
    static constexpr std::array<const char*, 3> kColouring{"by chain", "by element", "by body"};
    static constexpr std::array<const char*, 3> kSurface{"glass", "solid", "wire"};
    const auto choice = [&](const char* what, std::span<const char* const> words, int& chosen) {
        text_coloured(colour::kDim, what);
        ImGui::SameLine(second);
        ImGui::PushID(what);
        choose(theme, words, chosen);
        ImGui::PopID();
    };
    choice("Bodies as", kMolecule, t.molecule);
    choice("Coloured", kColouring, t.colouring);
    choice("Surface as", kSurface, t.style);
}

}  // namespace

void draw_scene(const Theme& theme, PanelState& state, const PixelRect& card) {
    begin_card(theme, "Scene", card, true);
    SceneState& s = state.scene;
    if (!s.status.empty()) {
        ImGui::PushTextWrapPos(0.0F);
        text_coloured(s.loaded ? colour::kDim : colour::kWatch, s.status);
        ImGui::PopTextWrapPos();
    }
    if (s.loaded && s.surface) {  // nothing to place or to contour
        surface_card(theme, state);
    } else if (s.loaded && s.bone) {
        bone_card(theme, state);
    } else if (s.loaded) {
        static constexpr const char* kTabs[] = {"Bodies", "Contours", "View"};
        ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(theme.px(2.0F), theme.px(1.0F)));
        ImGui::SameLine(0.0F, theme.px(14.0F));
        choose(theme, kTabs, state.tab);
        if (state.tab == 0) {
            draw_bodies_tab(theme, state, state.fitting);
        } else if (state.tab == 1) {
            draw_contours_tab(theme, state.contours);
        } else {
            scene_rows(theme, state);
            toggles(theme, state.toggles);
        }
        ImGui::PopStyleVar();
    }
    if (!s.warning.empty()) text_small(theme, colour::kWatch, s.warning);
    end_card();
}

}  // namespace tact
