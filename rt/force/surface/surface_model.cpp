#include "rt/force/surface/surface_model.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "ipc/base/error.hpp"

namespace tact {
namespace {

// Of a proxy that lags in several steps, in depths of one that does not: seen in the contract's cases.
constexpr double kLagDepths = 2.0;
constexpr double kFarM = 1e3;  // positions farther away are invalid
// ns, 2026-11-25, AVX-512 at 3.7 GHz.
constexpr double kTouchStepNs = 200.0, kTouchMoveNs = 250.0, kTouchTriangleNs = 4.0;

bool tool_is_there(const Pose& pose) noexcept {
    const double turn = pose.q.squaredNorm();
    return pose.finite() && pose.p_m.cwiseAbs().maxCoeff() < kFarM && turn > 0.25 && turn < 4.0;
}

ContactSettings contact_settings(const SceneMeta& meta, const SurfaceSettings& s) {
    check_surface_settings(s);
    const double radius = std::max(s.radius_m, SurfaceModel::kPointM);
    // Half the radius of a point, a thousandth of that of a ball: a few millinewtons at the end of a facet.
    const double margin = std::min(0.5 * radius, std::max(1e-3 * radius, 0.5 * SurfaceModel::kPointM));
    const double lag = SurfaceModel::kLagN / s.stiffness_n_m;
    return {radius / meta.world_per_model, margin / meta.world_per_model, s.friction,
            lag / meta.world_per_model, s.mode == SurfaceMode::off_brute};
}

}  // namespace

void check_surface_settings(const SurfaceSettings& s) {
    const auto within = [](const char* what, double value, double low, double high) {
        if (!(value >= low && value <= high))
            throw StartupError(
                std::string("setting the ") + what + " of the tool",
                std::to_string(value) + " is outside " + std::to_string(low) + " to " + std::to_string(high),
                "choose a value inside the range");
    };
    within("radius in m", s.radius_m, 0.0, 0.1);
    within("stiffness in N/m", s.stiffness_n_m, 1.0, 20000.0);
    within("damping in N s/m", s.damping_n_s_m, 0.0, 10.0);
    within("friction", s.friction, 0.0, 2.0);
    if (s.dynamic_friction) within("dynamic friction", *s.dynamic_friction, 0.0, s.friction);
    within("force limit in N", s.force_n_max, 0.1, 100.0);
}

SurfaceModel::SurfaceModel(const SceneMeta& meta, const SurfaceMesh& mesh, const SurfaceSettings& settings,
                           const VertexForest* forest)
    : meta_(meta),
      settings_(settings),
      solver_(mesh, contact_settings(meta, settings)),
      force_({settings.stiffness_n_m, settings.damping_n_s_m, kDampedDepthM, settings.friction,
              settings.force_n_max, kLagN / settings.stiffness_n_m}),
      stick_slip_(settings.friction, settings.dynamic_friction.value_or(settings.friction)),
      full_(mesh) {
    if (settings.mode == SurfaceMode::off_brute) regime_ = TouchRegime::brute;
    if (settings.mode == SurfaceMode::chr)
        adaptive_ = tended_surface(mesh, forest, solver_.settings().radius_m, meta.world_per_model);
}

void SurfaceModel::slow_update(const ToolState& predicted, const Budget&) noexcept {
    if (adaptive_ != nullptr)
        adaptive_->slow_update(predicted.twist_world.linear_m_s / meta_.world_per_model);
}

void SurfaceModel::use_full_surface() noexcept {
    if (used_ == 0) return;
    solver_.use(full_);
    used_ = 0;
}

// Before a step: selects the surface that contains the step's search radius.
void SurfaceModel::choose_surface(const Vec3& goal_m, float fidelity) noexcept {
    if (adaptive_ == nullptr) return;
    if (adaptive_->around(solver_.proxy_m(), solver_.looks_m(goal_m))) {
        const NearSurface& near = adaptive_->near();
        if (used_ != near.version()) solver_.use(near.mesh());
        used_ = near.version();
        regime_ = TouchRegime::adaptive;
    } else {
        use_full_surface();
        regime_ = TouchRegime::tree;
    }
    adaptive_->is_at(solver_.proxy_m(), fidelity);
}

KnobSpec SurfaceModel::knob() const noexcept {
    return {.path = kKnobPath, .floor = kLeastLevel, .start = 0.5F, .slew_per_s = 4.0F, .haptic = true};
}

std::uint32_t SurfaceModel::items(float fidelity) const noexcept {
    return adaptive_ == nullptr
               ? static_cast<std::uint32_t>(std::lround(lag_.mean_moves(moves(fidelity))))
               : static_cast<std::uint32_t>(adaptive_->surface().predicted_triangles(fidelity));
}

PathLoad SurfaceModel::predict(float fidelity) const noexcept {
    const std::uint32_t most = moves(fidelity);
    PathLoad load;
    load.items = items(fidelity);
    load.cost_predicted = Duration(std::llround(
        kTouchStepNs + lag_.moves(most) * (kTouchMoveNs + kTouchTriangleNs * lag_.triangles_per_move())));
    const double newton = settings_.stiffness_n_m * meta_.world_per_model;
    load.error = 2.0 * newton * solver_.settings().margin_m +
                 2.0 * lag_.lagged(most) * std::min(kLagDepths * newton * depth_m_, settings_.force_n_max);
    return load;
}

std::uint32_t SurfaceModel::moves(float fidelity) noexcept {
    const float level = fidelity >= 0.0F ? std::min(fidelity, 1.0F) : 0.0F;  // NaN: the floor
    return kMovesLeast +
           static_cast<std::uint32_t>(std::lround(level * static_cast<float>(kMovesMost - kMovesLeast)));
}

void SurfaceModel::reset(const ToolState& tool) noexcept {
    asked_ = true;
    lagged_ = false;
    fade_.cut();
    contact_ = {};
    force_.reset();
    stick_slip_.reset();
    ++grips_;
    seated_ = tool_is_there(tool.T_world_tool);
    use_full_surface();
    if (seated_) solver_.seat(meta_.to_model(tool.T_world_tool.p_m));
}

ModelBodies SurfaceModel::bodies() const noexcept {
    ModelBodies list;
    list.count = 1;
    list.T_model_body[0].p_m = solver_.proxy_m();
    list.id[0] = 1;
    list.grips = grips_;
    return list;
}

SurfaceTouch SurfaceModel::touch() const noexcept {
    SurfaceTouch t;
    t.probe_m = solver_.goal_m();
    t.proxy_m = solver_.proxy_m();
    t.radius_m = settings_.radius_m > 0.0 ? solver_.settings().radius_m : 0.0;
    t.state = static_cast<TouchState>(contact_.state);
    t.regime = regime_;
    if (adaptive_ != nullptr) t.detail = adaptive_->detail();
    t.planes = contact_.planes;
    for (std::uint32_t i = 0; i < t.planes; ++i) {
        t.normal[i] = contact_.plane[i].normal;
        t.push_n[i] = settings_.stiffness_n_m * meta_.world_per_model * contact_.plane[i].weight_m;
    }
    return t;
}

void SurfaceModel::publish(const ModelCycle& cycle) noexcept {
    if (topic_ != nullptr) topic_->publish(touch_topic(touch(), cycle));
}

Vec3 SurfaceModel::force_n(const ToolState& tool, const Vec3& moved_model_m) noexcept {
    const double scale = meta_.world_per_model;
    Vec3 turn_m = Vec3::Zero();
    for (std::uint32_t i = 0; settings_.shading && i < contact_.planes; ++i) {
        const ContactPlane& plane = contact_.plane[i];
        turn_m += i == 0 ? shaded_.turn_m(solver_.mesh(), plane.triangle, contact_.proxy_m, plane.normal,
                                          plane.weight_m)
                         : shaded_turn_m(solver_.mesh(), plane.triangle, contact_.proxy_m, plane.normal,
                                         plane.weight_m);
    }
    return force_.step({.lift_m = scale * contact_.lift_m,
                        .turn_m = scale * turn_m,
                        .rub_m = scale * contact_.rub_m,
                        .moved_m = scale * moved_model_m,
                        .velocity_m_s = tool.twist_world.linear_m_s,
                        .gain = fade_.gain()});
}

// After a lag, friction and hollows may hold the proxy elsewhere than without it, for as long as it touches: on a sphere,
// differences of a third of the bound were seen 167 steps later. A proxy without contact is where it would be anyway.
void SurfaceModel::note_lag() noexcept {
    if (contact_.state == ContactState::lagging)
        lagged_ = true;
    else if (contact_.planes == 0 && contact_.state == ContactState::settled)
        lagged_ = false;
}

StepResult SurfaceModel::step(const ToolState& tool, const Budget& budget) noexcept {
    const Instant begin = Monotonic::now();
    StepResult result;
    result.load = predict(budget.fidelity);
    result.load.error = 0.0;
    fade_.begin_step(step_s());
    const bool valid = tool_is_there(tool.T_world_tool);
    const bool clutch = (tool.buttons & 1U) != 0;
    if (!valid) {
        fade_.cut();
        contact_ = {};
        seated_ = false;
        result.status = StepStatus::out_of_range;
    } else if (asked_) {
        const Vec3 goal_m = meta_.to_model(tool.T_world_tool.p_m);
        if (clutch && fade_.gain() <= 0.0) seated_ = false;
        if (!seated_ && !clutch) {
            use_full_surface();
            solver_.seat(goal_m);
            seated_ = true;
            force_.reset();
            stick_slip_.reset();
            ++grips_;
        }
        if (seated_) {
            if (clutch)
                fade_.fall();
            else
                fade_.rise();
            choose_surface(goal_m, budget.fidelity);
            const bool hurried = budget.deadline.passed();
            const Vec3 moved_m = goal_m - solver_.goal_m();
            solver_.set_friction(stick_slip_.coefficient());
            contact_ = solver_.follow(goal_m, hurried ? 1 : moves(budget.fidelity), budget.deadline);
            const bool on_time = !hurried && !contact_.late;
            const double planned = lag_.moves(moves(budget.fidelity));
            if (on_time)
                lag_.add(contact_, solver_.settings().margin_m);
            else
                result.load.work_done = static_cast<float>(std::min(contact_.moves / planned, 1.0));
            if (adaptive_ == nullptr) result.load.items = contact_.moves;
            if (on_time && contact_.state == ContactState::lagging) ++lagging_;
            if (!on_time || contact_.state == ContactState::lagging) result.status = StepStatus::out_of_time;
            const double newton = settings_.stiffness_n_m * meta_.world_per_model;
            depth_m_ = (contact_.proxy_m - goal_m).norm();
            const double pulled_n = newton * depth_m_;
            note_lag();
            if (contact_.planes > 0)
                stick_slip_.add(contact_.lift_m.norm(), contact_.rub_m.norm(), solver_.moved(), step_s());
            else
                stick_slip_.reset();
            result.wrench_world = fade_.show({force_n(tool, moved_m), Vec3::Zero()});
            result.load.error = 2.0 * newton * solver_.settings().margin_m + force_.off_n();
            if (lagged_ || contact_.state != ContactState::settled)
                result.load.error += 2.0 * std::min(pulled_n, settings_.force_n_max);
            if (pulled_n > kLostLimits * settings_.force_n_max) {
                fade_.follow(fade_);
                use_full_surface();
                solver_.seat(goal_m);
                force_.reset();
                stick_slip_.reset();
                ++grips_;
                ++released_;
            }
        } else {
            contact_ = {};
            fade_.rest();
        }
    }
    result.load.cost = std::max(Monotonic::now() - begin, Duration(1));
    return result;
}

std::unique_ptr<SurfaceModel> load_surface_model(const SceneFile& scene, const SurfaceSettings& settings) {
    const SceneMeta meta = read_meta(scene);
    if (scene.count(SurfaceMesh::kTag) == 0)
        throw StartupError("loading '" + scene.name() + "'", "the scene is not a surface",
                           "bake one with tact-prep touch MESH -o SCENE");
    const SurfaceMesh mesh = read_surface(scene);
    if (settings.mode != SurfaceMode::chr || scene.count({'F', 'R', 'S', 'T'}) == 0)
        return std::make_unique<SurfaceModel>(meta, mesh, settings);
    const VertexForest forest = read_forest(scene, mesh.all_positions_m(), mesh.all_corners());
    return std::make_unique<SurfaceModel>(meta, mesh, settings, &forest);
}

}  // namespace tact
