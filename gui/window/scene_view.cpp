#include "gui/window/scene_view.hpp"

#include <algorithm>
#include <cmath>

#include "gui/render/arrow.hpp"
#include "gui/render/camera.hpp"
#include "gui/surface/drawn_tool.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"

namespace tact {
namespace {

constexpr float kAPerM = 1e10F;
// Balls of a fine codebook must not hide the backbone: smaller where there are more of them.
float ball_radius_a(GLsizei points) {
    return std::clamp(1.3F * std::cbrt(50.0F / static_cast<float>(std::max(points, 1))), 0.5F, 1.4F);
}

// More vectors than this are a cloud that hides the backbone, and cost a picture in software its rate.
constexpr std::uint32_t kCodebookShownMax = 400;
constexpr float kBallRgba[4] = {0.93F, 0.94F, 0.97F, 1.0F};
constexpr float kGraphRgba[4] = {0.80F, 0.84F, 0.90F, 0.38F};
constexpr float kBoxRgba[4] = {0.55F, 0.62F, 0.72F, 0.55F};
constexpr float kEdgeRgba[4] = {0.02F, 0.03F, 0.05F, 0.28F};
// Depth cue: from somewhat before the target to well behind it, in radii of the scene.
constexpr float kHazeBegin = 0.6F, kHazeEnd = 1.6F, kHazeStrength = 0.8F;

Eigen::Matrix4f scene_from_model(const Vec3& centre_m) {
    Eigen::Matrix4f m = Eigen::Matrix4f::Zero();
    m.topLeftCorner<3, 3>() = kAPerM * Eigen::Matrix3f::Identity();
    m.topRightCorner<3, 1>() = (-centre_m / kAngstromM).cast<float>();
    m(3, 3) = 1.0F;
    return m;
}

}  // namespace

struct SceneView::Pass {
    const ViewOptions& options;
    const ViewFrame& frame;
    Eigen::Matrix4f eye_from_scene, projection;
    Haze haze;
};

std::size_t codebook_level(const Codebook& codebook, std::uint32_t points_summed) {
    std::size_t best = 0;
    for (std::size_t l = 0; l < codebook.levels.size(); ++l)
        if (codebook.levels[l].size() <= std::min(points_summed, kCodebookShownMax)) best = l;
    return best;
}

SceneView::SceneView(std::shared_ptr<const SceneContent> content, Programs& programs, RefineContour refine)
    : content_(std::move(content)),
      programs_(programs),
      molecules_(content_, programs),
      contours_(content_, programs, std::move(refine)) {
    for (const Codebook& codebook : content_->codebooks) {
        codebooks_.emplace_back();
        for (const Codebook::Level& level : codebook.levels) codebooks_.back().push_back(make_points(level));
    }
    Codebook::Level corners;
    for (std::uint32_t k = 0; k < 8; ++k) {
        const Vec3 p((k & 1U) != 0 ? content_->box_max_model_m.x() : content_->box_min_model_m.x(),
                     (k & 2U) != 0 ? content_->box_max_model_m.y() : content_->box_min_model_m.y(),
                     (k & 4U) != 0 ? content_->box_max_model_m.z() : content_->box_min_model_m.z());
        const Eigen::Vector3f f = (p - content_->centre_model_m).cast<float>();
        corners.x_m.push_back(f.x());
        corners.y_m.push_back(f.y());
        corners.z_m.push_back(f.z());
        for (const std::uint32_t bit : {1U, 2U, 4U})
            if ((k & bit) == 0) corners.edges.push_back({k, k | bit});
    }
    box_ = make_points(corners);
    if (content_->tool) tool_.fill(build_drawn_tool(*content_->tool), GL_STATIC_DRAW);
}

SceneView::Points SceneView::make_points(const Codebook::Level& level) {
    Points points;
    std::vector<float> xyz;
    xyz.reserve(3 * level.size());
    for (std::size_t i = 0; i < level.size(); ++i)
        xyz.insert(xyz.end(), {level.x_m[i] * kAPerM, level.y_m[i] * kAPerM, level.z_m[i] * kAPerM});
    glBindVertexArray(points.array.get());
    glBindBuffer(GL_ARRAY_BUFFER, points.vertices.get());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(xyz.size() * sizeof(float)), xyz.data(),
                 GL_STATIC_DRAW);
    attribute(0, 3, GL_FLOAT, GL_FALSE, 12, 0);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, points.edges.get());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(level.edges.size() * sizeof(level.edges[0])), level.edges.data(),
                 GL_STATIC_DRAW);
    points.points = static_cast<GLsizei>(level.size());
    points.edge_indices = static_cast<GLsizei>(2 * level.edges.size());
    glBindVertexArray(0);
    return points;
}

