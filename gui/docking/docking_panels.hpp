// Panels of a docking scene: bodies, their fit, contours of the map. Plain data that the window fills and reads.
//
// Thread   frame thread, inside an ImGui frame.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "gui/dashboard/dashboard_state.hpp"
#include "gui/dashboard/pixel_rect.hpp"
#include "gui/docking/body_labels.hpp"
#include "gui/system/system_panels.hpp"
#include "ipc/scene/fit/fit_metrics.hpp"
#include "ipc/topics/bodies.hpp"

namespace tact {

// User actions on bodies that take more than one command.
enum class FitAction : std::uint8_t {
    undo,
    redo,
    revert,
    accept,
    copy,
    refine,
    search,
    cancel,      // a search or a refinement
    take_place,  // moves the body that was looked for to a place found
    place_copies,  // puts it and copies of it at all places of a search with a symmetry, and lets them move together
    keep_place,  // as a snapshot
    snapshot,
    restore,
    save
};
struct FitRequest {
    FitAction action = FitAction::undo;
    std::uint32_t body = 0;  // id: copy, refine, search, revert
    std::string text;        // name of a snapshot
    std::size_t place = 0;   // index in SearchState::found
};

struct BodyState {
    std::uint32_t id = 0;
    std::string name;
    std::size_t atoms = 0;
    bool in_hand = false, fixed = false, hidden = false;
    ImU32 colour = colour::kText;
};

// Places found for a body.
struct FoundRow {
    double score = 0.0, z = 0.0, away_m = 0.0;  // away: from the centre of the body now
    std::uint64_t clashes = 0;
};
struct SearchState {
    // Chosen by the user.
    int objective = 0;                // PlaceObjective
    std::array<char, 48> symmetry{};  // of copies, as tact search --symmetry; empty: none
    bool ghosts = true;
    bool pull = false;  // towards the places found
    // Progress and results.
    bool running = false, nearby = false;
    double progress = 0.0;
    std::uint32_t running_body = 0, found_body = 0;  // ids; 0: none
    std::size_t subtracted = 0;                      // bodies that would be, for the body in the hand
    std::vector<FoundRow> found;                     // best first
    std::string found_name;
    std::string found_symmetry;  // the places are copies by this symmetry; empty: they are alternatives
    bool can_pull = false;       // the places are those of the body in the hand
    double pull_n = 0.0;         // now
    std::uint32_t place = 0;     // towards this one, from 1; 0: none
};

struct FittingState {
    std::vector<BodyState> bodies;
    std::uint32_t options = 0;                                  // DockingOption, currently in effect
    bool building = false;                                      // the controller prepares another density
    std::size_t copies = 0;                                     // of the body in the hand, not fixed
    bool can_bend = false;                                      // the body in the hand has normal modes
    double bent_rmsd_m = 0.0, strain = 0.0, strain_most = 0.0;  // of the body in the hand
    bool bends = false;  // it follows the density; if not, it returns to its own shape
    bool saving = false;
    SearchState search;
    bool can_undo = false, can_redo = false;
    std::size_t gestures = 0;  // undoable
    std::vector<std::string> snapshots;
    std::string message;  // result of the last action
    Grade message_grade = Grade::unknown;
    // Emptied by the window.
    std::vector<FitRequest> requests;
    std::vector<std::pair<std::uint32_t, bool>> hide_requests;  // id, hidden
};

// Definitions of the metrics: ipc/scene/fit/fit_metrics.hpp.
struct FitState {
    bool known = false;
    std::string status;  // "computing", or why there is no result
    FitMetrics all;      // of all bodies together
    std::size_t bodies = 0;
    std::uint32_t body_id = 0;  // of the held body; 0: none
    FitMetrics body;
    double resolution_m = 0.0;
    double contour = 0.0;           // that "inside" refers to, in the map's unit
    bool residues_current = false;  // the colours by fit are of the places shown
    bool pose_known = false;
    double from_file_m = 0.0, from_file_rad = 0.0;
};

struct ContourRow {
    // Chosen by the user.
    double level = 0.0;  // in the map's unit
    float colour[3] = {1.0F, 1.0F, 1.0F};
    float opacity = 1.0F;
    int style = 0;  // as the view, glass, solid, wire
    bool shown = true;
    // Derived values and progress.
    double sigma = 0.0, fraction_inside = 0.0;
    bool final = true;
    std::string error;
};

struct ContourRowState {
    static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
    std::vector<ContourRow> row;
    std::size_t rows_max = 1;
    std::size_t chosen = 0;                // the one that keys and wheel move; see chosen_row()
    std::vector<std::uint64_t> histogram;  // voxels, bins of equal width from least to greatest
    double least = 0.0, greatest = 0.0;    // of the map, in its unit
    bool changed = false, add = false;     // user input, taken by the application
    std::size_t dragged = kNone, removed = kNone;
    [[nodiscard]] std::size_t chosen_row() const { return chosen < row.size() ? chosen : 0; }
    // The contour that counts: the first one.
    [[nodiscard]] double counting(double otherwise) const {
        return row.empty() ? otherwise : row.front().level;
    }
};

// The scene's map and structures, as loaded.
struct DockingSummary {
    double contour = 0.0, contour_sigma = 0.0;  // that counts as inside, in the map's unit
    double resolution_m = 0.0;
    std::array<std::uint32_t, 3> voxels{};
    std::size_t bodies = 0, atoms = 0;
};

// Of bodies in the style of surfaces: numbers of bodies as in Molecules.
struct SurfacesShown {
    std::size_t awaited = 0, coarse = 0;
    std::string error;
};

class DockingPanels : public SystemPanels {
public:
    DockingSummary scene;
    FitState fit;
    FittingState fitting;
    ContourRowState contours;
    std::size_t drawn_as_tubes = 0;  // bodies, in place of their sticks, spheres or surfaces
    SurfacesShown surfaces;
    std::vector<ViewLabel> labels;
    std::int64_t message_until_ns = 0;  // fitting.message is also shown over the view until then

    // Of several bodies there are two rows more.
    [[nodiscard]] CardSize card_size() const override {
        return {scene.bodies > 1 || fit.bodies > 1 ? 212.0F : 160.0F, 0.3F};
    }
    void draw_card(const Theme& theme, const PixelRect& card,
                   DashboardState& state) const override;  // of the fit
    void draw_in_scene_card(const Theme& theme, DashboardState& state) override;
    [[nodiscard]] std::string drawn_text(const DashboardState& state) const override;
    void add_legend(const DashboardState& state, std::vector<LegendLine>& lines) const override;
    void draw_over_view(const OverlayPen& pen, const DashboardState& state,
                        const PixelRect& view) const override;
};

// Tabs of the scene card.
void draw_bodies_tab(const Theme& theme, DashboardState& state, FittingState& fitting);
void draw_search_tab(const Theme& theme, const DashboardState& state, FittingState& fitting);
void draw_search_progress(const Theme& theme, FittingState& fitting);   // only while running
[[nodiscard]] const BodyState* held_body(const FittingState& fitting);  // null: the hand is empty
void draw_contours_tab(const Theme& theme, ContourRowState& contours);

}  // namespace tact
