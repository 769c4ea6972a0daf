// All that the panels show: of every system, and of each.
#pragma once

#include "gui/dashboard/dashboard_state.hpp"
#include "gui/docking/docking_panels.hpp"
#include "gui/drilling/drilling_panel.hpp"
#include "gui/stereo/calibration_panel.hpp"
#include "gui/surface/detail_panel.hpp"
#include "gui/window/browser_panel.hpp"
#include "gui/window/keys.hpp"

namespace tact {

struct PanelState : DashboardState {
    FitState fit;
    FittingState fitting;
    ContourRowState contours;
    DetailState detail;
    DrillingState drilling;
    CalibrationCardState calibration;
    BrowserState browser;
    KeySituation situation;  // of the keys; its sheet is what a person opened
};

}  // namespace tact
