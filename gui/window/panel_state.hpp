// All that the panels of the window show; what a system shows, it keeps itself.
#pragma once

#include "gui/dashboard/dashboard_state.hpp"
#include "gui/stereo/calibration_panel.hpp"
#include "gui/system/keys.hpp"
#include "gui/window/browser_panel.hpp"

namespace tact {

struct PanelState : DashboardState {
    CalibrationCardState calibration;
    BrowserState browser;
    KeySituation situation;  // of the keys; its sheet is what a person opened
};

}  // namespace tact
