#include "rt/force/surface/tool_model.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/error.hpp"

namespace tact {
namespace {

constexpr double kFarHandM = 1e3;
constexpr double kBallMargin = 0.05;  // fraction of the ball's radius
// Moves of a step that uses up its queries, where none was tried.
constexpr double kMovesUsual = 4.0, kQueriesPerMove = 25.0;

float level_of(float fidelity) {
    return fidelity >= 0.0F ? std::min(fidelity, 1.0F) : 0.0F;  // NaN: the floor
}

// Part of all points, and of the queries above the least.
float point_part(float fidelity) { return std::min(level_of(fidelity) / ToolModel::kAllPointsAt, 1.0F); }
float query_part(float fidelity) {
    return std::max(level_of(fidelity) - ToolModel::kAllPointsAt, 0.0F) / (1.0F - ToolModel::kAllPointsAt);
}

bool holds_tool(const Pose& pose) noexcept {
    const double turn = pose.q.squaredNorm();
    return pose.finite() && pose.p_m.cwiseAbs().maxCoeff() < kFarHandM && turn > 0.25 && turn < 4.0;
}

ToolContactSettings tool_contact_settings(const SceneMeta& meta, const TouchTool& tool,
                                          const SurfaceSettings& s) {
    check_surface_settings(s);
    const double ball = s.radius_m > 0.0 ? s.radius_m / meta.world_per_model : tool.ball_m;
    const double lag = SurfaceModel::kLagN / s.stiffness_n_m;
    return {ball, kBallMargin * ball, s.friction, lag / meta.world_per_model,
            s.mode == SurfaceMode::off_brute};
}

}  // namespace

ToolModel::ToolModel(const SceneMeta& meta, const SurfaceMesh& mesh, const TouchTool& tool,
                     const SurfaceSettings& settings, const VertexForest* forest)
    : meta_(meta),
      settings_(settings),
      solver_(mesh, tool, tool_contact_settings(meta, tool, settings)),
      force_({.stiffness_n_m = settings.stiffness_n_m,
              .damping_n_s_m = settings.damping_n_s_m,
              .damped_depth_m = kDampedDepthM,
              .friction = 0.0,  // the proxy has it
              .force_n_max = settings.force_n_max,
              .lag_m = SurfaceModel::kLagN / settings.stiffness_n_m}),
      stick_slip_(settings.friction, settings.dynamic_friction.value_or(settings.friction)),
      gyration_world_m_(solver_.points().gyration_m() * meta.world_per_model),
      torque_n_m_rad_(settings.stiffness_n_m * gyration_world_m_ * gyration_world_m_) {
    if (settings.mode == SurfaceMode::off_brute) regime_ = TouchRegime::brute;
    if (settings.mode == SurfaceMode::chr)
        adaptive_ = tended_surface(mesh, forest, solver_.points().reach_m(), meta.world_per_model);
}

void ToolModel::slow_update(const ToolState& predicted, const Budget&) noexcept {
    if (adaptive_ != nullptr)
        adaptive_->slow_update(predicted.twist_world.linear_m_s / meta_.world_per_model);
}

// Before a step: returns the near surface if it contains the whole tool in any orientation, else null.
const NearSurface* ToolModel::choose_surface(float fidelity) noexcept {
    if (adaptive_ == nullptr) return nullptr;
    const Vec3& proxy_m = solver_.proxy().p_m;
    const bool around = adaptive_->around(proxy_m, solver_.points().reach_m());
    adaptive_->is_at(proxy_m, fidelity);
    return around ? &adaptive_->near() : nullptr;
}

KnobSpec ToolModel::knob() const noexcept {
    return {.path = SurfaceModel::kKnobPath,
            .floor = SurfaceModel::kLeastLevel,
            .start = 0.5F,
            .slew_per_s = 4.0F,
            .haptic = true};
}

std::uint32_t ToolModel::items(float fidelity) const noexcept {
    const std::uint32_t all = solver_.points().size(), least = std::min(all, std::max(kPointsLeast, all / 8));
    return least +
           static_cast<std::uint32_t>(std::lround(point_part(fidelity) * static_cast<float>(all - least)));
}

std::uint32_t ToolModel::queries(float fidelity) noexcept {
    constexpr std::uint32_t most = ToolContact::kQueriesMost;
    return kQueriesLeast + static_cast<std::uint32_t>(
                               std::lround(query_part(fidelity) * static_cast<float>(most - kQueriesLeast)));
}

double ToolModel::error_n(std::uint32_t points) const noexcept {
    return settings_.stiffness_n_m * meta_.world_per_model *
           (solver_.points().cover_m(points) + 2.0 * solver_.settings().margin_m);
}

PathLoad ToolModel::predict(float fidelity) const noexcept {
    const std::uint32_t most = queries(fidelity);
    PathLoad load;
    load.items = items(fidelity);
    if (rehearsal_.tried()) {
        load.cost_predicted = rehearsal_.cost(level_of(fidelity));
    } else {
        const double moves = kMovesUsual + most / kQueriesPerMove;
        load.cost_predicted = Duration(std::llround(1e3 * tool_work_us(moves, load.items, most, 0.0)));
    }
    load.error =
        error_n(load.items) + 2.0 * record_.lagged(most) * std::min(record_.pull_n(), settings_.force_n_max);
    return load;
}

void ToolModel::reset(const ToolState& tool) noexcept {
    asked_ = true;
    fade_.cut();
    touch_ = {};
    ++grips_;
    const bool valid = holds_tool(tool.T_world_tool);
    // Keep a valid proxy: it is on the right side of the surface.
    const bool keeps =
        valid && seated_ &&
        settings_.stiffness_n_m * meta_.world_per_model * solver_.way_m(goal(tool), solver_.proxy()).norm() <
            settings_.force_n_max;
    if (valid && !keeps) {
        solver_.seat(goal(tool));
        force_.reset();
        stick_slip_.reset();
    }
    seated_ = valid;
}

ModelBodies ToolModel::bodies() const noexcept {
    ModelBodies list;
    list.count = 1;
    list.T_model_body[0] = solver_.proxy();
    list.id[0] = 1;
    list.grips = grips_;
    return list;
}

SurfaceTouch ToolModel::touch() const noexcept {
    SurfaceTouch t;
    t.probe_m = solver_.goal().p_m;
    t.proxy_m = solver_.proxy().p_m;
    t.state = static_cast<TouchState>(touch_.state);
    t.regime = regime_;
    if (adaptive_ != nullptr) t.detail = adaptive_->detail();
    double below_m = 1e300;  // publishes the contacts in order of their weights
    for (t.planes = 0; t.planes < kTouchPlanesMax; ++t.planes) {
        const TouchedPlace* next = nullptr;
        for (std::uint32_t i = 0; i < touch_.places; ++i) {
            const TouchedPlace& p = touch_.place[i];
            if (p.weight_m < below_m && (next == nullptr || p.weight_m > next->weight_m)) next = &p;
        }
        if (next == nullptr) break;
        below_m = next->weight_m;
        t.normal[t.planes] = next->normal;
        t.push_n[t.planes] = settings_.stiffness_n_m * meta_.world_per_model * next->weight_m;
    }
    return t;
}

void ToolModel::publish(const ModelCycle& cycle) noexcept {
    if (topic_ != nullptr) topic_->publish(touch_topic(touch(), cycle));
}

Pose ToolModel::goal(const ToolState& tool) const noexcept {
    return {meta_.to_model(tool.T_world_tool.p_m), tool.T_world_tool.q.normalized()};
}

// The shading correction of the twist from hand to proxy.
Vec6 ToolModel::shaded_m() const noexcept {
    Vec6 sum = Vec6::Zero();
    for (std::uint32_t i = 0; settings_.shading && i < touch_.places; ++i) {
        const TouchedPlace& p = touch_.place[i];
        const Vec3 turn_m = shaded_turn_m(solver_.mesh(), p.triangle, touch_.T_model_proxy.p_m + p.lever_m,
                                          p.normal, p.weight_m);
        sum.head<3>() += turn_m;
        sum.tail<3>() += p.lever_m.cross(turn_m) / solver_.points().gyration_m();
    }
    return sum;
}

Wrench ToolModel::wrench(const ToolState& tool, const Vec6& way_m, const Vec6& moved_m) noexcept {
    const double scale = meta_.world_per_model;
    Vec6 velocity_m_s;
    velocity_m_s << tool.twist_world.linear_m_s, gyration_world_m_ * tool.twist_world.angular_rad_s;
    // Free, the proxy is at the hand but for rounding.
    const bool is_free = touch_.places == 0 && touch_.state == ContactState::settled;
    const Vec6 force_n = force_.step({.lift_m = is_free ? Vec6(Vec6::Zero()) : Vec6(scale * way_m),
                                      .turn_m = scale * shaded_m(),
                                      .moved_m = scale * moved_m,
                                      .velocity_m_s = velocity_m_s,
                                      .gain = fade_.gain()});
    return {force_n.head<3>(), gyration_world_m_ * force_n.tail<3>()};
}

void ToolModel::note_friction(const Vec6& way_m) noexcept {
    if (touch_.places == 0) {
        stick_slip_.reset();
        return;
    }
    Vec6 lift_m = Vec6::Zero();
    for (std::uint32_t i = 0; i < touch_.places; ++i) {
        const TouchedPlace& p = touch_.place[i];
        lift_m.head<3>() += p.weight_m * p.normal;
        lift_m.tail<3>() += p.weight_m / solver_.points().gyration_m() * p.lever_m.cross(p.normal);
    }
    stick_slip_.add(lift_m.norm(), (way_m - lift_m).norm(), solver_.moved(), step_s());
}

StepResult ToolModel::step(const ToolState& tool, const Budget& budget) noexcept {
    const Instant begin = Monotonic::now();
    StepResult result;
    result.load = predict(budget.fidelity);
    result.load.error = error_n(result.load.items);
    fade_.begin_step(step_s());
    const bool clutch = (tool.buttons & 1U) != 0;
    if (!holds_tool(tool.T_world_tool)) {
        fade_.cut();
        touch_ = {};
        seated_ = false;
        result.status = StepStatus::out_of_range;
    } else if (asked_) {
        const Pose to = goal(tool);
        if (clutch && fade_.gain() <= 0.0) seated_ = false;
        if (!seated_ && !clutch) {
            solver_.seat(to);
            force_.reset();
            stick_slip_.reset();
            seated_ = true;
            ++grips_;
        }
        if (seated_) {
            if (clutch)
                fade_.fall();
            else if (solver_.seating())
                fade_.rest();
            else
                fade_.rise();
            const bool hurried = budget.deadline.passed();
            const Vec6 moved_m = solver_.way_m(solver_.goal(), to);
            solver_.set_friction(stick_slip_.coefficient());
            touch_ = solver_.follow(to,
                                    {.points = result.load.items,
                                     .moves = hurried ? 1 : kMovesMost,
                                     .queries = queries(budget.fidelity)},
                                    budget.deadline, choose_surface(budget.fidelity));
            if (adaptive_ != nullptr) regime_ = touch_.adaptive ? TouchRegime::adaptive : TouchRegime::tree;
            const bool on_time = !hurried && !touch_.late;
            // The number of moves that a late step lacks is unknown; at least one.
            if (!on_time) {
                const auto moves = static_cast<float>(std::max(touch_.moves, 1U));
                result.load.work_done = moves / (moves + 1.0F);
            }
            if (on_time && touch_.state == ContactState::lagging) ++lagging_;
            if (!on_time || touch_.state == ContactState::lagging) result.status = StepStatus::out_of_time;
            const Vec6 way_m = solver_.way_m(to, solver_.proxy());
            const double pulled_n = settings_.stiffness_n_m * meta_.world_per_model * way_m.norm();
            note_friction(way_m);
            if (on_time && touch_.looked > 0) record_.add(touch_, queries(budget.fidelity), pulled_n);
            if (touch_.state != ContactState::settled || !on_time)
                result.load.error =
                    std::max(result.load.error, 2.0 * std::min(pulled_n, settings_.force_n_max));
            result.wrench_world = fade_.show(wrench(tool, way_m, moved_m));
            result.load.error += force_.off_n();
            if (pulled_n > kLostLimits * settings_.force_n_max) {
                fade_.follow(fade_);
                solver_.seat(to);
                force_.reset();
                stick_slip_.reset();
                ++grips_;
                ++released_;
            }
        } else {
            touch_ = {};
            fade_.rest();
        }
    }
    result.load.cost = std::max(Monotonic::now() - begin, Duration(1));
    return result;
}

std::unique_ptr<ToolModel> load_tool_model(const SceneFile& scene, const SurfaceSettings& settings,
                                           double step_s) {
    const SceneMeta meta = read_meta(scene);
    if (scene.count(SurfaceMesh::kTag) == 0 || !has_touch_tool(scene))
        throw StartupError("loading '" + scene.name() + "'", "the scene is not a surface with a tool",
                           "bake one with tact-prep touch MESH --tool TOOL -o SCENE");
    const SurfaceMesh mesh = read_surface(scene);
    const TouchTool tool = read_touch_tool(scene);
    std::unique_ptr<ToolModel> model;
    if (settings.mode != SurfaceMode::chr || scene.count({'F', 'R', 'S', 'T'}) == 0) {
        model = std::make_unique<ToolModel>(meta, mesh, tool, settings);
    } else {
        const VertexForest forest = read_forest(scene, mesh.all_positions_m(), mesh.all_corners());
        model = std::make_unique<ToolModel>(meta, mesh, tool, settings, &forest);
    }
    if (step_s > 0.0) model->foresee(rehearse_tool(meta, mesh, tool, settings, step_s));
    return model;
}

}  // namespace tact
