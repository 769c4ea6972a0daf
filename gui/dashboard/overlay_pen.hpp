// Text over the 3D view with a shadow, readable on a dark and on a white background.
//
// Thread   frame thread, inside an ImGui frame.
#pragma once

#include <imgui.h>

#include <algorithm>
#include <string>

#include "gui/dashboard/letters.hpp"
#include "gui/dashboard/theme.hpp"

namespace tact {

struct OverlayPen {
    const Theme& theme;
    ImDrawList* draw;
    bool on_white = false;

    [[nodiscard]] float width(ImFont* font, const std::string& text) const {
        return font->CalcTextSizeA(font->FontSize, 1e9F, 0.0F, text.c_str()).x;
    }
    void text(ImFont* font, ImVec2 at, ImU32 c, const std::string& text) const {
        const ImU32 shadow = on_white ? IM_COL32(255, 255, 255, 200) : IM_COL32(0, 0, 0, 160);
        draw->AddText(font, font->FontSize, {at.x + 1.0F, at.y + 1.0F}, shadow, noted(text));
        draw->AddText(font, font->FontSize, at, ink(c), text.c_str());
    }
    // In lines of at most this width; returns the height.
    float wrapped(ImFont* font, ImVec2 at, ImU32 c, const std::string& text, float wide) const {
        const ImU32 shadow = on_white ? IM_COL32(255, 255, 255, 200) : IM_COL32(0, 0, 0, 160);
        draw->AddText(font, font->FontSize, {at.x + 1.0F, at.y + 1.0F}, shadow, noted(text), nullptr, wide);
        draw->AddText(font, font->FontSize, at, ink(c), text.c_str(), nullptr, wide);
        return font->CalcTextSizeA(font->FontSize, 1e9F, wide, text.c_str()).y;
    }
    // Colours are chosen for a dark background; on a white one they are darker by a factor that keeps their hue.
    [[nodiscard]] ImU32 ink(ImU32 c) const {
        if (!on_white) return c;
        ImVec4 v = ImGui::ColorConvertU32ToFloat4(c);
        const float lightness = 0.3F * v.x + 0.59F * v.y + 0.11F * v.z;
        const float factor = std::min(1.0F, 0.3F / std::max(lightness, 0.01F));
        return ImGui::ColorConvertFloat4ToU32({factor * v.x, factor * v.y, factor * v.z, v.w});
    }
};

}  // namespace tact
