// Panels of a surface scene, which has neither a map nor bodies.
//
// Thread   frame thread, inside an ImGui frame.
#pragma once

#include <string>
#include <vector>

#include "gui/surface/detail_panel.hpp"
#include "gui/system/system_panels.hpp"

namespace tact {

class SurfacePanels : public SystemPanels {
public:
    DetailState detail;

    void draw_in_scene_card(const Theme& theme, DashboardState& state) override;
    void add_legend(const DashboardState& state, std::vector<LegendLine>& lines) const override;
    [[nodiscard]] std::string drawn_text(const DashboardState& state) const override;
    // Colour scale of the detail.
    void draw_over_view(const OverlayPen& pen, const DashboardState& state,
                        const PixelRect& view) const override;
};

}  // namespace tact
