#include "gui/drilling/drilling_system.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include "gui/drilling/dust_state.hpp"
#include "gui/drilling/first_bone.hpp"
#include "gui/drilling/patient_sides.hpp"
#include "ipc/base/units.hpp"

namespace tact {
namespace {

constexpr double kFillS = 12e-3;       // per frame, to upload bone
constexpr float kBurrsShown = 4.0F;    // radii around a burr in close view
constexpr float kArrowShare = 0.006F;  // thickness of the force arrow, which stands beside the burr
constexpr double kLoadM3S = 12e-9;     // of bone: two thirds of the load that is heard
constexpr double kLoadS = 0.05;
constexpr double kFocusS = 0.4;       // in which the microscope's focus follows the burr
constexpr float kBesideRadii = 1.8F;  // of the burr

Eigen::Vector4f glow_of(Grade nearness) {
    if (nearness == Grade::bad) return {1.0F, 0.16F, 0.10F, 0.75F};
    if (nearness == Grade::watch) return {1.0F, 0.72F, 0.16F, 0.6F};
    return Eigen::Vector4f::Zero();
}

}  // namespace

void DrillingSystem::use(const std::shared_ptr<const SceneContent>& content,
                         std::unique_ptr<SceneStart> start, SceneView& view, const SystemContext& context) {
    content_ = content;
    view_ = &view;
    reach_a_ = 0.0F;
    focus_model_m_.reset();
    site_.reset();
    layer_ = std::make_unique<DrillingLayer>(content->centre_model_m);
    view.set_layer(layer_.get());
    auto* const made = dynamic_cast<DrillStart*>(start.get());
    bone_.use(made != nullptr ? std::move(made->follower) : nullptr);
    controller_.use(content);
    bone_.meet(context.controller);
    const BoneContent* const bone = content->of<BoneContent>();
    if (bone == nullptr || made == nullptr) return;
    show_sides(bone->patient, context.state.scene);
    panels_.voxels = bone->volume.bricks.size;
    panels_.voxel_m = bone->volume.bricks.voxel_m;
    site_ = std::move(made->site);
    site_->keep(options_.particles);
    layer_->show_bone(*bone, *bone_.volume());
    reach_a_ = layer_->bone()->reach_a();
    begin_training(*bone);
    if (!options_.mute && sound_ == nullptr) sound_ = std::make_unique<SoundDevice>(voice_);
}

void DrillingSystem::close() {
    if (view_ != nullptr) view_->set_layer(nullptr);
    view_ = nullptr;
    layer_.reset();
    site_.reset();
    bone_.use(nullptr);
    controller_.use(nullptr);
    sound_.reset();
    voice_.set({});
    training_.reset();
    before_.clear();
    panels_.training = {};
    content_.reset();
    reach_a_ = 0.0F;
    panels_.drilling = {};
    panels_.bone_shown = 1.0F;
}

void DrillingSystem::attach(const SystemContext& context) {
    bone_.meet(context.controller);
    controller_.meet();
}

void DrillingSystem::follow(const SystemContext& context) {
    bone_.follow();
    controller_.follow(context.controller, bone_.changes(), context.state, panels_.drilling);
    train(context);
    sound(context);
}

bool DrillingSystem::perform(KeyAction what, std::size_t place, const SystemContext& context) {
    static_cast<void>(place);
    // As the buttons, which are greyed without a cut.
    const auto order = [&](CommandKind kind, std::uint32_t cuts) {
        if (context.controller.attached() && cuts > 0 && !panels_.drilling.exchanging)
            context.state.requests.push_back({kind, 0.0, {}});
    };
    switch (what) {
        case KeyAction::approach_burr:
            approach_burr(context);
            return true;
        case KeyAction::smaller_burr:
            take_burr(next_burr(in_hand(), -1), context);
            return true;
        case KeyAction::larger_burr:
            take_burr(next_burr(in_hand(), 1), context);
            return true;
        case KeyAction::other_grit:
            take_burr(other_grit(in_hand()), context);
            return true;
        case KeyAction::microscope:
            context.state.toggles.microscope = !context.state.toggles.microscope;
            return true;
        case KeyAction::undo:
            order(CommandKind::undo_stroke, panels_.drilling.undoable);
            return true;
        case KeyAction::redo:
            order(CommandKind::redo_stroke, panels_.drilling.redoable);
            return true;
        default:
            return false;
    }
}

void DrillingSystem::sound(const SystemContext& context) {
    panels_.sound = "muted by --mute";
    if (sound_ == nullptr) return;
    panels_.sound =
        sound_->state() == SoundDevice::State::opening ? "opening the sound device" : sound_->problem();
    sound_->mute(!context.state.toggles.sound);
    const Controller& controller = context.controller;
    if (!controller.attached() || !controller.have_drill) return voice_.set({});
    const DrillHand &burr = controller.drill.hand[0], &tube = controller.drill.hand[1];
    const double dt_s = 1e-9 * static_cast<double>(controller.drill.taken_at_ns - heard_ns_);
    if (dt_s > 0.0) {
        const double taken_m3 =
            burr.removed_levels >= heard_levels_
                ? controller.drill.level_m3 * static_cast<double>(burr.removed_levels - heard_levels_)
                : 0.0;
        load_ += (1.0 - std::exp(-std::min(dt_s, 1.0) / kLoadS)) *
                 (1.0 - std::exp(-taken_m3 / std::min(dt_s, 1.0) / kLoadM3S) - load_);
        heard_levels_ = burr.removed_levels;
        heard_ns_ = controller.drill.taken_at_ns;
    }
    const Grade near = panels_.drilling.nearness;
    voice_.set({.turns_hz = burr.burr_rad_s / (2.0F * std::numbers::pi_v<float>),
                .load = static_cast<float>(load_),
                .suction = tube.suction,
                .signal = near == Grade::bad     ? NearSignal::close
                          : near == Grade::watch ? NearSignal::near
                                                 : NearSignal::none});
}

TrayBurr DrillingSystem::in_hand() const {
    const ToolDescription& burr = panels_.drilling.burr;
    return {burr.grit, static_cast<DrillShape>(burr.shape), burr.diameter_m, burr.length_m};
}

void DrillingSystem::take_burr(const TrayBurr& burr, const SystemContext& context) const {
    const DrillingState& d = panels_.drilling;
    const bool other = burr.grit != d.burr.grit || burr.diameter_m != d.burr.diameter_m;
    if (context.controller.attached() && d.known && d.burr.valid && other && !d.changing_burr)
        context.state.requests.push_back(burr_request(burr));
}

std::optional<Vec3> DrillingSystem::place_along(const Vec3& from_m, const Vec3& way) const {
    const BoneVolumeView* const volume = bone_.volume();
    return volume != nullptr ? first_bone(*volume, from_m, way) : std::nullopt;
}

void DrillingSystem::approach_burr(const SystemContext& context) const {
    const Controller& controller = context.controller;
    if (!content_ || !controller.attached() || !controller.have_drill) return;
    const DrillHand& hand = controller.drill.hand[0];
    if (hand.kind == DrillKind::none) return;
    const Vec3 at(hand.pos_model_m[0], hand.pos_model_m[1], hand.pos_model_m[2]);
    const double radius_m = static_cast<double>(hand.radius_m) / content_->meta.world_per_model;
    context.camera.approach(((at - content_->centre_model_m) / kAngstromM).cast<float>(),
                            kBurrsShown * static_cast<float>(radius_m / kAngstromM));
}

void DrillingSystem::move(double frame_s, const Vec3& eye_model_m, const SystemContext& context) {
    if (!site_) return;
    const Controller& controller = context.controller;
    if (const PathLevel* const path = controller.level(kParticlesPath)) particles_level_ = path->level;
    const bool told = controller.attached() && controller.have_drill;
    panels_.drilling.dust =
        told ? dust_of(site_->particles().ledger(), controller.drill.level_m3) : DrillingState::Dust{};
    site_->step({frame_s, told ? &controller.drill : nullptr, bone_.changes(), particles_share(context),
                 eye_model_m});
}

float DrillingSystem::particles_share(const SystemContext& context) const {
    const Controller& controller = context.controller;
    const bool by_hand = controller.have_levels && std::string_view(controller.levels.law) ==
                                                       "fixed";  // null-terminated, as checked on reading
    if (!context.software || by_hand) return particles_level_;
    return std::min(particles_level_,
                    static_cast<float>(particle_pace_.most()) / static_cast<float>(SiteEffects::kMost));
}

std::uint32_t DrillingSystem::rays_most(const ViewFrame& frame, bool sharp, const SystemContext& context) {
    if (const PathLevel* const path = context.controller.level(kVolumePath))
        rays_share_ = static_cast<double>(path->level);
    const double pixels = static_cast<double>(frame.width_px) * frame.height_px;
    if (sharp) return static_cast<std::uint32_t>(pixels);
    const auto rays = static_cast<std::uint32_t>(std::lround(rays_share_ * pixels));
    return context.software ? std::min(rays, ray_pace_.rays_most()) : rays;
}

// Of the microscope: the last place where the burr was in bone, else what the view turns about.
Vec3 DrillingSystem::focus(std::int64_t now_ns, const SystemContext& context) {
    const Controller& controller = context.controller;
    const double dt_s = std::clamp(1e-9 * static_cast<double>(now_ns - focus_ns_), 0.0, 1.0);
    focus_ns_ = now_ns;
    const DrillHand& burr = controller.drill.hand[0];
    if (controller.attached() && controller.have_drill && burr.depth > 0.0F) {
        const Vec3 at(burr.pos_model_m[0], burr.pos_model_m[1], burr.pos_model_m[2]);
        if (!focus_model_m_) focus_model_m_ = at;
        *focus_model_m_ += (1.0 - std::exp(-dt_s / kFocusS)) * (at - *focus_model_m_);
    }
    return focus_model_m_.value_or(content_->centre_model_m +
                                   kAngstromM * context.camera.target_a().cast<double>());
}

void DrillingSystem::prepare(std::int64_t now_ns, bool sharp, ViewFrame& frame,
                             const SystemContext& context) {
    const Controller& controller = context.controller;
    if (site_) {
        DrillingLayer::Frame& drawn = layer_->frame = {};
        drawn.bone_rays = rays_most(frame, sharp, context);
        if (!sharp) drawn.bone_fill_s = kFillS;
        if (BoneView* const bone = layer_->bone()) {
            for (const BrickChange& c : bone_.changes()) bone->changed(c.brick, c.grown());
            bone->wetted(site_->wet());
        }
        if (controller.attached() && controller.have_drill)
            drawn.tools = hands_.follow(controller.drill, content_->meta);
        drawn.particles = &site_->particles();
        drawn.time_particles = context.software;
        drawn.microscope = context.state.toggles.microscope;
        drawn.focus_model_m = focus(now_ns, context);
        if (!drawn.tools.empty()) {
            frame.force_at_model_m = drawn.tools.front().T_model_tool.p_m;
            frame.force_thickness = kArrowShare;
            frame.force_beside_a =
                kBesideRadii * static_cast<float>(drawn.tools.front().radius_m / kAngstromM);
            drawn.burr_glow = glow_of(panels_.drilling.nearness);
        }
    }
    if (training_ && before_.empty() && layer_->bone() != nullptr) before_ = pictures();
    if (near_burr_wanted_ && controller.have_drill && controller.drill.hand[0].depth > 0.0F) {
        near_burr_wanted_ = false;
        approach_burr(context);
    }
}

void DrillingSystem::drawn(const SystemContext& context) {
    if (!layer_->bone_error().empty()) context.state.scene.warning = layer_->bone_error();
    panels_.bone_shown = layer_->bone() != nullptr ? layer_->bone()->filled() : 1.0F;
    if (site_ && context.software)
        particle_pace_.took(site_->particles().shown().size(), layer_->particles_draw_s());
}

void DrillingSystem::ended(double work_s) {
    if (layer_ && layer_->bone() != nullptr) ray_pace_.took(layer_->bone()->rays(), work_s);
}

void DrillingSystem::add_to(LoadTopic& load) const {
    if (site_) {
        load.particles = site_->metrics().shown;
        load.particle_moves = std::min(site_->metrics().moves, site_->metrics().most);
        load.particles_max = site_->metrics().most;
    }
    const BoneView* const bone = layer_ ? std::as_const(*layer_).bone() : nullptr;
    if (bone != nullptr) {
        load.vertices_max = bone->rays_max();
        load.vertices_drawn = std::clamp(bone->rays(), 1U, load.vertices_max);
    }
}

void DrillingSystem::finish(const SystemContext& context) {
    let_training_rest(context);
    const Controller& controller = context.controller;
    if (site_) {
        const Ledger& l = site_->particles().ledger();
        spdlog::info(
            "bone density levels: {} removed by the controller, {} received while shown: {} sucked, {} "
            "carried, "
            "{} left, {} in bone that came back, {} too few for a grain",
            controller.have_drill ? controller.drill.removed_levels : 0, l.drilled, l.sucked, l.carried,
            l.left, l.buried, l.pooled);
    }
    controller_.save(options_.report, visibility(), end_training());
}

}  // namespace tact
