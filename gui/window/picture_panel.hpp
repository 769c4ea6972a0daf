// How the 3D view is drawn, whatever the scene, and saving it as a picture: a panel over the view, opened by a button.
//
// Thread   frame thread, inside an ImGui frame.
#pragma once

#include <string>

#include "gui/dashboard/pixel_rect.hpp"
#include "gui/dashboard/scene_toggles.hpp"
#include "gui/dashboard/status_text.hpp"
#include "gui/dashboard/theme.hpp"

namespace tact {

struct PictureState {
    static constexpr int kSideMin = 64, kSideMax = 8192;
    bool open = false;
    int width_px = 0, height_px = 0;  // of the picture to save; 0: not chosen yet, so twice the view
    bool transparent = false;         // no background
    bool save_wanted = false;         // by the button
    StatusText result;                // of the newest picture
};

// labels: whether the scene has something to label.
void draw_picture_panel(const Theme& theme, PictureState& picture, SceneToggles& toggles, bool labels,
                        const PixelRect& view);

}  // namespace tact
