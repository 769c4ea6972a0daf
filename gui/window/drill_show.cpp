#include "gui/window/drill_show.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace tact {
namespace {

constexpr double kFillS = 12e-3;  // of a picture, for bone that goes into graphics memory

}  // namespace

void DrillShow::use(const std::shared_ptr<const SceneContent>& content, const Controller& controller,
                    DrillStart start, SceneView& view, std::uint32_t particles) {
    content_ = content;
    site_.reset();
    bone_.use(std::move(start.follower));
    desk_.use(content);
    bone_.meet(controller);
    if (!content->bone) return;
    site_ = std::move(start.site);
    site_->keep(particles);
    view.show_bone(*bone_.volume());
}

void DrillShow::meet(const Controller& controller) {
    bone_.meet(controller);
    desk_.meet();
}

void DrillShow::follow(Controller& controller, DashboardState& dashboard, DrillingState& state) {
    bone_.follow();
    desk_.follow(controller, bone_.changes(), dashboard, state);
}

void DrillShow::move(const Controller& controller, double frame_s, const Vec3& eye_model_m) {
    if (!site_) return;
    if (const PathLevel* const path = controller.level(kParticlesPath)) particles_level_ = path->level;
    const bool told = controller.attached() && controller.have_drill;
    site_->step({frame_s, told ? &controller.drill : nullptr, bone_.changes(), particles_share(controller),
                 eye_model_m});
}

float DrillShow::particles_share(const Controller& controller) const {
    const bool by_hand = controller.have_levels &&
                         std::string_view(controller.levels.law) == "fixed";  // ends with 0, as was checked
    if (!software_ || by_hand) return particles_level_;
    return std::min(particles_level_,
                    static_cast<float>(particle_pace_.most()) / static_cast<float>(SiteEffects::kMost));
}

std::uint32_t DrillShow::rays_most(const Controller& controller, const ViewFrame& frame, bool sharp) {
    if (const PathLevel* const path = controller.level(kVolumePath))
        rays_share_ = static_cast<double>(path->level);
    const double pixels = static_cast<double>(frame.width_px) * frame.height_px;
    if (sharp) return static_cast<std::uint32_t>(pixels);
    const auto rays = static_cast<std::uint32_t>(std::lround(rays_share_ * pixels));
    return software_ ? std::min(rays, ray_pace_.rays_most()) : rays;
}

void DrillShow::prepare(const Controller& controller, SceneView& view, bool sharp, ViewFrame& frame) {
    if (!site_) return;
    frame.bone_rays = rays_most(controller, frame, sharp);
    if (!sharp) frame.bone_fill_s = kFillS;
    if (BoneView* const bone = view.bone())
        for (const BrickChange& c : bone_.changes()) bone->changed(c.brick);
    if (controller.attached() && controller.have_drill)
        frame.drill_tools = hands_.follow(controller.drill, content_->meta);
    frame.particles = &site_->particles();
    frame.time_particles = software_;
}

void DrillShow::drawn(SceneView& view, DashboardState& state) {
    if (!view.bone_error().empty()) state.scene.warning = view.bone_error();
    state.scene.bone_shown = view.bone() != nullptr ? view.bone()->filled() : 1.0F;
    if (site_ && software_) particle_pace_.took(site_->particles().shown().size(), view.particles_draw_s());
}

void DrillShow::ended(SceneView& view, double work_s) {
    if (view.bone() != nullptr) ray_pace_.took(view.bone()->rays(), work_s);
}

void DrillShow::add_to(LoadTopic& load, SceneView& view) const {
    if (site_) {
        load.particles = site_->metrics().shown;
        load.particle_moves = std::min(site_->metrics().moves, site_->metrics().most);
        load.particles_max = site_->metrics().most;
    }
    if (view.bone() != nullptr) {
        load.vertices_max = view.bone()->rays_max();
        load.vertices_drawn = std::clamp(view.bone()->rays(), 1U, load.vertices_max);
    }
}

void DrillShow::save(const Controller& controller, const std::string& report) const {
    std::optional<BurrVisibility> visibility;
    if (site_) {
        visibility = {site_->metrics().drilling_s, site_->metrics().seen_s};
        const Ledger& l = site_->particles().ledger();
        spdlog::info(
            "levels of bone: {} taken by the controller, {} seen to go while shown: {} sucked, {} carried, "
            "{} left, {} "
            "given up, {} too few for a grain",
            controller.have_drill ? controller.drill.removed_levels : 0, l.drilled, l.sucked, l.carried,
            l.left, l.given_up, l.pooled);
    }
    desk_.save(report, visibility);
}

}  // namespace tact
