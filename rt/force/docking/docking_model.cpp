// Derivation. A body has points x_i = c + q b_i with weights w_i, sum w_i = 1, b_i from its centre of mass,
// so c is that centre. With U = -k_E sum w_i rho(x_i), a displacement dc and a small rotation dphi (model
//     axes) give dU = -k_E sum w_i grad rho(x_i) . (dc + dphi x (x_i - c))
//        = -k_E [ (sum w_i grad rho) . dc + (sum w_i (x_i - c) x grad rho) . dphi ].
// The seed prints the torque as w_i x grad rho; the lever arm is from the centre of mass, as here. World axes
// are parallel to model axes and dx_world = S dx_model (S = world_per_model), so what the hand feels is
//     F_world = (k_E / S) sum w_i grad rho,    Q_world = k_E sum w_i (x_i - c) x grad rho,
// which is the derivative of the same U by the tool's place and rotation: whatever path the hand takes, no
// energy is gained. As the weights sum to one, neither depends on how many points stand for the body.
//
// The grip keeps the vector from tool to centre of mass fixed in world axes and the rotation from tool to
// body fixed in tool axes. Then dc_world = dp_tool and dphi = the tool's rotation, so the wrench above, about
// the centre of mass, is exactly the wrench at the tool's origin; a grip with a lever would have to transfer
// the torque.
//
// Between two levels the wrenches are blended linearly. A blend is the derivative of the blended energies:
// still conservative while the knob stands still, and continuous when it turns.
//
// After a change of what is in the hand, the last wrench shrinks by 0.04 N and 0.002 N m a step, whatever
// happens meanwhile: orders in quick succession do not hold it up. 3.3 N are gone after 83 steps; at 1 kHz
// that is a twelfth of what the slew limit allows. It is a constant force, as that of a body that stays where
// it was let go.
#include "rt/force/docking/docking_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <typeinfo>
#include <utility>

#include "ipc/base/error.hpp"
#include "rt/force/docking/start_pose.hpp"

