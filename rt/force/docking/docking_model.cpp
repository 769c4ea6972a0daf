// The grip keeps the vector from tool to centre of mass constant in world axes and the rotation from tool to
// body constant in tool axes. Then dc_world = dp_tool and dphi is the tool's rotation, so the wrench of
// level_blend.cpp about the centre of mass equals the wrench at the tool's origin. A grip with a lever arm
// would have to transfer the torque.
#include "rt/force/docking/docking_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "ipc/base/error.hpp"
#include "rt/force/docking/reach.hpp"

namespace tact {
namespace {

constexpr double kFlexibleCost = 1.3;  // of a step that bends the body too, in steps of a rigid one
constexpr float kLevelJump = 0.011F;   // change of the knob in one step; its slew rate is below

}  // namespace

DockingModel::DockingModel(const SceneMeta& meta, const DensityGrid& grid,
                           const std::vector<Structure>& structures, const std::vector<Codebook>& codebooks,
                           const DockingSettings& settings, const std::vector<NormalModes>& modes)
    : parts_(make_docking_parts(meta, grid, structures, codebooks, modes)),
      energy_j_per_sigma_(start_energy_j_per_sigma(meta, settings)),
      whole_(make_force_map(*parts_, newtons_per_gradient(), 0, {})),
      built_(whole_),
      force_map_(whole_.get()),
      bodies_(start_bodies(*parts_, settings), static_cast<std::uint32_t>(parts_->structures.size())),
      flexible_(parts_->flexible, parts_->levels) {
    clash_gains_ = parts_->clash_gains;
    clash_gains_.force_n *= settings.force_scale;
    clash_gains_.stiffness_n_m *= settings.force_scale;
    clash_gains_.stiffness_n_m_max *= settings.force_scale;
    clash_gains_.torque_n_m_rad_max *= settings.force_scale;
    pull_scale_ = settings.force_scale;
    if (settings.flexible) {
        if (modes.empty() || std::none_of(parts_->flexible.begin(), parts_->flexible.end(),
                                          [](const FlexibleParts& p) { return p.bends(); }))
            throw StartupError("letting structures bend", "the scene has no normal modes",
                               "bake it with them: --modes 12");
        static_cast<void>(set_options(kDockingFlexible, true));
    }
    error_scale_.fill(1.0);
    bends_scale_.fill({1.0, 1.0});
}

DockingModel::DockingModel(const DockingModel& like, const ModelBodies& bodies)
    : parts_(like.parts_),
      energy_j_per_sigma_(like.energy_j_per_sigma_),
      clash_gains_(like.clash_gains_),
      pull_scale_(like.pull_scale_),
      bodies_({}, static_cast<std::uint32_t>(parts_->structures.size())),
      flexible_(parts_->flexible, parts_->levels) {
    const std::uint32_t asked = bodies.options_asked & kForceMapOptions;
    const std::uint32_t asked_whole = asked & ~kDockingSubtraction;
    whole_ = like.whole_->options == asked_whole
                 ? like.whole_
                 : make_force_map(*parts_, newtons_per_gradient(), asked_whole, bodies);
    built_ = asked == asked_whole ? whole_ : make_force_map(*parts_, newtons_per_gradient(), asked, bodies);
    force_map_ = built_.get();
    bodies_.list() = bodies;
    topic_ = like.topic_;
    error_scale_.fill(1.0);
    bends_scale_.fill({1.0, 1.0});
}

LevelBlend DockingModel::blend() const noexcept {
    const std::size_t structure = bodies_.structure();
    return {.maps = force_map_->maps,
            .levels = flexible_.levels(structure),
            .metrics = force_map_->metrics[structure],
            .error_scale = error_scale_[structure],
            .energy_j_per_sigma = energy_j_per_sigma_,
            .newtons_per_gradient = newtons_per_gradient()};
}

KnobSpec DockingModel::knob() const noexcept {
    KnobSpec spec;
    spec.path = kKnobPath;
    spec.floor = 0.0F;
    spec.start = blend().start_fidelity();
    spec.slew_per_s = 4.0F;
    spec.haptic = true;
    spec.steps = static_cast<std::uint32_t>(parts_->levels[bodies_.structure()].size() - 1);
    return spec;
}

PathLoad DockingModel::predict(float fidelity) const noexcept {
    if (!bodies_.in_hand()) return {};
    PathLoad load = blend().predict(fidelity);
    if (is_flexible())
        load.cost_predicted = Duration(
            static_cast<std::int64_t>(kFlexibleCost * static_cast<double>(load.cost_predicted.count())));
    return load;
}

std::uint32_t DockingModel::items(float fidelity) const noexcept {
    return bodies_.in_hand() ? blend().items(fidelity) : 0;
}

ModelStiffness DockingModel::of_clash() const noexcept {
    const bool clash = (bodies_.list().options_asked & kDockingClash) != 0;
    if (!clash || (stepped_ && !at_others_)) return {};
    const bool together = (bodies_.list().options_asked & kDockingTogether) != 0;
    const double scale = together ? kTogetherStiffness : 1.0;
    return {.force_n_m = scale * clash_gains_.stiffness_n_m_max,
            .torque_n_m_rad = scale * clash_gains_.torque_n_m_rad_max};
}

ModelStiffness DockingModel::stiffness() const noexcept {
    if (!bodies_.in_hand()) return {};
    const LevelBlend levels = blend();
    const BendNorms& scale = bends_scale_[bodies_.structure()];
    BendNorms bends;
    if (stepped_) {
        const Pose& body = bodies_.list().T_model_body[bodies_.list().active];
        bends = stiffness_audit_.bound(levels, level_before_, body, scale);
    }
    // Any level, or any smaller one, may have been used.
    const std::size_t unknown = !stepped_    ? levels.levels.size()
                                : fell_back_ ? levels.plan(level_before_).lower
                                             : 0;
    for (std::size_t l = 0; l < unknown; ++l) {
        const BendNorms& most = levels.metrics[l].bends;
        bends.by_shift = std::max(bends.by_shift, scale.by_shift * most.by_shift);
        bends.by_turn = std::max(bends.by_turn, scale.by_turn * most.by_turn);
    }
    const double scale_2 = parts_->meta.world_per_model * parts_->meta.world_per_model;
    const ModelStiffness clash = of_clash();
    ModelStiffness pull;
    if (is_pulled())
        pull = BasinPull::stiffness(parts_->gyration_m[bodies_.structure()], parts_->meta.world_per_model);
    return {.force_n_m = energy_j_per_sigma_ / scale_2 * bends.by_shift + clash.force_n_m +
                         pull_scale_ * pull.force_n_m,
            .torque_n_m_rad = energy_j_per_sigma_ * bends.by_turn + clash.torque_n_m_rad +
                              pull_scale_ * pull.torque_n_m_rad};
}

StepResult DockingModel::evaluate(const Pose& T_model_body, const Budget& budget) const noexcept {
    if (T_model_body.finite() && !bodies_.in_hand()) return {};
    StepResult result = blend().evaluate(T_model_body, budget);
    static_cast<void>(add_clash(T_model_body, result));
    static_cast<void>(add_pull(T_model_body, result));
    return result;
}

bool DockingModel::is_flexible() const noexcept {
    return (bodies_.list().options_asked & kDockingFlexible) != 0 && bodies_.in_hand() &&
           flexible_.can_bend(bodies_.structure());
}

void DockingModel::bend(const Pose& T_model_body, const Budget& budget, StepResult& result) noexcept {
    const Instant begin = Monotonic::now();
    const bool on = (bodies_.list().options_asked & kDockingFlexible) != 0;
    flexible_.hold(bodies_.active_id(), bodies_.structure(), on);
    if (!flexible_.bent()) return;
    flexible_.step(blend(), T_model_body, budget, step_s(), on, !bodies_.active_fixed());
    if (flexible_.moved()) audit_.restart();
    result.load.cost += Monotonic::now() - begin;
}

bool DockingModel::is_pulled() const noexcept {
    return (bodies_.list().options_asked & kDockingPull) != 0 && basins_.count() > 0 && bodies_.in_hand() &&
           basins_.body() == bodies_.active_id();
}

BasinPull::Pull DockingModel::add_pull(const Pose& T_model_body, StepResult& result) const noexcept {
    if (!is_pulled() || !T_model_body.finite()) return {};
    BasinPull::Pull pull =
        basins_.at(T_model_body, parts_->gyration_m[bodies_.structure()], parts_->meta.world_per_model);
    pull.wrench_world.force_n *= pull_scale_;
    pull.wrench_world.torque_n_m *= pull_scale_;
    result.wrench_world.force_n += pull.wrench_world.force_n;
    result.wrench_world.torque_n_m += pull.wrench_world.torque_n_m;
    return pull;
}

bool DockingModel::add_clash(const Pose& T_model_body, StepResult& result) const noexcept {
    const ModelBodies& list = bodies_.list();
    if ((list.options_asked & kDockingClash) == 0 || !bodies_.in_hand() || !T_model_body.finite())
        return false;
    const Instant begin = Monotonic::now();
    std::array<ClashBody, ModelBodies::kMax> others{};
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < list.count; ++i) {
        if (i != list.active)
            others[count++] = {&parts_->clash[list.structure[i]], list.T_model_body[i],
                               moves_along_with_active(list, i)};
    }
    const ClashResult clash = clash_force({&parts_->clash[bodies_.structure()], T_model_body},
                                          {others.data(), count}, parts_->meta.world_per_model, clash_gains_);
    result.wrench_world.force_n += clash.wrench_world.force_n;
    result.wrench_world.torque_n_m += clash.wrench_world.torque_n_m;
    result.load.cost += Monotonic::now() - begin;
    return clash.points > 0;
}

