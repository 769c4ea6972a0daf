// Scene card: the loaded scene, or why none is loaded, and its system's part.
#include "gui/dashboard/widgets.hpp"
#include "gui/window/layout.hpp"

namespace tact {

void draw_scene(const Theme& theme, DashboardState& state, SystemPanels& system, const PixelRect& card) {
    begin_card(theme, "Scene", card, true);
    SceneState& s = state.scene;
    if (!s.status.empty()) {
        ImGui::PushTextWrapPos(0.0F);
        text_coloured(s.loaded ? colour::kDim : colour::kWatch, s.status);
        ImGui::PopTextWrapPos();
    }
    if (s.loaded) system.draw_in_scene_card(theme, state);
    if (!s.warning.empty()) text_small(theme, colour::kWatch, s.warning);
    end_card();
}

}  // namespace tact