float SceneView::radius_a() const { return static_cast<float>(content_->radius_m / kAngstromM); }

float SceneView::arrow_a_per_n() const {
    return std::max(1.0F, static_cast<float>(round_length(0.9 * static_cast<double>(radius_a()))));
}

void SceneView::draw(const EyeView& eye, const ViewOptions& options, const ViewFrame& frame) {
    const Pass pass{options, frame, eye.eye_from_scene, eye.projection, haze_of(eye, options)};
    glEnable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    draw_structures(pass);
    draw_bone(pass);
    const Eigen::Matrix4f eye_from_model = pass.eye_from_scene * scene_from_model(content_->centre_model_m);
    const bool detail = options.detail && detail_.indices() > 0, surface = options.surface && !detail;
    {
        const PassClock::Scope scope(frame.passes, tact::Pass::surface);
        if (detail) draw_detail(pass);
        if (surface) contours_.draw_opaque(eye_from_model, pass.projection, pass.haze, options.style);
    }
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    if (options.codebook || options.graph || options.box) {
        const PassClock::Scope scope(frame.passes, tact::Pass::marks);
        if (options.codebook || options.graph) draw_codebook(pass);
        if (options.box) draw_box(pass);
    }
    if (surface) {
        const PassClock::Scope scope(frame.passes, tact::Pass::surface);
        contours_.draw_clear(eye_from_model, pass.projection, pass.haze, options.style);
    }
    glDisable(GL_BLEND);
    if (frame.particles != nullptr) draw_particles(pass);
    draw_in_front(pass);
    glBindVertexArray(0);
    glUseProgram(0);
    if (!options.smooth_edges) return;
    const PassClock::Scope scope(frame.passes, tact::Pass::edges);
    if (!edges_) edges_ = std::make_unique<EdgeSmoothing>();
    edges_->smooth(frame.x_px, frame.y_px, frame.width_px, frame.height_px);
}

void SceneView::draw_structures(const Pass& pass) {
    const ViewFrame& frame = pass.frame;
    const PassClock::Scope scope(frame.passes, tact::Pass::structures);
    if (pass.options.backbone) molecules_.draw(frame.bodies, pass.eye_from_scene, pass.projection, pass.haze);
    if (frame.T_model_tool) draw_tool(pass);
    draw_drill_tools(pass);
}