void DockingModel::grip(const Pose& T_world_tool) noexcept {
    glide_.restart();
    if (!bodies_.in_hand()) return;
    const Pose& body = bodies_.list().T_model_body[bodies_.list().active];
    com_from_tool_world_m_ = parts_->meta.to_world(body.p_m) - T_world_tool.p_m;
    q_tool_body_ = (T_world_tool.q.conjugate() * body.q).normalized();
    ++bodies_.list().grips;
}

void DockingModel::reset(const ToolState& tool) noexcept {
    fade_.cut();
    clutched_ = true;  // without a finite pose, the first good step takes the grip
    if (!tool.T_world_tool.finite()) return;
    if ((tool.buttons & 1U) != 0 || bodies_.active_fixed()) return;
    grip(tool.T_world_tool);
    clutched_ = false;
}

StepResult DockingModel::step(const ToolState& tool, const Budget& budget) noexcept {
    if (!is_in_reach(tool.T_world_tool)) {
        fade_.cut();
        clutched_ = true;  // a later step takes a new grip, because the tool may have moved
        StepResult result;
        result.status = StepStatus::out_of_range;
        return result;
    }
    fade_.begin_step(step_s());
    StepResult result = feel(tool, budget);
    result.wrench_world = fade_.show(result.wrench_world);
    return result;
}