namespace tact {

namespace {

// Points between two looks at the clock: some 25 us here.
constexpr std::size_t kChunk = 2048;
// Where the level asked for is bigger, one of at most 1/kSafeShare of it is summed first, to fall back on.
constexpr std::size_t kSafeShare = 16;
constexpr double kToolRangeM = 10.0;  // a hand, and a body, is never farther from the scene's centre
constexpr double kLeavingN = 0.04, kLeavingNM = 0.002;  // a step
constexpr double kLeavingShare = 0.005;                 // and of what is far beyond any device
constexpr double kErrorMargin = 1.25;
constexpr double kOnLevel = 1e-5;  // of the way to the next level

double checked_gain(const SceneMeta& meta, const DockingSettings& settings) {
    const std::array<double, 3> given{settings.force_scale, settings.start_offset_m,
                                      settings.start_rotation_rad};
    for (const double v : given) {
        if (!std::isfinite(v)) {
            throw StartupError("setting up docking", "a start offset, rotation or force scale is not finite",
                               "give finite numbers");
        }
    }
    if (settings.force_scale < 0.0 || settings.force_scale > 100.0) {
        throw StartupError("setting up docking", "the force scale is not in [0, 100]",
                           "use 1, or a bit less");
    }
    return meta.energy_j_per_sigma * settings.force_scale;
}

bool is_pose(const Pose& pose) {
    const double turn = pose.q.norm();
    return pose.finite() && turn > 0.9 && turn < 1.1;
}

// Within a hand's reach of the scene's centre.
bool is_placeable(const SceneMeta& meta, const Pose& T_model_body) {
    return is_pose(T_model_body) && meta.to_world(T_model_body.p_m).norm() <= kToolRangeM;
}

std::vector<StartBody> start_bodies(const DockingParts& parts, const DockingSettings& settings) {
    std::vector<StartBody> start = settings.bodies;
    if (start.empty()) {
        for (std::uint32_t s = 0; s < parts.structures.size(); ++s)
            start.push_back({.structure = s, .T_model_body = parts.structures[s].home()});
        start[0].T_model_body = start_pose(start[0].T_model_body, settings.start_offset_m,
                                           settings.start_rotation_rad, settings.seed);
    }
    start.insert(start.end(), settings.more_bodies.begin(), settings.more_bodies.end());
    if (start.size() > ModelBodies::kMax)
        throw StartupError("setting up docking", "there are " + std::to_string(start.size()) + " bodies",
                           "start with at most " + std::to_string(ModelBodies::kMax));
    for (const StartBody& body : start) {
        if (body.structure >= parts.structures.size() || !is_placeable(parts.meta, body.T_model_body))
            throw StartupError("setting up docking",
                               "a body is of no structure of the scene, or too far from its map",
                               "give places of this scene");
    }
    return start;
}

StepResult out_of_range() {
    StepResult result;
    result.status = StepStatus::out_of_range;
    return result;
}

// 3 s^2 - 2 s^3: the force enters and leaves without a kink.
double ramp_gain(int ramp) {
    const double s = static_cast<double>(ramp) / DockingModel::kRampSteps;
    return s * s * (3.0 - 2.0 * s);
}

Vec3 less(const Vec3& v, double step) {
    const double size = v.norm(), left = size - std::max(step, kLeavingShare * size);
    return left > 0.0 ? Vec3(left / size * v) : Vec3::Zero();
}

bool gone(const Wrench& w) { return w.force_n.isZero(0.0) && w.torque_n_m.isZero(0.0); }

}  // namespace

DockingModel::DockingModel(const SceneMeta& meta, const DensityGrid& grid,
                           const std::vector<Structure>& structures, const std::vector<Codebook>& codebooks,
                           const DockingSettings& settings)
    : parts_(make_docking_parts(meta, grid, structures, codebooks)),
      energy_j_per_sigma_(checked_gain(meta, settings)),
      whole_(make_felt_density(*parts_, newtons_per_gradient(), 0, {})),
      built_(whole_),
      felt_(whole_.get()),
      bodies_(start_bodies(*parts_, settings), static_cast<std::uint32_t>(parts_->structures.size())) {
    clash_gains_ = parts_->clash_gains;
    clash_gains_.force_n *= settings.force_scale;
    clash_gains_.stiffness_n_m *= settings.force_scale;
    error_scale_.fill(1.0);
}

DockingModel::DockingModel(const DockingModel& like, const ModelBodies& bodies)
    : parts_(like.parts_),
      energy_j_per_sigma_(like.energy_j_per_sigma_),
      clash_gains_(like.clash_gains_),
      bodies_({}, static_cast<std::uint32_t>(parts_->structures.size())) {
    const std::uint32_t asked = bodies.options_asked & kFeltOptions;
    const std::uint32_t asked_whole = asked & ~kOptionSubtraction;
    whole_ = like.whole_->options == asked_whole
                 ? like.whole_
                 : make_felt_density(*parts_, newtons_per_gradient(), asked_whole, bodies);
    built_ =
        asked == asked_whole ? whole_ : make_felt_density(*parts_, newtons_per_gradient(), asked, bodies);
    felt_ = built_.get();
    bodies_.list() = bodies;
    error_scale_.fill(1.0);
}

KnobSpec DockingModel::knob() const noexcept {
    KnobSpec spec;
    spec.path = kKnobPath;
    spec.floor = 0.0F;
    // The first level of 200 vectors or more, as in the seed.
    std::size_t start = 0;
    while (start + 1 < levels().size() && levels()[start].size() < 200) ++start;
    spec.start =
        levels().size() > 1 ? static_cast<float>(start) / static_cast<float>(levels().size() - 1) : 1.0F;
    spec.slew_per_s = 4.0F;
    spec.haptic = true;
    return spec;
}

DockingModel::Plan DockingModel::plan(float fidelity) const noexcept {
    const double f = fidelity > 0.0F ? std::min(static_cast<double>(fidelity), 1.0) : 0.0;
    const std::size_t last = levels().size() - 1;
    double place = f * static_cast<double>(last);
    // A level's own fidelity is seldom a float; a hair above it the next level would be summed for nothing.
    if (std::abs(place - std::round(place)) < kOnLevel) place = std::round(place);
    const auto lower = std::min(static_cast<std::size_t>(place), last);
    const double blend = place - static_cast<double>(lower);
    return {lower, blend > 0.0 ? lower + 1 : lower, blend};
}

std::uint32_t DockingModel::items(float fidelity) const noexcept {
    if (!bodies_.in_hand()) return 0;
    return static_cast<std::uint32_t>(levels()[plan(fidelity).upper].size());
}

double DockingModel::error_n(std::size_t level) const noexcept {
    return error_scale_[bodies_.structure()] * figures()[level].error_n;
}

PathLoad DockingModel::predict(float fidelity) const noexcept {
    PathLoad load;
    if (!bodies_.in_hand()) return load;
    const Plan p = plan(fidelity);
    load.cost_predicted =
        figures()[p.lower].cost + (p.upper != p.lower ? figures()[p.upper].cost : Duration{0});
    load.error = (1.0 - p.blend) * error_n(p.lower) + p.blend * error_n(p.upper);
    load.items = static_cast<std::uint32_t>(levels()[p.upper].size());
    return load;
}

bool DockingModel::sum_level(const PointSet& points, const Pose& T_model_body, Instant deadline,
                             DensitySums& sums) const noexcept {
    sums = DensitySums{};
    const std::size_t n = points.size();
    for (std::size_t begin = 0; begin < n; begin += kChunk) {
        if (n > DockingParts::kAlways && deadline != Instant::max() && Monotonic::now() >= deadline)
            return false;
        const DensitySums part =
            felt_->map.sum(points.view(begin, std::min(kChunk, n - begin)), T_model_body);
        sums.density_sigma += part.density_sigma;
        sums.gradient += part.gradient;
        sums.moment += part.moment;
    }
    return true;
}

Wrench DockingModel::wrench(const DensitySums& sums) const noexcept {
    return {newtons_per_gradient() * sums.gradient, energy_j_per_sigma_ * sums.moment};
}

StepResult DockingModel::evaluate(const Pose& T_model_body, const Budget& budget) const noexcept {
    StepResult result = evaluate_density(T_model_body, budget);
    add_clash(T_model_body, result);
    return result;
}

void DockingModel::add_clash(const Pose& T_model_body, StepResult& result) const noexcept {
    const ModelBodies& list = bodies_.list();
    if ((list.options_asked & kOptionClash) == 0 || !bodies_.in_hand() || !T_model_body.finite()) return;
    const Instant begin = Monotonic::now();
    std::array<ClashBody, ModelBodies::kMax> others{};
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < list.count; ++i) {
        if (i != list.active) others[count++] = {&parts_->clash[list.structure[i]], list.T_model_body[i]};
    }
    const ClashResult clash = clash_force({&parts_->clash[bodies_.structure()], T_model_body},
                                          {others.data(), count}, parts_->meta.world_per_model, clash_gains_);
    result.wrench_world.force_n += clash.wrench_world.force_n;
    result.wrench_world.torque_n_m += clash.wrench_world.torque_n_m;
    result.load.cost += Monotonic::now() - begin;
}

