// The three-dimensional view of a docking scene: surface, bodies, codebook, force.
//
// Frame    poses and forces come in model and world axes (which are parallel) in SI; drawing is in ångström.
// Thread   frame thread, context current. Draws into the bound frame buffer, inside the given viewport.
// Cost     follows the vertices of the surface; that of bodies: gui/docking/molecules.hpp.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gui/docking/molecules.hpp"
#include "gui/drilling/bone_view.hpp"
#include "gui/drilling/drill_tools.hpp"
#include "gui/drilling/particle_cloud.hpp"
#include "gui/render/contours.hpp"
#include "gui/render/drawn_hand.hpp"
#include "gui/render/edge_smoothing.hpp"
#include "gui/render/eye_view.hpp"
#include "gui/render/pass_clock.hpp"
#include "gui/render/programs.hpp"
#include "gui/render/scene_content.hpp"
#include "gui/render/triangle_buffers.hpp"
#include "gui/surface/detail_mesh.hpp"
#include "gui/surface/touch_marks.hpp"

namespace tact {

struct ViewOptions {
    bool surface = true, backbone = true, codebook = true, graph = true, force = true, box = false;
    bool detail = false;  // what show_detail() was given, in place of the surface
    SurfaceStyle style = SurfaceStyle::glass;
    bool depth_cue = true;  // what lies far behind fades into the background
    bool smooth_edges = true;
    bool gradient = true;  // background; off: plain_ground, cheaper
    Eigen::Vector3f plain_ground =
        Eigen::Vector3f::Zero();  // the colour cleared to where there is no gradient
};

struct ViewFrame {
    int x_px = 0, y_px = 0, width_px = 1, height_px = 1;  // of the viewport, y from below as OpenGL counts
    std::span<const DrawnBody> bodies;
    std::size_t active = 0;           // the body in the hand; none where it is not one of them
    std::uint32_t points_summed = 0;  // picks the level of the codebook that is shown
    Vec3 force_world_n = Vec3::Zero();
    std::optional<DrawnHand> second_hand;
    std::optional<DrawnTouch> touch;
    std::optional<Pose> T_model_tool;  // of the tool that touches a surface
    const Particles* particles = nullptr;
    bool time_particles = false;                  // waits for the renderer, see particles_draw_s()
    std::uint32_t bone_rays = 0;                  // through the bone, at most
    double bone_fill_s = 1e9;                     // at most, for bone that is not in graphics memory yet
    std::size_t eye = 0;                          // which of two
    PassClock* passes = nullptr;                  // told what each takes
    std::span<const DrawnDrillTool> drill_tools;  // the force is felt at the first one
};

class SceneView {
public:
    // `refine` makes the final surface of a contour that was moved (ContourWorker); without it they stay
    // plain.
    SceneView(std::shared_ptr<const SceneContent> content, Programs& programs, RefineContour refine = {});

    [[nodiscard]] const SceneContent& content() const { return *content_; }
    // Of all surfaces together; as far as `budget_s` of this frame allows, see Surface.
    void approach_vertices(std::uint32_t wanted, double budget_s) noexcept {
        contours_.approach_vertices(wanted, budget_s);
    }
    std::size_t upload() { return contours_.upload(); }
    void show_detail(const DetailMesh& detail);
    // From now on, the bone of the scene as it is in `now`, which must outlive this. Where there turns out to be no room for it,
    // it is drawn no more and bone_error() says so.
    void show_bone(const BoneVolumeView& now) { bone_ = std::make_unique<BoneView>(*content_, now); }
    [[nodiscard]] BoneView* bone() { return bone_.get(); }  // null: none is shown
    [[nodiscard]] const std::string& bone_error() const { return bone_error_; }
    void draw(const EyeView& eye, const ViewOptions& options, const ViewFrame& frame);
    // What a person chose of bodies and surfaces.
    [[nodiscard]] Molecules& molecules() { return molecules_; }
    [[nodiscard]] Contours& contours() { return contours_; }

    [[nodiscard]] std::uint32_t vertices() const { return contours_.vertices(); }
    [[nodiscard]] std::uint32_t triangles() const { return contours_.triangles(); }
    [[nodiscard]] std::uint32_t vertices_min() const { return contours_.vertices_min(); }
    [[nodiscard]] std::uint32_t vertices_max() const { return contours_.vertices_max(); }
    [[nodiscard]] double error_m() const { return contours_.error_m(); }
    // Of the last draw() that was to time it: where the processor draws, that is its time.
    [[nodiscard]] double particles_draw_s() const { return particles_draw_s_; }
    [[nodiscard]] float radius_a() const;
    // What the arrow stands for: its length in ångström for one newton.
    [[nodiscard]] float arrow_a_per_n() const;

private:
    struct Points {
        GlVertexArray array;
        GlBuffer vertices, edges;
        GLsizei points = 0, edge_indices = 0;
    };
    struct Pass;  // matrices of one draw()
    [[nodiscard]] Haze haze_of(const EyeView& eye, const ViewOptions& options) const;
    void draw_structures(const Pass& pass);
    void draw_in_front(const Pass& pass);
    void draw_codebook(const Pass& pass);
    void draw_force(const Pass& pass);
    void draw_second_hand(const Pass& pass);
    void draw_touch(const Pass& pass);
    void draw_tool(const Pass& pass);
    void draw_bone(const Pass& pass);
    void draw_drill_tools(const Pass& pass);
    void draw_box(const Pass& pass);
    void draw_particles(const Pass& pass);
    void draw_detail(const Pass& pass);
    static Points make_points(const Codebook::Level& level);

    std::shared_ptr<const SceneContent> content_;
    Programs& programs_;
    Molecules molecules_;
    Contours contours_;
    std::vector<std::vector<Points>> codebooks_;  // levels of each structure
    double particles_draw_s_ = 0.0;
    std::unique_ptr<ParticleCloud> cloud_;  // from the first particles on
    TriangleBuffers arrow_, second_hand_, touched_wall_, touch_marks_, tool_, detail_;
    Points box_;
    std::unique_ptr<EdgeSmoothing> edges_;  // from the first smooth picture on
    std::unique_ptr<BoneView> bone_;
    std::string bone_error_;
    struct ToolInHand {
        DrawnDrillTool shape;
        TriangleBuffers mesh;
    };
    std::array<ToolInHand, 2> drill_tool_;  // with the shapes that their meshes are of
};

// Which level of a codebook is drawn where this many points are felt: the largest not above it that is still
// legible (400 vectors), at least the first.
[[nodiscard]] std::size_t codebook_level(const Codebook& codebook, std::uint32_t points_summed);

}  // namespace tact
