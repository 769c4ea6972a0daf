// Pictures of the bone from fixed views, for the training report: without tools, particles and force.
//
// Thread   frame thread, context current; leaves framebuffer and viewport as they were
#pragma once

#include <vector>

#include "gui/drilling/drilling_layer.hpp"
#include "gui/drilling/training/training_report.hpp"
#include "gui/render/scene_view.hpp"

namespace tact {

// reach_a: of the whole bone; middle_a, radius_a: of the goal, in the scene's frame; radius 0: there is none.
[[nodiscard]] std::vector<TrainingPicture> training_pictures(SceneView& view, DrillingLayer& layer,
                                                             float reach_a, const Eigen::Vector3f& middle_a,
                                                             float radius_a);

}  // namespace tact
