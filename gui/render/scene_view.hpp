// The three-dimensional view of a docking scene: surface, backbones, codebook, force.
//
// Frame    poses and forces come in model and world axes (which are parallel) in SI; drawing is in ångström.
// Thread   frame thread, context current. Draws into the bound frame buffer, inside the given viewport.
// Cost     follows the vertices of the surface; backbones are bounded by kTubeVertices in total.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "gui/render/camera.hpp"
#include "gui/render/programs.hpp"
#include "gui/render/scene_content.hpp"
#include "gui/render/surface.hpp"
#include "gui/render/tube.hpp"

namespace tact {

enum class SurfaceStyle : int { glass, solid, wire };

struct ViewOptions {
    bool surface = true, backbone = true, codebook = true, graph = true, force = true, box = false;
    SurfaceStyle style = SurfaceStyle::glass;
    bool gradient = true;  // background; off: one colour, cheaper
};

struct ViewFrame {
    int x_px = 0, y_px = 0, width_px = 1, height_px = 1;  // of the viewport, y from below as OpenGL counts
    std::span<const Pose> T_model_body;                   // one per body drawn
    std::size_t active = 0;                               // the body in the hand
    std::uint32_t points_felt = 0;                        // picks the level of the codebook that is shown
    Vec3 force_world_n = Vec3::Zero();
};

class SceneView {
public:
    static constexpr std::size_t kTubeVertices = 20000;

    SceneView(std::shared_ptr<const SceneContent> content, Programs& programs);

    [[nodiscard]] const SceneContent& content() const { return *content_; }
    // Of the surface; as far as `budget_s` of this frame allows, see Surface.
    void approach_vertices(std::uint32_t wanted, double budget_s) noexcept;
    std::size_t upload();
    void draw(const Camera& camera, const ViewOptions& options, const ViewFrame& frame);

    [[nodiscard]] std::uint32_t vertices() const { return surface_ ? surface_->cut().vertices() : 0; }
    [[nodiscard]] std::uint32_t triangles() const { return surface_ ? surface_->cut().triangles() : 0; }
    [[nodiscard]] std::uint32_t vertices_max() const {
        return content_->mesh ? content_->mesh->vertices() : 0;
    }
    [[nodiscard]] double error_m() const {
        return surface_ ? static_cast<double>(surface_->cut().error_m()) : 0.0;
    }
    [[nodiscard]] float radius_a() const;
    // What the arrow stands for: its length in ångström for one newton.
    [[nodiscard]] float arrow_a_per_n() const;

private:
    struct Tubes {
        GlVertexArray array;
        GlBuffer vertices, indices;
        GLsizei count = 0;
    };
    struct Points {
        GlVertexArray array;
        GlBuffer vertices, edges;
        GLsizei points = 0, edge_indices = 0;
    };
    struct Body {
        Tubes tubes;
        std::vector<Points> levels;
    };
    struct Pass;  // matrices of one draw()
    void draw_bodies(const Pass& pass);
    void draw_codebook(const Pass& pass);
    void draw_force(const Pass& pass);
    void draw_box(const Pass& pass);
    void draw_surface(const Pass& pass);
    static void fill(Tubes& tubes, const TubeMesh& mesh, GLenum usage);
    static Points make_points(const Codebook::Level& level);

    std::shared_ptr<const SceneContent> content_;
    Programs& programs_;
    std::unique_ptr<Surface> surface_;
    std::vector<Body> bodies_;
    Tubes arrow_;
    Points box_;
};

// Which level of a codebook is drawn where this many points are felt: the largest not above it that is still
// legible (400 vectors), at least the first.
[[nodiscard]] std::size_t codebook_level(const Codebook& codebook, std::uint32_t points_felt);

}  // namespace tact
