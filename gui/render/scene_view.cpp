#include "gui/render/scene_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "gui/render/arrow.hpp"
#include "gui/render/camera.hpp"
#include "gui/render/scene_frame.hpp"
#include "ipc/base/units.hpp"

namespace tact {
namespace {

constexpr float kMarkLength = 0.25F, kMarkThickness = 0.012F;  // radii of the scene
constexpr Rgb8 kMarkColour{255, 80, 220};

constexpr float kBoxRgba[4] = {0.55F, 0.62F, 0.72F, 0.55F};
constexpr double kFrontDepth = 1e-3;
// Range of the depth cue, from slightly before the target to well behind it, in radii of the scene.
constexpr float kHazeBegin = 0.6F, kHazeEnd = 1.6F, kHazeStrength = 0.8F;

}  // namespace

SceneView::SceneView(std::shared_ptr<const SceneContent> content, Programs& programs, RefineContour refine)
    : content_(std::move(content)), programs_(programs), contours_(content_, programs, std::move(refine)) {
    fill_box();
}

void SceneView::fill_box() {
    std::vector<float> xyz;
    std::vector<std::array<std::uint32_t, 2>> edges;
    for (std::uint32_t k = 0; k < 8; ++k) {
        const Vec3 p((k & 1U) != 0 ? content_->box_max_model_m.x() : content_->box_min_model_m.x(),
                     (k & 2U) != 0 ? content_->box_max_model_m.y() : content_->box_min_model_m.y(),
                     (k & 4U) != 0 ? content_->box_max_model_m.z() : content_->box_min_model_m.z());
        const Eigen::Vector3f f = (p - content_->centre_model_m).cast<float>();
        xyz.insert(xyz.end(), {f.x() * kSceneAPerM, f.y() * kSceneAPerM, f.z() * kSceneAPerM});
        for (const std::uint32_t bit : {1U, 2U, 4U})
            if ((k & bit) == 0) edges.push_back({k, k | bit});
    }
    glBindVertexArray(box_array_.get());
    glBindBuffer(GL_ARRAY_BUFFER, box_vertices_.get());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(xyz.size() * sizeof(float)), xyz.data(),
                 GL_STATIC_DRAW);
    attribute(0, 3, GL_FLOAT, GL_FALSE, 12, 0);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, box_edges_.get());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(edges.size() * sizeof(edges[0])),
                 edges.data(), GL_STATIC_DRAW);
    box_indices_ = static_cast<GLsizei>(2 * edges.size());
    glBindVertexArray(0);
}

float SceneView::radius_a() const { return static_cast<float>(content_->radius_m / kAngstromM); }

float SceneView::arrow_a_per_n() const {
    return std::max(1.0F, static_cast<float>(round_length(0.9 * static_cast<double>(radius_a()))));
}

