#include "gui/drilling/drilling_layer.hpp"

#include <algorithm>

#include "gui/render/scene_frame.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"

namespace tact {

void DrillingLayer::draw_structures(const LayerPass& pass) {
    const std::size_t count = std::min(frame.tools.size(), tool_.size());
    for (std::size_t i = 0; i < count; ++i) {
        const DrawnDrillTool& tool = frame.tools[i];
        ToolInHand& hand = tool_[i];
        if (!tool.same_shape(hand.shape)) {
            const DrillToolMesh mesh = build_drill_tool(tool);
            hand.head.fill(mesh.head, GL_STATIC_DRAW);
            hand.rest.fill(mesh.rest, GL_STATIC_DRAW);
            hand.shape = tool;
        }
        Pose turned = tool.T_model_tool;
        turned.q = turned.q * Quat(Eigen::AngleAxisd(tool.turned_rad, Vec3::UnitZ()));
        const Eigen::Matrix4f eye_from_tool = pass.eye_from_scene * scene_from_body(turned, centre_model_m_);
        pass.programs.use_lit(eye_from_tool, pass.projection, pass.haze.uncut(), {});
        hand.rest.draw();
        if (hand.head.indices() == 0) continue;
        pass.programs.use_lit(eye_from_tool, pass.projection, pass.haze.uncut(), {.tint = frame.burr_glow});
        hand.head.draw();
    }
}

void DrillingLayer::draw_volume(const LayerPass& pass) {
    if (!bone_) return;
    const PassClock::Scope scope(pass.passes, Pass::bone);
    try {
        bone_->draw({.eye_from_scene = pass.eye_from_scene,
                     .projection = pass.projection,
                     .haze = pass.haze,
                     .x_px = pass.x_px,
                     .y_px = pass.y_px,
                     .width_px = pass.width_px,
                     .height_px = pass.height_px,
                     .rays_most = frame.bone_rays / static_cast<std::uint32_t>(pass.eyes),
                     .eye = pass.eye,
                     .fill_s = frame.bone_fill_s,
                     .coaxial_light = frame.microscope});
    } catch (const StartupError& e) {
        bone_error_ = e.what();
        bone_.reset();
        glViewport(pass.x_px, pass.y_px, pass.width_px, pass.height_px);
    }
}

void DrillingLayer::draw_fluids(const LayerPass& pass) {
    if (frame.particles != nullptr) draw_particles(pass);
    if (!frame.microscope) return;
    const PassClock::Scope scope(pass.passes, Pass::edges);
    if (!microscope_) microscope_ = std::make_unique<Microscope>();
    const Eigen::Vector3f focus_a = ((frame.focus_model_m - centre_model_m_) / kAngstromM).cast<float>();
    const float ahead_a = -(pass.eye_from_scene * focus_a.homogeneous()).z();
    microscope_->draw(
        {pass.x_px, pass.y_px, pass.width_px, pass.height_px, pass.projection, std::max(ahead_a, 0.0F)});
}

void DrillingLayer::draw_particles(const LayerPass& pass) {
    if (frame.time_particles) {  // excludes remaining work on the bone
        const PassClock::Scope scope(pass.passes, Pass::bone);
        glFinish();
    }
    const PassClock::Scope scope(pass.passes, Pass::particles);
    if (!cloud_) cloud_ = std::make_unique<ParticleCloud>();
    const ParticleCells& cells = frame.particles->cells();
    const Instant begin = Monotonic::now();
    cloud_->fill(frame.particles->shown());
    Eigen::Matrix4f model_from_cells = Eigen::Matrix4f::Identity();
    model_from_cells.topLeftCorner<3, 3>() *= static_cast<float>(cells.cell_m());
    model_from_cells.topRightCorner<3, 1>() = cells.to_model(Vec3::Zero()).cast<float>();
    cloud_->draw({pass.eye_from_scene * scene_from_model(centre_model_m_) * model_from_cells, pass.projection,
                  static_cast<float>(cells.cell_m()) * kSceneAPerM, pass.haze, pass.x_px, pass.y_px,
                  pass.width_px, pass.height_px});
    if (!frame.time_particles) return;
    glFinish();
    particles_draw_s_ = to_s(Monotonic::now() - begin);
}

}  // namespace tact
