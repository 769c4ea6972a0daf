// Keeps the view's contours and the rows of the contours panel consistent.
//
// Thread   frame thread.
#pragma once

#include "gui/docking/docking_panels.hpp"
#include "gui/render/contours.hpp"

namespace tact {

// For a new scene: takes the rows from the view.
void begin_contours(const Contours& contours, const ContourScale& scale, ContourRowState& state);
// Applies the panel's changes to the view, and updates the rows from the view and the map.
void follow_contours(Contours& contours, const ContourScale& scale, ContourRowState& state);
// Moves the chosen contour by this many tenths of a sigma.
void nudge_contour(ContourRowState& state, const ContourScale& scale, double tenths);
// So many rows down, around the end.
void choose_contour(ContourRowState& state, int rows_down);

}  // namespace tact
