// As touch_run.hpp, with a tool that is a mesh.
//
// Path   that of a point becomes one of the tool: its lowest place goes where the point went, its y axis leads
//        outward, and it turns about that by half a radian a second.
#pragma once

#include <string>
#include <vector>

#include "ipc/scene/mesh/touch_tool.hpp"
#include "tests/bench/touch_paths.hpp"
#include "tests/bench/touch_run.hpp"

namespace tact::launch {

// One of tact-prep's own, with 1000 points.
TouchTool bake_tool_to_measure(const std::string& name);

std::vector<Pose> tool_path(const std::vector<WanderPlace>& path, const TouchTool& tool);
// Of a surface that is seen whole from the origin.
std::vector<Pose> tool_path(const std::vector<Vec3>& path_model_m, const TouchTool& tool);

// The model is as large as in its file. forest, paced: as touch_along.
std::vector<TouchStep> touch_tool_along(const SurfaceMesh& surface, const TouchTool& tool,
                                        const std::vector<Pose>& path, const SurfaceSettings& settings,
                                        int passes, const VertexForest* forest = nullptr, bool paced = false);

}  // namespace tact::launch
