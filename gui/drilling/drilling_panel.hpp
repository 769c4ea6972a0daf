// Panels of drilling: plain data that the window fills.
//
// Thread   frame thread, inside an ImGui frame.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "gui/dashboard/pixel_rect.hpp"
#include "gui/dashboard/theme.hpp"
#include "gui/drilling/training/training_panel.hpp"
#include "gui/system/system_panels.hpp"
#include "ipc/topics/drill.hpp"

namespace tact {

// A burr or suction tube, in the hand's space.
struct ToolDescription {
    bool valid = false;
    int shape = 0;  // ball, cylinder, cone
    DrillGrit grit = DrillGrit::cutting;
    double diameter_m = 0.0, length_m = 0.0;
    double rpm = 0.0;  // 0: stopped
    bool water = false, suction = false;
    double depth = 0.0;  // penetration into bone, in radii
};

struct DrillingState {
    struct Structure {
        std::string name;
        ImU32 colour = colour::kText;
        double burr_m = 0.0, closing_m_s = 0.0;  // below zero: inside
        double suction_tube_m = 1e9;
        std::string side{};  // of the burr on which it lies, in the patient: "PL"; empty: unknown
    };
    // Of the bone that was removed since the window opened; the sum of all is what was removed.
    struct Dust {
        double here_m3 = 0.0;  // as dust and paste
        double sucked_m3 = 0.0, flown_m3 = 0.0;
        double buried_m3 = 0.0;  // where bone came back
    };
    bool known = false, labelled = false;
    Dust dust;
    ToolDescription burr, suction_tube;
    bool held_in = false;  // bone on all sides of the burr
    double removed_m3 = 0.0, force_n = 0.0, drilling_s = 0.0, excess_s = 0.0;
    std::uint64_t strokes = 0, injuries = 0;
    double stroke_m = 0.0, stroke_m_s = 0.0;
    std::uint32_t undoable = 0, redoable = 0;  // strokes of bone taken
    bool exchanging = false;                   // one is being undone or redone: no force
    bool changing_burr = false;                // another burr was ordered: no force until it is in the hand
    double burr_rad_s_most = 0.0, irrigation_m3_s = 0.0, suction_m3_s = 0.0;  // of the drives, as set
    Grade nearness = Grade::good;       // of the turning burr to the critical structure that is nearest
    std::vector<Structure> structures;  // critical ones, nearest first
};

class DrillingPanels : public SystemPanels {
public:
    DrillingState drilling;
    float bone_shown = 1.0F;  // fraction of the bone in graphics memory
    std::array<std::uint32_t, 3> voxels{};
    double voxel_m = 0.0;  // edge
    std::string sound;     // why there is none; empty: there is
    TrainingShown training;

    [[nodiscard]] CardSize card_size() const override { return {347.0F, 0.42F}; }
    void draw_card(const Theme& theme, const PixelRect& card, DashboardState& state) const override;
    void draw_in_scene_card(const Theme& theme, DashboardState& state) override;
    // The checklist of a training task, and an edge around the view while the turning burr is near a critical structure.
    void draw_over_view(const OverlayPen& pen, const DashboardState& state,
                        const PixelRect& view) const override;
    [[nodiscard]] std::string drawn_text(const DashboardState& state) const override;
};

}  // namespace tact