void SceneView::draw(const EyeView& eye, const ViewOptions& options, const ViewFrame& frame) {
    LayerPass pass{programs_,   eye.eye_from_scene, eye.projection, haze_of(eye, options),
                   frame.x_px,  frame.y_px,         frame.width_px, frame.height_px,
                   frame.eye,   frame.eyes,         radius_a(),     arrow_a_per_n(),
                   frame.passes};
    SceneLayer& layer = layer_ != nullptr ? *layer_ : no_layer_;
    const bool cuts = pass.haze.cut_a > 0.0F;
    const auto cut = [cuts](bool on) {
        cuts&& on ? glEnable(GL_CLIP_DISTANCE0) : glDisable(GL_CLIP_DISTANCE0);
    };
    programs_.light_by_pixel(options.light_by_pixel);
    glEnable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    {
        const PassClock::Scope scope(frame.passes, Pass::structures);
        cut(true);
        layer.draw_structures(pass);
        cut(false);
    }
    layer.draw_volume(pass);
    const Eigen::Matrix4f eye_from_model = pass.eye_from_scene * scene_from_model(content_->centre_model_m);
    const bool replaced = layer.replaces_surface(), surface = options.surface && !replaced;
    cut(true);
    {
        const PassClock::Scope scope(frame.passes, Pass::surface);
        if (replaced) layer.draw_surface(pass);
        if (surface) contours_.draw_opaque(eye_from_model, pass.projection, pass.haze, options.style);
    }
    if (options.shaded) {
        const PassClock::Scope scope(frame.passes, Pass::edges);
        cut(false);
        if (!shading_) shading_ = std::make_unique<RestShading>();
        shading_->shade(pass.projection, pass.haze, pass.size_a, frame.x_px, frame.y_px, frame.width_px,
                        frame.height_px);
        cut(true);
    }
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    if (layer.has_marks() || options.box) {
        const PassClock::Scope scope(frame.passes, Pass::marks);
        if (layer.has_marks()) layer.draw_marks(pass);
        if (options.box) draw_box(pass);
    }
    if (surface) {
        const PassClock::Scope scope(frame.passes, Pass::surface);
        cut(false);
        if (cuts) contours_.draw_cut(eye_from_model, pass.projection, pass.haze, options.style);
        cut(true);
        if (options.glass_layers > 0 && contours_.glass_alone(options.style)) {
            if (!glass_) glass_ = std::make_unique<SortedGlass>(programs_);
            glass_->draw(frame.x_px, frame.y_px, frame.width_px, frame.height_px, options.glass_layers, [&] {
                contours_.draw_glass_to_sort(eye_from_model, pass.projection, pass.haze, options.style);
            });
        } else {
            contours_.draw_clear(eye_from_model, pass.projection, pass.haze, options.style);
        }
    }
    cut(false);
    glDisable(GL_BLEND);
    layer.draw_fluids(pass);
    pass.haze.cut_a = 0.0F;
    draw_in_front(pass, options, frame);
    glBindVertexArray(0);
    glUseProgram(0);
    if (!options.smooth_edges) return;
    const PassClock::Scope scope(frame.passes, Pass::edges);
    if (!edges_) edges_ = std::make_unique<EdgeSmoothing>();
    edges_->smooth(frame.x_px, frame.y_px, frame.width_px, frame.height_px);
}

// Always visible, even inside structures: in the foremost thousandth of the depth, where the rest of the scene is not. Clearing the depth
// instead takes 1 to 2 ms in software rendering.
void SceneView::draw_in_front(const LayerPass& pass, const ViewOptions& options, const ViewFrame& frame) {
    const PassClock::Scope scope(frame.passes, Pass::marks);
    glDepthRange(0.0, kFrontDepth);
    glEnable(GL_DEPTH_TEST);
    if (options.force && frame.force_at_model_m) draw_force(pass, frame);
    if (frame.hand) draw_hand(pass, *frame.hand);
    if (frame.mark_at_model_m) draw_mark(pass, *frame.mark_at_model_m);
    if (layer_ != nullptr) layer_->draw_in_front(pass);
    for (const auto& handle : frame.handle)
        if (handle) draw_handle(pass, *handle);
    glDepthRange(0.0, 1.0);
    glDisable(GL_DEPTH_TEST);
}

Haze SceneView::haze_of(const EyeView& eye, const ViewOptions& options) const {
    Haze haze;
    haze.begin_a = eye.target_a - kHazeBegin * radius_a();
    haze.end_a = eye.target_a + kHazeEnd * radius_a();
    if (options.depth_cue) haze.strength = kHazeStrength;
    if (options.cut_a) haze.cut_a = std::max(eye.target_a - *options.cut_a, 0.0F);
    if (!options.gradient) haze.top = haze.bottom = options.plain_ground;
    return haze;
}

void SceneView::draw_force(const LayerPass& pass, const ViewFrame& frame) {
    const Eigen::Vector3f right = pass.eye_from_scene.topLeftCorner<1, 3>().transpose().normalized();
    const Eigen::Vector3f from =
        ((*frame.force_at_model_m - content_->centre_model_m) / kAngstromM).cast<float>() +
        frame.force_beside_a * right;
    Eigen::Vector3f along = frame.force_world_n.cast<float>() * pass.arrow_a_per_n;
    const float most = 3.0F * pass.size_a;
    if (along.norm() > most) along *= most / along.norm();
    const TubeMesh mesh = build_arrow(from, along, frame.force_thickness * pass.size_a, kForceColour);
    if (mesh.index.empty()) return;
    arrow_.fill(mesh, GL_STREAM_DRAW);
    programs_.use_lit(pass.eye_from_scene, pass.projection, pass.haze, {});
    arrow_.draw();
}

