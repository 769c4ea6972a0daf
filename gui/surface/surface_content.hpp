// Content of a surface scene besides its mesh: the tool, and the surface with its forest.
#pragma once

#include <memory>

#include "gui/render/scene_content.hpp"
#include "ipc/scene/mesh/surface_mesh.hpp"
#include "ipc/scene/mesh/touch_tool.hpp"
#include "ipc/scene/mesh/vertex_forest.hpp"

namespace tact {

// A surface with its refinement forest, memory-mapped.
struct SurfaceDetail {
    SceneFile file;
    SurfaceMesh surface;
    VertexForest forest;
};

class SurfaceContent : public SystemContent {
public:
    std::unique_ptr<TouchTool> tool;        // null: a pen
    std::unique_ptr<SurfaceDetail> detail;  // null: no forest
};

// Throws StartupError naming the file.
[[nodiscard]] std::unique_ptr<SystemContent> read_surface_content(SceneFile file, SceneContent& content);

}  // namespace tact
