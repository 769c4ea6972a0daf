// The ground of the window and of the panels' cards, painted by one clear each (see gui/README.md).
//
// Thread   frame thread, context current.
#pragma once

#include "gui/window/layout.hpp"

namespace tact {

// to_px: pixels of the frame buffer for one of the layout's; height_px: of the frame buffer.
void paint_grounds(const Layout& layout, float to_px, int height_px);

}  // namespace tact
