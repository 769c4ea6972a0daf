// Panels of a field scene: potential, gradient and force at the tool, and the display options.
//
// Thread   frame thread, inside an ImGui frame.
#pragma once

#include <string>

#include "gui/system/system_panels.hpp"

namespace tact {

struct FieldState {
    bool known = false;  // a controller is attached and the tool's position known
    bool inside = false;
    std::string unit;
    double potential = 0.0, slope = 0.0;  // unit; unit per model metre
    double low = 0.0, high = 0.0;         // of the field
    double force_n = 0.0, force_n_max = 0.0, stiffness_n_m = 0.0;
    double probe_mm = 0.0;  // radius of the probe, hand's world
};

class FieldPanels : public SystemPanels {
public:
    FieldState field;

    [[nodiscard]] CardSize card_size() const override { return {170.0F, 0.3F}; }
    void draw_card(const Theme& theme, const PixelRect& card, DashboardState& state) const override;
    void draw_in_scene_card(const Theme& theme, DashboardState& state) override;
    [[nodiscard]] std::string drawn_text(const DashboardState& state) const override;
};

}  // namespace tact