// A pin from above in the picture.
void SceneView::draw_mark(const LayerPass& pass, const Vec3& at_model_m) {
    const Eigen::Vector3f up = pass.eye_from_scene.block<1, 3>(1, 0).transpose().normalized();
    const Eigen::Vector3f at = ((at_model_m - content_->centre_model_m) / kAngstromM).cast<float>();
    const Eigen::Vector3f along = -kMarkLength * pass.size_a * up;
    mark_.fill(build_arrow(at - along, along, kMarkThickness * pass.size_a, kMarkColour), GL_STREAM_DRAW);
    programs_.use_lit(pass.eye_from_scene, pass.projection, pass.haze, {});
    mark_.draw();
}

void SceneView::draw_hand(const LayerPass& pass, const DrawnHand& hand) {
    const Eigen::Vector3f tip =
        ((hand.T_model_hand.p_m - content_->centre_model_m) / kAngstromM).cast<float>();
    const TubeMesh mesh = build_second_hand(hand, tip, pass.size_a, pass.arrow_a_per_n);
    if (mesh.index.empty()) return;
    hand_.fill(mesh, GL_STREAM_DRAW);
    programs_.use_lit(pass.eye_from_scene, pass.projection, pass.haze, {});
    hand_.draw();
    const TubeMesh wall = build_touched_wall(hand, tip, pass.size_a);
    if (wall.index.empty()) return;
    touched_wall_.fill(wall, GL_STREAM_DRAW);
    const auto share = [](std::uint8_t c) { return static_cast<float>(c) / 255.0F; };
    const Rgb8& c = kTouchedWallColour;
    const float rgba[4] = {share(c[0]), share(c[1]), share(c[2]), 1.0F};
    programs_.use_flat(pass.eye_from_scene, pass.projection, pass.haze, rgba);
    touched_wall_.draw();
}

// After all else and without depth: it lies over the tool.
void SceneView::draw_handle(const LayerPass& pass, const DrawnHandle& handle) {
    const auto in_scene = [this](const Vec3& model_m) {
        return Eigen::Vector3f(((model_m - content_->centre_model_m) / kAngstromM).cast<float>());
    };
    const Eigen::Vector3f at = in_scene(handle.at_model_m);
    const Eigen::Vector3f in_eye = (pass.eye_from_scene * at.homogeneous()).head<3>();
    if (!(in_eye.z() < 0.0F)) return;  // behind the eye
    const Eigen::Vector3f to_eye =
        -(pass.eye_from_scene.topLeftCorner<3, 3>().transpose() * in_eye).normalized();
    const float a_per_px =
        -2.0F * in_eye.z() / (pass.projection(1, 1) * static_cast<float>(std::max(pass.height_px, 1)));
    const TubeMesh mesh = build_mouse_handle(handle, at, in_scene(handle.target_model_m), to_eye, a_per_px);
    if (mesh.index.empty()) return;
    handle_.fill(mesh, GL_STREAM_DRAW);
    const auto share = [](std::uint8_t c) { return static_cast<float>(c) / 255.0F; };
    const Rgb8& c = kHandleColour;
    const float rgba[4] = {share(c[0]), share(c[1]), share(c[2]), 1.0F};
    Haze clear = pass.haze;
    clear.strength = 0.0F;
    programs_.use_flat(pass.eye_from_scene, pass.projection, clear, rgba);
    glDisable(GL_DEPTH_TEST);
    handle_.draw();
    glEnable(GL_DEPTH_TEST);
}

void SceneView::draw_box(const LayerPass& pass) {
    programs_.use_flat(pass.eye_from_scene, pass.projection, pass.haze, kBoxRgba);
    glBindVertexArray(box_array_.get());
    glDrawElements(GL_LINES, box_indices_, GL_UNSIGNED_INT, nullptr);
}

}  // namespace tact
