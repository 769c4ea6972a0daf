#include "gui/window/grounds.hpp"

#include <cmath>

#include "gui/render/gl.hpp"

namespace tact {

void paint_grounds(const Layout& layout, float to_px, int height_px) {
    glDisable(GL_SCISSOR_TEST);
    const auto clear = [](ImU32 c, GLbitfield what) {
        const ImVec4 v = ImGui::ColorConvertU32ToFloat4(c);
        glClearColor(v.x, v.y, v.z, 1.0F);
        glClear(what);
    };
    clear(colour::kGround, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_SCISSOR_TEST);
    for (const PixelRect& card : layout.cards()) {
        const auto px = [to_px](float v) { return static_cast<int>(std::lround(v * to_px)); };
        glScissor(px(card.x), height_px - px(card.y + card.height), px(card.width), px(card.height));
        clear(colour::kPanel, GL_COLOR_BUFFER_BIT);
    }
    glDisable(GL_SCISSOR_TEST);
}

}  // namespace tact