StepResult DockingModel::evaluate_density(const Pose& T_model_body, const Budget& budget) const noexcept {
    const Instant begin = Monotonic::now();
    if (!T_model_body.finite()) return out_of_range();
    StepResult result;
    if (!bodies_.in_hand()) return result;
    result.load = predict(budget.fidelity);
    const Plan p = plan(budget.fidelity);
    const auto use = [&](std::size_t level, const DensitySums& sums) {
        result.wrench_world = wrench(sums);
        result.load.error = error_n(level);
        result.load.items = static_cast<std::uint32_t>(levels()[level].size());
    };
    DensitySums lower, upper;
    const std::size_t wanted = levels()[p.lower].size();
    if (wanted > DockingParts::kAlways) {  // something to fall back on, small beside the whole
        std::size_t safe = 0;
        while (levels()[safe + 1].size() <= std::min(DockingParts::kAlways, wanted / kSafeShare)) ++safe;
        if (sum_level(levels()[safe], T_model_body, Instant::max(), lower)) use(safe, lower);
    }
    if (!sum_level(levels()[p.lower], T_model_body, budget.deadline, lower)) {
        result.status = StepStatus::out_of_time;
    } else {
        use(p.lower, lower);
        if (p.upper != p.lower) {
            const bool late = budget.deadline != Instant::max() && Monotonic::now() >= budget.deadline;
            if (late || !sum_level(levels()[p.upper], T_model_body, budget.deadline, upper)) {
                result.status = StepStatus::out_of_time;
            } else {
                const Wrench a = wrench(lower), b = wrench(upper);
                result.wrench_world.force_n = (1.0 - p.blend) * a.force_n + p.blend * b.force_n;
                result.wrench_world.torque_n_m = (1.0 - p.blend) * a.torque_n_m + p.blend * b.torque_n_m;
                const PathLoad promised = predict(budget.fidelity);
                result.load.error = promised.error;
                result.load.items = promised.items;
            }
        } else if (budget.deadline != Instant::max() && Monotonic::now() >= budget.deadline) {
            result.status = StepStatus::out_of_time;  // complete, but too late
        }
    }
    result.load.cost = Monotonic::now() - begin;
    return result;
}

