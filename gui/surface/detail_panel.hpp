// The panel of a surface's detail: plain data that the window fills and takes.
//
// Thread   frame thread, inside an ImGui frame.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "gui/dashboard/theme.hpp"

namespace tact {

// The surface as it is kept fine around the tool.
struct DetailState {
    bool possible = false;  // the scene has a forest
    bool felt = false;      // the controller keeps one (mode chr); else the window alone
    bool full = false;      // felt: within the radius all is as in the full mesh
    std::string error;
    // As it is; a person's choice is sent where it is felt, and comes back.
    int shape = 0;                          // bell, multiple frustum
    float width = 1.0F, error_far = 0.5F;   // in radii
    bool editing = false, changed = false;  // by a person, for the application to take
    double radius_m = 0.0;                  // model, as all lengths here
    std::uint32_t vertices = 0, triangles = 0, near_triangles = 0;
    double deviation_m = 0.0;
    double turn_s = 0.0, turn_predicted_s = 0.0;
    // Of the colours; 0: nothing is drawn.
    double finest_m = 0.0, coarsest_m = 0.0;
    std::array<ImU32, 32> colours{};  // from the finest to the coarsest
};

// Inside the scene's card. shown: a person's choice.
void draw_detail(const Theme& theme, DetailState& detail, bool& shown);

}  // namespace tact