// Always seen, also inside the structures: everything else is drawn, so its depth may go.
void SceneView::draw_in_front(const Pass& pass) {
    const PassClock::Scope scope(pass.frame.passes, tact::Pass::marks);
    glClear(GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    if (pass.options.force) draw_force(pass);
    if (pass.frame.second_hand) draw_second_hand(pass);
    if (pass.frame.touch) draw_touch(pass);
    glDisable(GL_DEPTH_TEST);
}

Haze SceneView::haze_of(const EyeView& eye, const ViewOptions& options) const {
    Haze haze;
    haze.begin_a = eye.target_a - kHazeBegin * radius_a();
    haze.end_a = eye.target_a + kHazeEnd * radius_a();
    if (options.depth_cue) haze.strength = kHazeStrength;
    if (!options.gradient) haze.top = haze.bottom = options.plain_ground;
    return haze;
}

void SceneView::draw_codebook(const Pass& pass) {
    for (const DrawnBody& body : pass.frame.bodies) {
        const std::size_t s = body.structure;
        if (body.hidden || s >= codebooks_.size() || codebooks_[s].empty()) continue;
        Points& points = codebooks_[s][codebook_level(content_->codebooks[s], pass.frame.points_summed)];
        const Eigen::Matrix4f eye =
            pass.eye_from_scene * scene_from_body(body.T_model_body, content_->centre_model_m);
        glBindVertexArray(points.array.get());
        if (pass.options.graph) {
            programs_.use_flat(eye, pass.projection, pass.haze, kGraphRgba);
            glDrawElements(GL_LINES, points.edge_indices, GL_UNSIGNED_INT, nullptr);
        }
        if (pass.options.codebook) {
            glEnable(GL_PROGRAM_POINT_SIZE);
            programs_.use_balls(eye, pass.projection, pass.haze, kBallRgba, ball_radius_a(points.points),
                                static_cast<float>(pass.frame.height_px));
            glDrawArrays(GL_POINTS, 0, points.points);
            glDisable(GL_PROGRAM_POINT_SIZE);
        }
    }
}

void SceneView::draw_force(const Pass& pass) {
    const ViewFrame& f = pass.frame;
    if (f.active >= f.bodies.size() && f.drill_tools.empty()) return;
    const Vec3& held_m =
        f.drill_tools.empty() ? f.bodies[f.active].T_model_body.p_m : f.drill_tools.front().T_model_tool.p_m;
    const Eigen::Vector3f from = ((held_m - content_->centre_model_m) / kAngstromM).cast<float>();
    Eigen::Vector3f along = pass.frame.force_world_n.cast<float>() * arrow_a_per_n();
    const float most = 3.0F * radius_a();
    if (along.norm() > most) along *= most / along.norm();
    const TubeMesh mesh =
        build_arrow(from, along, (f.drill_tools.empty() ? 0.02F : 0.012F) * radius_a(), kForceColour);
    if (mesh.index.empty()) return;
    arrow_.fill(mesh, GL_STREAM_DRAW);
    programs_.use_lit(pass.eye_from_scene, pass.projection, pass.haze, {});
    arrow_.draw();
}

void SceneView::draw_tool(const Pass& pass) {
    if (tool_.indices() == 0) return;
    programs_.use_lit(
        pass.eye_from_scene * scene_from_body(*pass.frame.T_model_tool, content_->centre_model_m),
        pass.projection, pass.haze, {});
    tool_.draw();
}

void SceneView::draw_bone(const Pass& pass) {
    if (!bone_) return;
    const ViewFrame& f = pass.frame;
    const PassClock::Scope scope(f.passes, tact::Pass::bone);
    try {
        bone_->draw({pass.eye_from_scene, pass.projection, pass.haze, f.x_px, f.y_px, f.width_px, f.height_px,
                     f.bone_rays, f.eye, f.bone_fill_s});
    } catch (const StartupError& e) {
        bone_error_ = e.what();
        bone_.reset();
        glViewport(f.x_px, f.y_px, f.width_px, f.height_px);
    }
}

void SceneView::draw_drill_tools(const Pass& pass) {
    const std::size_t count = std::min(pass.frame.drill_tools.size(), drill_tool_.size());
    for (std::size_t i = 0; i < count; ++i) {
        const DrawnDrillTool& tool = pass.frame.drill_tools[i];
        ToolInHand& hand = drill_tool_[i];
        if (!tool.same_shape(hand.shape)) {
            hand.mesh.fill(build_drill_tool(tool), GL_STATIC_DRAW);
            hand.shape = tool;
        }
        Pose turned = tool.T_model_tool;
        turned.q = turned.q * Quat(Eigen::AngleAxisd(tool.turned_rad, Vec3::UnitZ()));
        programs_.use_lit(pass.eye_from_scene * scene_from_body(turned, content_->centre_model_m),
                          pass.projection, pass.haze, {});
        hand.mesh.draw();
    }
}

void SceneView::show_detail(const DetailMesh& detail) { detail_.fill(detail.mesh, GL_STREAM_DRAW); }

// Faces, and their edges upon them.
void SceneView::draw_detail(const Pass& pass) {
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1.0F, 1.0F);
    programs_.use_lit(pass.eye_from_scene, pass.projection, pass.haze, {});
    detail_.draw();
    glDisable(GL_POLYGON_OFFSET_FILL);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    programs_.use_flat(pass.eye_from_scene, pass.projection, pass.haze, kEdgeRgba);
    detail_.draw();
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glDisable(GL_BLEND);
}

