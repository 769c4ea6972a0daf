// The 3D view of a scene: its surfaces, the force, and the drawing by the scene's system.
//
// Frame    poses and forces are in model and world axes (which are parallel), SI; drawing is in ångström.
// Thread   frame thread, context current. Draws into the bound framebuffer, inside the given viewport.
// Cost     grows with the vertices of the surface and the layer's content.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "gui/render/contours.hpp"
#include "gui/render/drawn_hand.hpp"
#include "gui/render/edge_smoothing.hpp"
#include "gui/render/eye_view.hpp"
#include "gui/render/mouse_handle.hpp"
#include "gui/render/pass_clock.hpp"
#include "gui/render/programs.hpp"
#include "gui/render/rest_shading.hpp"
#include "gui/render/scene_content.hpp"
#include "gui/render/scene_layer.hpp"
#include "gui/render/sorted_glass.hpp"
#include "gui/render/triangle_buffers.hpp"

namespace tact {

struct ViewOptions {
    bool surface = true, force = true, box = false;
    SurfaceStyle style = SurfaceStyle::glass;
    bool depth_cue = true;  // far content fades into the background
    bool smooth_edges = true;
    bool light_by_pixel = false;  // of triangles; else by vertex, for software rendering of a view that moves
    int glass_layers = 0;         // of glass sorted at each pixel (SortedGlass); 0: in the order of drawing
    bool shaded = false;          // by RestShading: in software rendering too slow for a view that moves
    std::optional<float>
        cut_a;  // a plane across the view, so far before the camera's target; what is nearer is not drawn
    bool gradient = true;                                    // background; off: plain_ground, cheaper
    Eigen::Vector3f plain_ground = Eigen::Vector3f::Zero();  // clear colour without a gradient

    // The background's one colour; none: the gradient.
    [[nodiscard]] std::optional<Eigen::Vector3f> plain() const {
        if (gradient) return std::nullopt;
        return plain_ground;
    }
};

struct ViewFrame {
    int x_px = 0, y_px = 0, width_px = 1,
        height_px = 1;  // of the viewport, y from below as OpenGL counts
    Vec3 force_world_n = Vec3::Zero();
    std::optional<Vec3> force_at_model_m;  // point of application; none: not drawn
    float force_thickness = 0.02F;         // of the arrow, in radii of the scene
    float force_beside_a = 0.0F;           // it begins so far to the viewer's right of that place
    std::optional<DrawnHand> hand;
    std::array<std::optional<DrawnHandle>, 2> handle;  // of the tools that the mouse may lead
    std::optional<Vec3> mark_at_model_m;               // an instructor's mark
    std::size_t eye = 0, eyes = 1;                     // index and number of eyes
    PassClock* passes = nullptr;                       // times each pass; null: none
};

class SceneView {
public:
    // `refine` makes the final surface of a moved contour (ContourWorker); without it such surfaces stay plain.
    SceneView(std::shared_ptr<const SceneContent> content, Programs& programs, RefineContour refine = {});

    [[nodiscard]] const SceneContent& content() const { return *content_; }
    // Layer of the scene's system; null: none. It must outlive this view, or be replaced before it is destroyed.
    void set_layer(SceneLayer* layer) { layer_ = layer; }
    // Total of all surfaces, reached as far as `budget_s` of this frame allows; see Surface.
    void approach_vertices(std::uint32_t wanted, double budget_s) noexcept {
        contours_.approach_vertices(wanted, budget_s);
    }
    std::size_t upload() { return contours_.upload(); }
    void draw(const EyeView& eye, const ViewOptions& options, const ViewFrame& frame);
    // The user's choice of surfaces.
    [[nodiscard]] Contours& contours() { return contours_; }
    [[nodiscard]] Programs& programs() { return programs_; }

    [[nodiscard]] std::uint32_t vertices() const { return contours_.vertices(); }
    [[nodiscard]] std::uint32_t triangles() const { return contours_.triangles(); }
    [[nodiscard]] std::uint32_t vertices_min() const { return contours_.vertices_min(); }
    [[nodiscard]] std::uint32_t vertices_max() const { return contours_.vertices_max(); }
    [[nodiscard]] double error_m() const { return contours_.error_m(); }
    [[nodiscard]] float radius_a() const;
    // Scale of the force arrow: ångström per newton.
    [[nodiscard]] float arrow_a_per_n() const;

private:
    [[nodiscard]] Haze haze_of(const EyeView& eye, const ViewOptions& options) const;
    void fill_box();
    void draw_in_front(const LayerPass& pass, const ViewOptions& options, const ViewFrame& frame);
    void draw_force(const LayerPass& pass, const ViewFrame& frame);
    void draw_hand(const LayerPass& pass, const DrawnHand& hand);
    void draw_mark(const LayerPass& pass, const Vec3& at_model_m);
    void draw_handle(const LayerPass& pass, const DrawnHandle& handle);
    void draw_box(const LayerPass& pass);

    std::shared_ptr<const SceneContent> content_;
    Programs& programs_;
    Contours contours_;
    SceneLayer no_layer_;
    SceneLayer* layer_ = nullptr;
    TriangleBuffers mark_, arrow_, hand_, touched_wall_, handle_;
    GlVertexArray box_array_;
    GlBuffer box_vertices_, box_edges_;
    GLsizei box_indices_ = 0;
    std::unique_ptr<EdgeSmoothing> edges_;  // created for the first smoothed frame
    std::unique_ptr<RestShading> shading_;  // likewise
    std::unique_ptr<SortedGlass> glass_;    // likewise
};

}  // namespace tact
