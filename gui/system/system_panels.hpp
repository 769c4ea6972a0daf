// Panels of one system: its own card, its part of the scene card, and its overlay on the 3D view.
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
    // Height at scale 1 and greatest fraction of the column height; 0: no card.
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

    // Card between those of the controller and of the scene.
    [[nodiscard]] virtual CardSize card_size() const { return {}; }
    virtual void draw_card(const Theme& theme, const PixelRect& card, DashboardState& state) const {
        static_cast<void>(theme), static_cast<void>(card), static_cast<void>(state);
    }
    // Part inside the scene card.
    virtual void draw_in_scene_card(const Theme& theme, DashboardState& state) = 0;
    // Overlay on the 3D view: lines below the force, text beside the frame rate, free drawing.
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
