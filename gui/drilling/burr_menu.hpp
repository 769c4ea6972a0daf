// The menu of the Drilling card: another burr, its speed, water and suction.
//
// Thread   frame thread, inside an ImGui frame
#pragma once

#include "gui/drilling/drilling_panel.hpp"

namespace tact {

inline constexpr const char* kBurrMenu = "burr and drives";

// Draws the menu if ImGui::OpenPopup(kBurrMenu) was called in this window; choices become requests.
void burr_menu(const Theme& theme, const DrillingState& drilling, DashboardState& state);

}  // namespace tact
