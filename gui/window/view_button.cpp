#include "gui/window/view_button.hpp"

#include <algorithm>

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

void begin_view_panel(const Theme& theme, const char* window, const char* title, float top,
                      const PixelRect& view) {
    const float width = std::min(theme.px(kViewPanelWide), view.width);
    ImGui::SetNextWindowPos(
        {view.x + view.width - width - theme.px(kViewButtonRight), view.y + theme.px(top + 32.0F)});
    ImGui::SetNextWindowSize({width, 0.0F});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, colour::kPanel);
    ImGui::Begin(window, nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav);
    ImGui::PushFont(theme.bold);
    text_coloured(colour::kAccent, title);
    ImGui::PopFont();
}

void end_view_panel() {
    ImGui::End();
    ImGui::PopStyleColor();
}

}  // namespace tact
