// The start page: demos with pictures, scenes used before, and what this computer and its device can do. Plain data that
// start_controller fills, and the person's choices.
//
// Thread   frame thread, inside an ImGui frame.
#pragma once

#include <imgui.h>

#include <optional>
#include <string>
#include <vector>

#include "gui/dashboard/pixel_rect.hpp"
#include "gui/window/browser_panel.hpp"

namespace tact {

struct DemoCard {
    const char *name, *title, *what;  // name: of `tact demo`
    ImTextureID picture = {};         // null: none
};

// What was found out about the device or the computer; unknown: not yet.
struct StartFinding {
    StatusText status;
    std::string detail;  // whole, with fixes; shown under the mouse
};

struct StartPageState {
    std::vector<DemoCard> demos;
    StartFinding device, computer;
    StatusText message;           // of the demo that is being prepared, or why it failed
    std::optional<double> share;  // of its preparation, 0 to 1, if reported
    bool preparing = false;
    // The person's choices; emptied by start_controller.
    std::string demo_wanted;
    bool cancel_wanted = false;
};

// Fills the area; it scrolls if it is low. The browser's list of recent scenes is drawn as part of the page.
void draw_start_page(const Theme& theme, StartPageState& page, BrowserState& browser, const PixelRect& area);

}  // namespace tact