void SceneView::draw_second_hand(const Pass& pass) {
    const DrawnHand& hand = *pass.frame.second_hand;
    const Eigen::Vector3f tip =
        ((hand.T_model_hand.p_m - content_->centre_model_m) / kAngstromM).cast<float>();
    const TubeMesh mesh = build_second_hand(hand, tip, radius_a(), arrow_a_per_n());
    if (mesh.index.empty()) return;
    second_hand_.fill(mesh, GL_STREAM_DRAW);
    programs_.use_lit(pass.eye_from_scene, pass.projection, pass.haze, {});
    second_hand_.draw();
    const TubeMesh wall = build_touched_wall(hand, tip, radius_a());
    if (wall.index.empty()) return;
    touched_wall_.fill(wall, GL_STREAM_DRAW);
    const auto share = [](std::uint8_t c) { return static_cast<float>(c) / 255.0F; };
    const Rgb8& c = kTouchedWallColour;
    const float rgba[4] = {share(c[0]), share(c[1]), share(c[2]), 1.0F};
    programs_.use_flat(pass.eye_from_scene, pass.projection, pass.haze, rgba);
    touched_wall_.draw();
}

void SceneView::draw_touch(const Pass& pass) {
    const TubeMesh marks =
        build_touch_marks(*pass.frame.touch, content_->centre_model_m, radius_a(), arrow_a_per_n());
    if (marks.index.empty()) return;
    touch_marks_.fill(marks, GL_STREAM_DRAW);
    programs_.use_lit(pass.eye_from_scene, pass.projection, pass.haze, {});
    touch_marks_.draw();
}

// Over all that is solid, which hides them by its depth.
void SceneView::draw_particles(const Pass& pass) {
    if (pass.frame.time_particles) {  // what is left of the bone is not theirs
        const PassClock::Scope scope(pass.frame.passes, tact::Pass::bone);
        glFinish();
    }
    const PassClock::Scope scope(pass.frame.passes, tact::Pass::particles);
    if (!cloud_) cloud_ = std::make_unique<ParticleCloud>();
    const ParticleCells& cells = pass.frame.particles->cells();
    const Instant begin = Monotonic::now();
    cloud_->fill(pass.frame.particles->shown());
    Eigen::Matrix4f model_from_cells = Eigen::Matrix4f::Identity();
    model_from_cells.topLeftCorner<3, 3>() *= static_cast<float>(cells.cell_m());
    model_from_cells.topRightCorner<3, 1>() = cells.to_model(Vec3::Zero()).cast<float>();
    cloud_->draw({pass.eye_from_scene * scene_from_model(content_->centre_model_m) * model_from_cells,
                  pass.projection, static_cast<float>(cells.cell_m()) * kAPerM, pass.haze, pass.frame.x_px,
                  pass.frame.y_px, pass.frame.width_px, pass.frame.height_px});
    if (!pass.frame.time_particles) return;
    glFinish();
    particles_draw_s_ = to_s(Monotonic::now() - begin);
}

void SceneView::draw_box(const Pass& pass) {
    programs_.use_flat(pass.eye_from_scene, pass.projection, pass.haze, kBoxRgba);
    glBindVertexArray(box_.array.get());
    glDrawElements(GL_LINES, box_.edge_indices, GL_UNSIGNED_INT, nullptr);
}

}  // namespace tact
