// State of all panels of the window; each system keeps its own.
#pragma once

#include "gui/dashboard/dashboard_state.hpp"
#include "gui/stereo/calibration_panel.hpp"
#include "gui/system/keys.hpp"
#include "gui/window/browser_panel.hpp"
#include "gui/window/input_panel.hpp"
#include "gui/window/picture_panel.hpp"

namespace tact {

struct PanelState : DashboardState {
    CalibrationCardState calibration;
    BrowserState browser;
    PictureState picture;
    InputState input;
    KeySituation situation;  // for the keys; the user opens its sheet
    KeyTable keys;
};

// Opens or closes one of two panels at the same place.
inline void open_alone(bool& panel, bool& other) {
    panel = !panel;
    if (panel) other = false;
}

}  // namespace tact
