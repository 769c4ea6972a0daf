// The contours of the view and the rows of the panel that choose them.
//
// Thread   frame thread.
#pragma once

#include "gui/docking/docking_panels.hpp"
#include "gui/render/contours.hpp"

namespace tact {

// Another scene: the rows are those of the view.
void begin_contours(const Contours& contours, const ContourScale& scale, ContourRowState& state);
// What the panel changed goes to the view, what the view and the map know of it comes back.
void follow_contours(Contours& contours, const ContourScale& scale, ContourRowState& state);
// The first contour, by so many tenths of a sigma.
void nudge_contour(ContourRowState& state, const ContourScale& scale, double tenths);

}  // namespace tact