StepResult DockingModel::feel(const ToolState& tool, const Budget& budget) noexcept {
    if (!bodies_.in_hand()) {
        flexible_.hold(0, 0, (bodies_.list().options_asked & kDockingFlexible) != 0);
        fade_.rest();
        clutched_ = true;
        bodies_.list().pull_n = 0.0;
        return {};
    }
    const Pose& hand = tool.T_world_tool;
    const bool held = (tool.buttons & 1U) != 0 || bodies_.active_fixed();
    if (clutched_ && !held) grip(hand);
    clutched_ = held;
    if (held) {
        fade_.fall();
    } else {
        fade_.rise();
    }
    Pose& body = bodies_.list().T_model_body[bodies_.list().active];
    if (!held) {
        const Pose before = body;
        body.p_m = parts_->meta.to_model(hand.p_m + com_from_tool_world_m_);
        body.q = (hand.q * q_tool_body_).normalized();
        bodies_.follow(before);
    }
    StepResult clash;  // computed first: only the density can be shortened when time runs out
    at_others_ = add_clash(body, clash);
    const BasinPull::Pull pull = add_pull(body, clash);
    bodies_.list().place = pull.nearest;
    bodies_.list().pull_n = held ? 0.0 : pull.wrench_world.force_n.norm();
    bend(body, budget, clash);
    // A body that bends has no older sums to keep.
    StepResult result = blend().evaluate(body, budget, flexible_.bent() ? nullptr : &kept_);
    audit(result, body);
    stiffness_audit_.step(blend(), budget.fidelity, body, step_s(), bends_scale_[bodies_.structure()]);
    stepped_ = true;
    glide(budget.fidelity, result);
    result.wrench_world.force_n += clash.wrench_world.force_n;
    result.wrench_world.torque_n_m += clash.wrench_world.torque_n_m;
    result.load.cost += clash.load.cost;
    const double gain = fade_.gain();
    result.wrench_world.force_n *= gain;
    result.wrench_world.torque_n_m *= gain;
    return result;
}

// Adds the offset of LevelGlide after a jump; small steps blend two levels and need none.
void DockingModel::glide(float fidelity, StepResult& result) noexcept {
    const bool fell_back = result.load.items != blend().items(fidelity);
    const bool jumped = std::abs(fidelity - level_before_) > kLevelJump || fell_back != fell_back_;
    glide_.apply(jumped, step_s(), result.wrench_world, result.load.error);
    level_before_ = fidelity;
    fell_back_ = fell_back;
}

// A measured error above the bound raises the bound of all levels of this structure permanently. Steps that reused
// earlier sums are skipped: they do not measure their level and have no time to spare.
void DockingModel::audit(const StepResult& result, const Pose& T_model_body) noexcept {
    if (result.status != StepStatus::ok || result.load.recomputed_fraction < 1.0F || flexible_.moved())
        return;
    double& scale = error_scale_[bodies_.structure()];
    const double per_newton = 1.0 / std::max(newtons_per_gradient(), 1e-300);
    if (!audit_.step(force_map_->maps.front(), blend().levels.back(), T_model_body,
                     per_newton * result.wrench_world.force_n, per_newton * result.load.error / scale,
                     result.load.items))
        return;
    if (audit_.bound() > 0.0) scale = std::max(scale, kErrorMargin * audit_.off() / audit_.bound());
}

}  // namespace tact
