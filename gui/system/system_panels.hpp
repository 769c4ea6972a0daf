// What one system shows among the panels: a card of its own, its part of the scene's card, and what it adds
// over the 3D view.
//
// Thread   frame thread, inside an ImGui frame.
#pragma once

#include <string>
#include <vector>

#include "gui/dashboard/dashboard_state.hpp"
#include "gui/dashboard/overlay_pen.hpp"
#include "gui/dashboard/pixel_rect.hpp"

namespace tact {

class SystemPanels {
public:
    // At scale 1, and at most of the column's height; 0: there is no card.
    struct CardSize {
        float height = 0.0F, share_most = 0.0F;
    };
    struct LegendLine {
        ImU32 swatch = colour::kText;
        std::string text;
    };

    SystemPanels() = default;
    virtual ~SystemPanels() = default;
    SystemPanels(const SystemPanels&) = delete;
    SystemPanels& operator=(const SystemPanels&) = delete;

    // Between the controller's card and the scene's.
    [[nodiscard]] virtual CardSize card_size() const { return {}; }
    virtual void draw_card(const Theme& theme, const PixelRect& card) const {
        static_cast<void>(theme), static_cast<void>(card);
    }
    // Inside the scene's card.
    virtual void draw_in_scene_card(const Theme& theme, DashboardState& state) = 0;
    // Over the 3D view: below the force's line; beside the frame rate; anywhere.
    virtual void add_legend(const DashboardState& state, std::vector<LegendLine>& lines) const {
        static_cast<void>(state), static_cast<void>(lines);
    }
    [[nodiscard]] virtual std::string drawn_text(const DashboardState& state) const = 0;
    virtual void draw_over_view(const OverlayPen& pen, const DashboardState& state,
                                const PixelRect& view) const {
        static_cast<void>(pen), static_cast<void>(state), static_cast<void>(view);
    }
};

}  // namespace tact
