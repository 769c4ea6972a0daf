// Where everything lies in the window, and drawing it: a column of cards on the left, a strip of plots below, the 3D view in
// the rest; nothing overlaps.
//
// Thread   frame thread, inside an ImGui frame.
#pragma once

#include <array>
#include <cstdint>

#include "gui/dashboard/pixel_rect.hpp"
#include "gui/system/system_panels.hpp"
#include "gui/window/panel_state.hpp"

namespace tact {

// Where everything lies in a window of this size. The cards' ground is for the application to paint (one
// clear per card): ImGui fills areas through its font texture, which costs several milliseconds where the
// processor draws.
struct Layout {
    PixelRect view, health, middle, scene, plots, events;

    [[nodiscard]] std::array<PixelRect, 5> cards() const { return {health, middle, scene, plots, events}; }
};
// The card between the controller's and the scene's: of the scene's system, or none, and its place goes to the scene.
// While a screen is calibrated, its card takes the whole column.
struct MiddleCard {
    SystemPanels::CardSize size;
    bool calibration = false;
};
[[nodiscard]] MiddleCard middle_card(const PanelState& state, const SystemPanels& system);
// traces: the strip below is as high as they need.
[[nodiscard]] Layout layout_for(const Theme& theme, float width_px, float height_px, const MiddleCard& middle,
                                bool traces = false);

// Draws everything but the 3D view and the cards' ground.
void draw_dashboard(const Theme& theme, PanelState& state, SystemPanels& system, float width_px,
                    float height_px);

// Over the 3D view: legend, scale bar, axes, what is being waited for.
void draw_overlay(const Theme& theme, PanelState& state, const SystemPanels& system, const PixelRect& view);
void draw_scene(const Theme& theme, DashboardState& state, SystemPanels& system, const PixelRect& card);

}  // namespace tact
