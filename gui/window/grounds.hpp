// Backgrounds of the window and of the cards, painted by one clear each (see gui/DECISIONS.md).
//
// Thread   frame thread, context current.
#pragma once

#include "gui/window/layout.hpp"

namespace tact {

void paint_ground();  // of the whole window
// Of the cards and of everything else beside the 3D view.
// to_px: framebuffer pixels per layout pixel; width_px, height_px: of the framebuffer.
void paint_cards(const Layout& layout, float to_px, int width_px, int height_px);

}  // namespace tact
