// Panel of a surface's detail: plain data that the window fills and reads.
//
// Thread   frame thread, inside an ImGui frame.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "gui/dashboard/theme.hpp"

namespace tact {

// Refinement of the surface around the tool.
struct DetailState {
    bool possible = false;  // the scene has a forest
    bool felt = false;      // the controller refines (mode chr); else the window only
    bool full = false;      // if `felt`: the zone within the radius matches the full mesh
    std::string error;
    // Current values. If `felt`, a user's choice goes to the controller and returns from it.
    int shape = 0;                          // bell, multiple frustum
    float width = 1.0F, error_far = 0.5F;   // in radii
    bool editing = false, changed = false;  // by the user; the application takes them
    double radius_m = 0.0;                  // model, as all lengths here
    std::uint32_t vertices = 0, triangles = 0, near_triangles = 0;
    double deviation_m = 0.0;
    double turn_s = 0.0, turn_predicted_s = 0.0;
    // Of the colours; 0: nothing drawn.
    double finest_m = 0.0, coarsest_m = 0.0;
    std::array<ImU32, 32> colours{};  // from the finest to the coarsest
};

// Inside the scene card. shown: the user's choice.
void draw_detail(const Theme& theme, DetailState& detail, bool& shown);

}  // namespace tact
