#include "gui/surface/surface_content.hpp"

#include <utility>

namespace tact {

std::unique_ptr<SystemContent> read_surface_content(SceneFile file, SceneContent& content) {
    static_cast<void>(content);
    auto own = std::make_unique<SurfaceContent>();
    if (has_touch_tool(file)) own->tool = std::make_unique<TouchTool>(read_touch_tool(file));
    if (file.count({'F', 'R', 'S', 'T'}) > 0) {
        const SurfaceMesh surface = read_surface(file);
        const VertexForest forest = read_forest(file, surface.all_positions_m(), surface.all_corners());
        own->detail.reset(new SurfaceDetail{std::move(file), surface, forest});
    }
    return own;
}

}  // namespace tact
