#include "gui/window/view_button.hpp"

#include "gui/dashboard/widgets.hpp"

namespace tact {

bool view_button(const Theme& theme, const char* window, const char* text, const char* key, float top,
                 const PixelRect& view) {
    const float width = theme.px(96.0F);
    ImGui::SetNextWindowPos(
        {view.x + view.width - width - theme.px(kViewButtonRight), view.y + theme.px(top)});
    ImGui::SetNextWindowSize({width, theme.px(30.0F)});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0.0F, 0.0F));
    ImGui::Begin(window, nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoNav |
                     ImGuiWindowFlags_NoBringToFrontOnFocus);
    const bool pressed = ImGui::Button(format("%s (%s)", text, key).c_str(), {width, 0.0F});
    ImGui::End();
    ImGui::PopStyleVar();
    return pressed;
}

}  // namespace tact
