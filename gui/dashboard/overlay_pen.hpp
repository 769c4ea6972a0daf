// Text over the 3D view with a shadow, readable on any background.
//
// Thread   frame thread, inside an ImGui frame.
#pragma once

#include <imgui.h>

#include <string>

#include "gui/dashboard/theme.hpp"

namespace tact {

struct OverlayPen {
    const Theme& theme;
    ImDrawList* draw;

    [[nodiscard]] float width(ImFont* font, const std::string& text) const {
        return font->CalcTextSizeA(font->FontSize, 1e9F, 0.0F, text.c_str()).x;
    }
    void text(ImFont* font, ImVec2 at, ImU32 c, const std::string& text) const {
        draw->AddText(font, font->FontSize, {at.x + 1.0F, at.y + 1.0F}, IM_COL32(0, 0, 0, 160), text.c_str());
        draw->AddText(font, font->FontSize, at, c, text.c_str());
    }
};

}  // namespace tact
