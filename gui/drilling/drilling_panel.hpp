// The card of drilling: plain data that the window fills.
//
// Thread   frame thread, inside an ImGui frame.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gui/dashboard/pixel_rect.hpp"
#include "gui/dashboard/theme.hpp"

namespace tact {

// A tool that drills or sucks, in the hand's space.
struct ToolDescription {
    bool there = false;
    int shape = 0;  // ball, cylinder, cone
    double diameter_m = 0.0, length_m = 0.0;
    double rpm = 0.0;  // 0: it stands
    bool water = false, suction = false;
    double depth = 0.0;  // of its radius, in bone
};

struct DrillingState {
    struct Structure {
        std::string name;
        ImU32 colour = colour::kText;
        double burr_m = 0.0, closing_m_s = 0.0;  // below zero: in it
        double suction_tube_m = 1e9;
    };
    bool known = false, labelled = false;
    ToolDescription burr, suction_tube;
    double removed_m3 = 0.0, force_n = 0.0, drilling_s = 0.0, excess_s = 0.0;
    std::uint64_t strokes = 0, injuries = 0;
    double stroke_m = 0.0, stroke_m_s = 0.0;
    std::vector<Structure> structures;  // to keep away from, the nearest first
};

void draw_drilling(const Theme& theme, const DrillingState& drilling, const PixelRect& card);

}  // namespace tact
