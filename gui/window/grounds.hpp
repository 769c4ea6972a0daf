// Backgrounds of the window and of the cards, painted by one clear each (see gui/DECISIONS.md).
//
// Thread   frame thread, context current.
#pragma once

#include "gui/window/layout.hpp"

namespace tact {

// to_px: framebuffer pixels per layout pixel; height_px: of the framebuffer.
void paint_grounds(const Layout& layout, float to_px, int height_px);

}  // namespace tact
