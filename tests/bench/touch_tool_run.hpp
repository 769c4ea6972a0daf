// Like touch_run.hpp, for a mesh tool.
//
// Path   converted from the path of a point: the lowest point of the tool follows that path, its y axis points outward,
//        and the tool rotates about this axis by half a radian per second
#pragma once

#include <string>
#include <vector>

#include "ipc/scene/mesh/touch_tool.hpp"
#include "tests/bench/touch_paths.hpp"
#include "tests/bench/touch_run.hpp"

namespace tact::launch {

// Bakes one of the synthetic tools of tact-prep, sampled with 1000 points.
TouchTool bake_tool_to_measure(const std::string& name);

std::vector<Pose> tool_path(const std::vector<WanderPlace>& path, const TouchTool& tool);
// For a surface that is star-shaped about the origin.
std::vector<Pose> tool_path(const std::vector<Vec3>& path_model_m, const TouchTool& tool);

// The model has the size in its file. forest, paced: as in touch_along().
std::vector<TouchStep> touch_tool_along(const SurfaceMesh& surface, const TouchTool& tool,
                                        const std::vector<Pose>& path, const SurfaceSettings& settings,
                                        int passes, const VertexForest* forest = nullptr, bool paced = false);

}  // namespace tact::launch