void DockingModel::grip(const Pose& T_world_tool) noexcept {
    if (!bodies_.in_hand()) return;
    const Pose& body = bodies_.list().T_model_body[bodies_.list().active];
    com_from_tool_world_m_ = parts_->meta.to_world(body.p_m) - T_world_tool.p_m;
    q_tool_body_ = (T_world_tool.q.conjugate() * body.q).normalized();
    ++bodies_.list().grips;
}

void DockingModel::reset(const ToolState& tool) noexcept {
    ramp_ = 0;
    shown_ = leaving_ = {};
    clutched_ = true;  // a tool that is nowhere yet is gripped at the first good step
    if (!tool.T_world_tool.finite()) return;
    if ((tool.buttons & 1U) != 0 || bodies_.active_fixed()) return;
    grip(tool.T_world_tool);
    clutched_ = false;
}

StepResult DockingModel::step(const ToolState& tool, const Budget& budget) noexcept {
    const Pose& hand = tool.T_world_tool;
    if (!is_pose(hand) || hand.p_m.norm() > kToolRangeM) {
        ramp_ = 0;  // what follows is a new grip: the tool may be anywhere by then
        clutched_ = true;
        shown_ = leaving_ = {};
        return out_of_range();
    }
    leaving_ = {less(leaving_.force_n, kLeavingN), less(leaving_.torque_n_m, kLeavingNM)};
    StepResult result = feel(tool, budget);
    result.wrench_world.force_n += leaving_.force_n;
    result.wrench_world.torque_n_m += leaving_.torque_n_m;
    shown_ = result.wrench_world;
    return result;
}

StepResult DockingModel::feel(const ToolState& tool, const Budget& budget) noexcept {
    if (!bodies_.in_hand()) {
        ramp_ = 0;
        clutched_ = true;
        return {};
    }
    const Pose& hand = tool.T_world_tool;
    const bool held = (tool.buttons & 1U) != 0 || bodies_.active_fixed();
    if (clutched_ && !held) grip(hand);
    clutched_ = held;
    if (held) {
        ramp_ = std::max(ramp_ - 1, 0);
    } else if (gone(leaving_)) {
        ramp_ = std::min(ramp_ + 1, kRampSteps);
    }
    Pose& body = bodies_.list().T_model_body[bodies_.list().active];
    if (!held) {
        body.p_m = parts_->meta.to_model(hand.p_m + com_from_tool_world_m_);
        body.q = (hand.q * q_tool_body_).normalized();
    }
    StepResult clash;  // first: where time runs out, only the density can do with less
    add_clash(body, clash);
    StepResult result = evaluate_density(body, budget);
    audit(result, body);
    result.wrench_world.force_n += clash.wrench_world.force_n;
    result.wrench_world.torque_n_m += clash.wrench_world.torque_n_m;
    result.load.cost += clash.load.cost;
    const double gain = ramp_gain(ramp_);
    result.wrench_world.force_n *= gain;
    result.wrench_world.torque_n_m *= gain;
    return result;
}

// A measurement above the bound raises the bound of all levels of this structure, for good.
void DockingModel::audit(const StepResult& result, const Pose& T_model_body) noexcept {
    if (result.status != StepStatus::ok) return;
    double& scale = error_scale_[bodies_.structure()];
    const double per_newton = 1.0 / std::max(newtons_per_gradient(), 1e-300);
    if (!audit_.step(felt_->map, levels().back(), T_model_body, per_newton * result.wrench_world.force_n,
                     per_newton * result.load.error / scale, result.load.items))
        return;
    if (audit_.bound() > 0.0) scale = std::max(scale, kErrorMargin * audit_.off() / audit_.bound());
}

