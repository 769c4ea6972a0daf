// As touch_run.hpp, for a mesh tool.
//
// Path   The path of a point becomes one of the tool: its lowest point follows that path, its y axis points
//        outward, and it rotates about it by half a radian per second.
#pragma once

#include <string>
#include <vector>

#include "ipc/scene/mesh/touch_tool.hpp"
#include "tests/bench/touch_paths.hpp"
#include "tests/bench/touch_run.hpp"

namespace tact::launch {

// Bakes one of tact-prep's own tools, with 1000 points.
TouchTool bake_tool_to_measure(const std::string& name);

std::vector<Pose> tool_path(const std::vector<WanderPlace>& path, const TouchTool& tool);
// surface: star-shaped about the origin.
std::vector<Pose> tool_path(const std::vector<Vec3>& path_model_m, const TouchTool& tool);

// The model is as large as in its file. forest, paced: as touch_along.
std::vector<TouchStep> touch_tool_along(const SurfaceMesh& surface, const TouchTool& tool,
                                        const std::vector<Pose>& path, const SurfaceSettings& settings,
                                        int passes, const VertexForest* forest = nullptr, bool paced = false);

}  // namespace tact::launch
