// Draws a surface scene besides its mesh: the tool, the detail as colour, and the contact marks.
//
// Thread   frame thread, context current.
#pragma once

#include <memory>
#include <optional>

#include "gui/render/scene_layer.hpp"
#include "gui/render/triangle_buffers.hpp"
#include "gui/surface/detail_mesh.hpp"
#include "gui/surface/touch_marks.hpp"

namespace tact {

class SurfaceLayer : public SceneLayer {
public:
    // Content of the next frame.
    struct Frame {
        bool detail = false;               // draw the mesh of show_detail() instead of the surface
        std::optional<Pose> T_model_tool;  // of a mesh tool
        std::optional<DrawnTouch> touch;
    };

    explicit SurfaceLayer(std::shared_ptr<const SceneContent> content);

    Frame frame;
    void show_detail(const DetailMesh& detail);

    void draw_structures(const LayerPass& pass) override;
    [[nodiscard]] bool replaces_surface() const override { return frame.detail && detail_.indices() > 0; }
    void draw_surface(const LayerPass& pass) override;
    void draw_in_front(const LayerPass& pass) override;

private:
    std::shared_ptr<const SceneContent> content_;
    TriangleBuffers tool_, detail_, touch_marks_;
};

}  // namespace tact