// What is shown fades from here, and what is felt instead fades in after it.
void DockingModel::fade(const Wrench& shown) noexcept {
    leaving_ = shown;
    ramp_ = 0;
    audit_.restart();
}

// The same, and what is in the hand now is gripped at the next good step.
void DockingModel::let_go(const Wrench& shown) noexcept {
    fade(shown);
    clutched_ = true;
}

// The density that is as ordered, where there is one. A body must never feel a density that lacks the body
// itself, and does so where another one was in the hand when it was made. True: another one than before.
bool DockingModel::choose_density() noexcept {
    const FeltDensity* const before = felt_;
    const std::uint32_t asked = bodies_.list().options_asked & kFeltOptions;
    const bool fits = (built_->options & kOptionSubtraction) == 0 || built_->active_id == bodies_.active_id();
    if (fits && built_->options == asked) {
        felt_ = built_.get();
    } else if (!fits || whole_->options == asked) {
        felt_ = whole_.get();
    }
    show_options();
    return felt_ != before;
}

void DockingModel::show_options() noexcept {
    bodies_.list().options = felt_->options | (bodies_.list().options_asked & kOptionClash);
}

bool DockingModel::order(const ModelOrder& order) noexcept {
    if (order.kind == ModelOrder::Kind::option) {
        if ((order.option & ~(kFeltOptions | kOptionClash)) != 0 || order.option == 0) return false;
        std::uint32_t& asked = bodies_.list().options_asked;
        const std::uint32_t before = asked;
        asked = order.on ? asked | order.option : asked & ~order.option;
        const bool another = choose_density();
        if (another || ((before ^ asked) & kOptionClash) != 0) fade(shown_);
        return true;
    }
    ModelOrder checked = order;
    if (order.kind == ModelOrder::Kind::place || order.kind == ModelOrder::Kind::add) {
        if (!is_placeable(parts_->meta, order.T_model_body)) return false;
        checked.T_model_body.q.normalize();
    }
    switch (bodies_.order(checked)) {
        case DockingBodies::Change::refused:
            return false;
        case DockingBodies::Change::moved:
            let_go(shown_);
            break;
        case DockingBodies::Change::taken:
            let_go(shown_);
            static_cast<void>(choose_density());
            break;
        case DockingBodies::Change::others:
            if ((bodies_.list().options & kOptionClash) != 0) fade(shown_);
            break;
        case DockingBodies::Change::none:
            break;
    }
    return true;
}

bool DockingModel::stale() const noexcept {
    if (!bodies_.in_hand()) return false;
    const std::uint32_t asked = bodies_.list().options_asked & kFeltOptions;
    if (asked != felt_->options) return true;
    return (asked & kOptionSubtraction) != 0 && felt_->others != bodies_.list().others;
}

std::unique_ptr<ForceModel> DockingModel::rebuild(const ModelBodies& bodies) const {
    return std::unique_ptr<ForceModel>(new DockingModel(*this, bodies));
}

bool DockingModel::adopt(const ForceModel& old) noexcept {
    if (typeid(old) != typeid(*this)) return false;
    const auto& before = static_cast<const DockingModel&>(old);
    if (before.parts_ != parts_) return false;
    bodies_ = before.bodies_;
    com_from_tool_world_m_ = before.com_from_tool_world_m_;
    q_tool_body_ = before.q_tool_body_;
    clutched_ = before.clutched_;  // the same gesture goes on
    error_scale_ = before.error_scale_;
    fade(before.shown_);
    static_cast<void>(choose_density());
    return true;
}

void DockingModel::give_up() noexcept {
    // What is felt goes on, unless it was made for another body in the hand or for other neighbours.
    const bool stays = (felt_->options & kOptionSubtraction) == 0 ||
                       (felt_->active_id == bodies_.active_id() && felt_->others == bodies_.list().others);
    const std::uint32_t felt = stays ? felt_->options : whole_->options;
    bodies_.list().options_asked = felt | (bodies_.list().options_asked & kOptionClash);
    if (choose_density()) fade(shown_);
}

}  // namespace tact
