// Drawing by one system; SceneView calls it at the right points of a frame.
//
// Frame    scene, ångström (gui/render/camera.hpp)
//
// Thread   frame thread, context current
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "gui/render/pass_clock.hpp"
#include "gui/render/programs.hpp"

namespace tact {

// Arguments of one draw.
struct LayerPass {
    Programs& programs;
    Eigen::Matrix4f eye_from_scene, projection;
    Haze haze;
    int x_px = 0, y_px = 0, width_px = 1, height_px = 1;  // of the viewport
    std::size_t eye = 0, eyes = 1;                        // index and number of eyes
    float size_a = 1.0F,
          arrow_a_per_n = 1.0F;   // as SceneView::radius_a(), arrow_a_per_n()
    PassClock* passes = nullptr;  // null: no timing
};

class SceneLayer {
public:
    SceneLayer() = default;
    virtual ~SceneLayer() = default;
    SceneLayer(const SceneLayer&) = delete;
    SceneLayer& operator=(const SceneLayer&) = delete;

    // Opaque; depth test and depth writing on.
    virtual void draw_structures(const LayerPass& pass) { static_cast<void>(pass); }
    // Opaque, after the structures.
    virtual void draw_volume(const LayerPass& pass) { static_cast<void>(pass); }
    // Opaque; takes the surface's place if replaces_surface().
    [[nodiscard]] virtual bool replaces_surface() const { return false; }
    virtual void draw_surface(const LayerPass& pass) { static_cast<void>(pass); }
    // Blended.
    [[nodiscard]] virtual bool has_marks() const { return false; }
    virtual void draw_marks(const LayerPass& pass) { static_cast<void>(pass); }
    // Over everything solid, which hides it by depth.
    virtual void draw_fluids(const LayerPass& pass) { static_cast<void>(pass); }
    // Over everything.
    virtual void draw_in_front(const LayerPass& pass) { static_cast<void>(pass); }
};

}  // namespace tact
