// The checklist of a training task, over the 3D view.
//
// Thread   frame thread, inside an ImGui frame
#pragma once

#include <string>

#include "gui/dashboard/overlay_pen.hpp"
#include "gui/dashboard/pixel_rect.hpp"
#include "gui/drilling/training/training_score.hpp"

namespace tact {

// What the panel shows.
struct TrainingShown {
    bool on = false;
    std::string title, task;
    bool begun = false;
    TrainingScore score;
    std::string problem;  // why there is no training although one was asked for
};

void draw_training(const OverlayPen& pen, const TrainingShown& shown, const PixelRect& view);

}  // namespace tact
