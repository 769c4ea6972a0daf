#include "gui/surface/surface_layer.hpp"

#include <utility>

#include "gui/render/scene_frame.hpp"
#include "gui/surface/drawn_tool.hpp"
#include "gui/surface/surface_content.hpp"

namespace tact {
namespace {

constexpr float kEdgeRgba[4] = {0.02F, 0.03F, 0.05F, 0.28F};

}  // namespace

SurfaceLayer::SurfaceLayer(std::shared_ptr<const SceneContent> content) : content_(std::move(content)) {
    const SurfaceContent* const surface = content_->of<SurfaceContent>();
    if (surface != nullptr && surface->tool) tool_.fill(build_drawn_tool(*surface->tool), GL_STATIC_DRAW);
}

void SurfaceLayer::show_detail(const DetailMesh& detail) { detail_.fill(detail.mesh, GL_STREAM_DRAW); }

void SurfaceLayer::draw_structures(const LayerPass& pass) {
    if (!frame.T_model_tool || tool_.indices() == 0) return;
    pass.programs.use_lit(
        pass.eye_from_scene * scene_from_body(*frame.T_model_tool, content_->centre_model_m), pass.projection,
        pass.haze.uncut(), {});
    tool_.draw();
}

// Faces with their edges on top.
void SurfaceLayer::draw_surface(const LayerPass& pass) {
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1.0F, 1.0F);
    pass.programs.use_lit(pass.eye_from_scene, pass.projection, pass.haze, {});
    detail_.draw();
    glDisable(GL_POLYGON_OFFSET_FILL);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    pass.programs.use_flat(pass.eye_from_scene, pass.projection, pass.haze, kEdgeRgba);
    detail_.draw();
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glDisable(GL_BLEND);
}

void SurfaceLayer::draw_in_front(const LayerPass& pass) {
    if (!frame.touch) return;
    const TubeMesh marks =
        build_touch_marks(*frame.touch, content_->centre_model_m, pass.size_a, pass.arrow_a_per_n);
    if (marks.index.empty()) return;
    touch_marks_.fill(marks, GL_STREAM_DRAW);
    pass.programs.use_lit(pass.eye_from_scene, pass.projection, pass.haze, {});
    touch_marks_.draw();
}

}  // namespace tact
