// Layout of the window, and drawing of its panels: a column of cards on the left, a strip of plots below, the 3D view
// in the rest; nothing overlaps. A window too small for cards has the view and a strip with state, force rate and buttons.
//
// Thread   frame thread, inside an ImGui frame.
#pragma once

#include <array>
#include <cstdint>

#include "gui/dashboard/pixel_rect.hpp"
#include "gui/system/system_panels.hpp"
#include "gui/window/panel_state.hpp"

namespace tact {

// Positions in a window of this size. The application paints the cards' backgrounds (one clear per card): ImGui fills
// areas through its font texture, which takes several milliseconds in software rendering.
struct Layout {
    PixelRect view, health, middle, scene, plots, events;
    PixelRect timeline{};
    bool compact = false;  // the health card alone, as a strip below the view

    [[nodiscard]] std::array<PixelRect, 6> cards() const {
        return {health, middle, scene, timeline, plots, events};
    }
    friend bool operator==(const Layout&, const Layout&) = default;
};
// The card between those of the controller and the scene: from the scene's system; without one, the scene card gets
// its space. A calibration's card takes the whole column.
struct MiddleCard {
    SystemPanels::CardSize size;
    bool calibration = false;
};
[[nodiscard]] MiddleCard middle_card(const PanelState& state, const SystemPanels& system);
// What the strip below the view holds: traces need more height than plots; a replay has a timeline, and a live run that can look back a lower one.
struct Strip {
    bool traces = false, timeline = false, past = false;
};
[[nodiscard]] Strip strip_of(const PanelState& state);
[[nodiscard]] Layout layout_for(const Theme& theme, float width_px, float height_px, const MiddleCard& middle,
                                Strip strip = {});

// Smaller windows are compact; at scale 1.
inline constexpr float kLeastWide = 720.0F, kLeastHigh = 420.0F;

// Draws everything except the 3D view and the cards' backgrounds.
void draw_dashboard(const Theme& theme, PanelState& state, SystemPanels& system, float width_px,
                    float height_px);

// Over the 3D view: legend, scale bar, axes, status.
void draw_overlay(const Theme& theme, PanelState& state, const SystemPanels& system, const Layout& layout);
void draw_scene(const Theme& theme, DashboardState& state, SystemPanels& system, const PixelRect& card);

}  // namespace tact
