// A button at the right edge of the 3D view, and the panel that it opens below itself.
//
// Thread   frame thread, inside an ImGui frame.
#pragma once

#include "gui/dashboard/pixel_rect.hpp"
#include "gui/dashboard/theme.hpp"

namespace tact {

// So far below the view's upper edge at scale 1: below the lines about frames.
inline constexpr float kScenesButtonTop = 70.0F, kPictureButtonTop = 104.0F, kInputButtonTop = 138.0F,
                       kViewButtonRight = 10.0F;
// window: its name, unique. key: shown behind the text. Returns true when it is pressed.
[[nodiscard]] bool view_button(const Theme& theme, const char* window, const char* text, const char* key,
                               float top, const PixelRect& view);

// top: of the button. End it with end_view_panel().
inline constexpr float kViewPanelWide = 330.0F;
void begin_view_panel(const Theme& theme, const char* window, const char* title, float top,
                      const PixelRect& view);
void end_view_panel();

}  // namespace tact
