#include "gui/window/grounds.hpp"

#include <algorithm>
#include <cmath>

#include "gui/render/gl.hpp"

namespace tact {

namespace {

void clear(ImU32 c) {
    const ImVec4 v = ImGui::ColorConvertU32ToFloat4(c);
    glClearColor(v.x, v.y, v.z, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT);
}

}  // namespace

void paint_ground() {
    glDisable(GL_SCISSOR_TEST);
    clear(colour::kGround);
}

void paint_cards(const Layout& layout, float to_px, int width_px, int height_px) {
    const int left_px = static_cast<int>(layout.view.x * to_px),
              view_px = std::max(static_cast<int>(layout.view.height * to_px), 1);
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 0, left_px, height_px);
    clear(colour::kGround);
    glScissor(left_px, 0, std::max(width_px - left_px, 0), std::max(height_px - view_px, 0));
    clear(colour::kGround);
    for (const PixelRect& card : layout.cards()) {
        const auto px = [to_px](float v) { return static_cast<int>(std::lround(v * to_px)); };
        glScissor(px(card.x), height_px - px(card.y + card.height), px(card.width), px(card.height));
        clear(colour::kPanel);
    }
    glDisable(GL_SCISSOR_TEST);
}

}  // namespace tact
