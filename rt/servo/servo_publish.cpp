// The servo's words: every topic of the region "tact.rt" is written here and nowhere else.
#include <algorithm>
#include <cstring>

#include "rt/servo/line_names.hpp"
#include "rt/servo/rt_guard.hpp"
#include "rt/servo/servo.hpp"

namespace tact {

namespace {

void put(double (&to)[3], const Vec3& from) noexcept {
    for (int i = 0; i < 3; ++i) to[i] = from[i];
}
void put(float (&to)[3], const Vec3& from) noexcept {
    for (int i = 0; i < 3; ++i) to[i] = static_cast<float>(from[i]);
}
void put(double (&to)[4], const Quat& from) noexcept {
    for (int i = 0; i < 4; ++i) to[i] = from.coeffs()[i];
}
// The topic and the model say the same things in the same numbers; neither knows the other.
static_assert(ModelBodies::kMax == kBodiesMax && ModelBodies::kNone == kNoBody &&
              ModelBodies::kFixed == kBodyFixed && ModelTouch::kPlanesMax == kTouchPlanesMax);
static_assert(static_cast<int>(kOptionClash) == static_cast<int>(kDockingClash) &&
              static_cast<int>(kOptionSubtraction) == static_cast<int>(kDockingSubtraction) &&
              static_cast<int>(kOptionLaplacian) == static_cast<int>(kDockingLaplacian));

std::int32_t cut_ns(Duration d) noexcept {
    return static_cast<std::int32_t>(std::clamp<std::int64_t>(d.count(), 0, 2'000'000'000));
}

}  // namespace

void Servo::report(EventCode code, double a, double b, std::uint16_t detail) noexcept {
    ++events_reported_;
    EventTopic e{};
    e.taken_at_ns = to_ns(c_->now);
    e.cycle = c_->cycle;
    e.code = static_cast<std::uint16_t>(code);
    e.detail = detail;
    e.a = a;
    e.b = b;
    region_.events.push(e);
}

// A limit that acts for a second would fill the ring with itself; each is said at most twice a second.
void Servo::report_limits(CycleState& c, HandCycle& h) noexcept {
    if (dry_ || h.out.acts == 0 || !force_may_flow(c.run.state)) return;
    const ChainSettings& limit = h.chain.settings();
    const auto due = [&](std::uint32_t act, std::size_t index) {
        if ((h.out.acts & act) == 0 || c.now - h.said_at[index] < std::chrono::milliseconds(500))
            return false;
        h.said_at[index] = c.now;
        return true;
    };
    if (due(kChainForce, 3)) report(EventCode::force_limited, h.out.wanted_n, limit.force_n_max);
    if (due(kChainTorque, 4)) report(EventCode::torque_limited, h.out.wanted_n_m, limit.torque_n_m_max);
    if (due(kChainSlew, 6)) report(EventCode::slew_limited, h.out.step_n, limit.force_slew_n_s * to_s(c.dt));
    if (due(kChainTorqueSlew, 7))
        report(EventCode::torque_slew_limited, h.out.step_n_m, limit.torque_slew_n_m_s * to_s(c.dt));
}

void Servo::report_notice(HandCycle& h, std::uint32_t hand) noexcept {
    if (dry_ || h.sample.notice == h.said) return;
    h.said = h.sample.notice;
    report(EventCode::device_notice, static_cast<double>(h.said), static_cast<double>(hand));
    health_due_ = true;
}

void Servo::publish_tools(const CycleState& c) noexcept {
    for (std::uint32_t i = 0; i < c.hands; ++i) {
        const HandCycle& h = c.hand[i];
        ToolTopic t{};
        t.taken_at_ns = to_ns(h.sample.taken_at);
        t.cycle = c.cycle;
        put(t.pos_world_m, h.tool.T_world_tool.p_m);
        put(t.quat_world_tool_xyzw, h.tool.T_world_tool.q);
        put(t.force_world_n, h.shown_world.force_n);
        put(t.torque_world_n_m, h.shown_world.torque_n_m);
        put(t.force_model_n, h.step.wrench_world.force_n);
        put(t.velocity_world_m_s, h.tool.twist_world.linear_m_s);
        t.buttons = h.tool.buttons;
        t.device_state = static_cast<std::uint8_t>(h.sample.state);
        t.at_wall = (h.out.acts & kChainWall) != 0 ? 1 : 0;
        region_.tool[i].publish(t);
    }
    const ModelBodies bodies = c.hand[0].model->bodies();
    BodiesTopic b{};
    b.taken_at_ns = to_ns(c.now);
    b.cycle = c.cycle;
    b.count = std::min(bodies.count, static_cast<std::uint32_t>(kBodiesMax));
    b.active = bodies.active;
    b.grips = bodies.grips;
    b.placements = bodies.placements;
    b.options = bodies.options;
    b.building = building_ ? 1 : 0;
    for (std::uint32_t i = 0; i < b.count; ++i) {
        put(b.body[i].pos_model_m, bodies.T_model_body[i].p_m);
        put(b.body[i].quat_model_body_xyzw, bodies.T_model_body[i].q);
        b.body[i].id = bodies.id[i];
        b.body[i].structure = bodies.structure[i];
        b.body[i].flags = bodies.flags[i];
    }
    region_.bodies.publish(b);
    publish_touch(c);
    publish_drill(c);
}

void Servo::publish_drill(const CycleState& c) noexcept {
    DrillTopic t{};
    bool there = false;
    for (std::uint32_t i = 0; i < c.hands; ++i) {
        const ModelDrill tool = c.hand[i].model->drill();
        if (!tool.there) continue;
        there = true;
        t.removed_levels += tool.removed_levels;
        t.level_m3 = tool.level_m3;
        DrillHand& h = t.hand[i];
        put(h.pos_model_m, tool.T_model_tool.p_m);
        put(h.quat_model_tool_xyzw, tool.T_model_tool.q);
        h.removed_levels = tool.removed_levels;
        h.radius_m = static_cast<float>(tool.radius_m);
        h.length_m = static_cast<float>(tool.length_m);
        h.tip_radius_m = static_cast<float>(tool.tip_radius_m);
        h.shaft_radius_m = static_cast<float>(tool.shaft_radius_m);
        h.shaft_length_m = static_cast<float>(tool.shaft_length_m);
        h.burr_rad_s = static_cast<float>(tool.burr_rad_s);
        h.depth = static_cast<float>(tool.depth);
        h.elastic_n = static_cast<float>(tool.elastic_n);
        h.force_n = static_cast<float>(c.hand[i].step.wrench_world.force_n.norm());
        h.cut_levels = static_cast<std::uint32_t>(tool.cut_levels);
        h.kind = tool.cuts ? DrillKind::burr : DrillKind::suction_tube;
        h.shape = static_cast<DrillShape>(tool.shape);
        h.irrigation = tool.cuts && c.drives.irrigation ? 1.0F : 0.0F;
        h.suction = !tool.cuts && c.drives.suction ? 1.0F : 0.0F;
    }
    if (!there) return;
    t.taken_at_ns = to_ns(c.now);
    t.cycle = c.cycle;
    t.burr_rad_s_most = static_cast<float>(settings_.drives.burr_rad_s);
    t.irrigation_m3_s_most = static_cast<float>(settings_.drives.irrigation_m3_s);
    t.suction_m3_s_most = static_cast<float>(settings_.drives.suction_m3_s);
    region_.drill.publish(t);
}

void Servo::publish_touch(const CycleState& c) noexcept {
    const ModelTouch touch = c.hand[0].model->touch();
    if (!touch.there) return;
    TouchTopic t{};
    t.taken_at_ns = to_ns(c.now);
    t.cycle = c.cycle;
    put(t.probe_model_m, touch.probe_m);
    put(t.proxy_model_m, touch.proxy_m);
    t.radius_model_m = touch.radius_m;
    t.planes = std::min(touch.planes, static_cast<std::uint32_t>(kTouchPlanesMax));
    for (std::uint32_t i = 0; i < t.planes; ++i) {
        put(t.normal_model[i], touch.normal[i]);
        t.push_n[i] = static_cast<float>(touch.push_n[i]);
    }
    t.state = static_cast<TouchState>(touch.state);
    t.regime = static_cast<TouchRegime>(touch.regime);
    if (const ModelDetail& d = touch.detail; d.there) {
        t.detail = d.full ? 2 : 1;
        t.detail_shape = static_cast<DetailShape>(d.shape);
        t.detail_radius_model_m = static_cast<float>(d.radius_m);
        t.detail_width = d.width;
        t.detail_error_far = d.error_far;
        t.deviation_model_m = static_cast<float>(d.deviation_m);
        t.detail_vertices = d.vertices;
        t.detail_triangles = d.triangles;
        t.near_triangles = d.near_triangles;
        t.turn_s = static_cast<float>(d.turn_s);
        t.turn_predicted_s = static_cast<float>(d.turn_predicted_s);
    }
    region_.touch.publish(t);
}

void Servo::publish_health(const CycleState& c) noexcept {
    health_due_ = false;
    const WindowMetrics& f = statistics_.metrics;
    HealthTopic t{};
    t.taken_at_ns = to_ns(c.now);
    t.cycle = c.cycle;
    t.period_ns = settings_.free_running ? 0 : settings_.period.count();
    t.force_rate_hz = statistics_.rate.rate_hz();
    t.force_rate_mean_hz = statistics_.rate.mean_hz(c.now);
    t.goal_hz = governor_.settings().goal_hz;
    t.lateness_p50_ns = f.lateness_p50_ns;
    t.lateness_p99_ns = f.lateness_p99_ns;
    t.lateness_max_ns = f.lateness_max_ns;
    t.cycle_cost_p50_ns = f.cost_p50_ns;
    t.cycle_cost_max_ns = f.cost_max_ns;
    t.overruns = pacer_.overruns();
    t.overrun_at_ns = overrun_at_ns_;
    t.skipped = pacer_.skipped();
    t.allocations = rt_guard::counts().allocations;
    t.locks = rt_guard::counts().locks;
    t.page_faults = std::max(c.housekeeping.page_faults, page_faults_);
    t.bad_input = c.housekeeping.bad_input;
    t.events = events_reported_;
    t.command_sequence = last_sequence_;
    t.command_result = static_cast<std::uint32_t>(last_result_);
    t.schedule_flags = schedule_flags_;
    t.gui_heartbeat_age_ns = c.housekeeping.gui_heartbeat_ns < 0
                                 ? -1
                                 : std::max<std::int64_t>(to_ns(c.now) - c.housekeeping.gui_heartbeat_ns, 0);
    t.gui_fps = c.housekeeping.gui_fps;
    t.gui_vertices = c.housekeeping.gui_vertices;
    t.state = static_cast<std::uint8_t>(c.run.state);
    t.reason = static_cast<std::uint8_t>(c.run.reason);
    t.gui_attached = c.housekeeping.gui_attached != 0 ? 1 : 0;
    t.device_state = static_cast<std::uint8_t>(c.hand[0].sample.state);
    if (lines_ != nullptr) {
        t.lines = static_cast<std::uint8_t>(shown(c.lines.sample.state));
        t.lines_reason = static_cast<std::uint8_t>(reason_of(c.lines.sample.cause));
    }
    t.recomputed_fraction_mean = static_cast<float>(statistics_.work.recomputed_fraction_mean());
    t.recomputed_fraction_least = static_cast<float>(statistics_.work.recomputed_fraction_least());
    t.rested = static_cast<float>(statistics_.work.rested());
    t.delay_p50_ns = f.delay_p50_ns;
    t.delay_p99_ns = f.delay_p99_ns;
    t.stiffness_n_m_max = static_cast<float>(stiffness_n_m_max_);
    for (std::uint32_t i = 0; i < c.hands; ++i) {
        t.device_notice[i] = static_cast<std::uint8_t>(c.hand[i].sample.notice);
        t.device_bus[i] = c.hand[i].sample.bus;
    }
    region_.health.publish(t);
}

void Servo::publish_devices(CycleState& c) noexcept {
    DevicesTopic t{};
    t.taken_at_ns = to_ns(c.now);
    t.cycle = c.cycle;
    for (std::uint32_t i = 0; i < c.hands; ++i) {
        HandCycle& h = c.hand[i];
        const DeviceSample& s = h.sample;
        DeviceHand& d = t.hand[i];
        d.there = 1;
        d.samples = s.sequence;
        d.age_ns = s.sequence > 0 ? std::max<std::int64_t>((c.now - s.taken_at).count(), 0) : -1;
        d.age_ns_most = std::max(h.age_most.count(), d.age_ns);
        d.heat = static_cast<float>(h.out.heat);
        d.force_n_max = static_cast<float>(h.chain.settings().force_n_max);
        d.force_n_continuous = static_cast<float>(h.chain.settings().force_n_continuous);
        d.winding_c = s.winding_c;
        d.winding_c_max = s.winding_c_max;
        d.motor = s.hottest_motor;
        d.state = static_cast<std::uint8_t>(s.state);
        d.read = static_cast<std::uint8_t>(h.read_status);
        h.age_most = Duration{0};
    }
    region_.devices.publish(t);
}

void Servo::publish_lateness(const CycleState& c) noexcept {
    LatenessTopic t{};
    t.taken_at_ns = to_ns(c.now);
    t.total = statistics_.lateness.total();
    t.max_ns = statistics_.lateness.max_ns();
    std::copy(statistics_.lateness.counts().begin(), statistics_.lateness.counts().end(), t.counts);
    region_.lateness.publish(t);
}

void Servo::publish_levels(const CycleState& c) noexcept {
    levels_vertices_max_ = c.housekeeping.gui_vertices_max;
    levels_particles_max_ = c.housekeeping.gui_particles_max;
    LevelsTopic t{};
    t.taken_at_ns = to_ns(c.now);
    t.sequence = levels_sequence_;
    t.goal_hz = governor_.settings().goal_hz;
    t.rate_hz = law_rate_hz_;
    t.display_goal_hz = static_cast<float>(governor_.settings().display_goal_hz);
    const std::string_view law = kLawNames[static_cast<std::size_t>(governor_.settings().law)];
    std::memcpy(t.law, law.data(), std::min(law.size(), kLawNameMax - 1));
    const auto paths = governor_.paths();
    t.count = static_cast<std::uint32_t>(std::min(paths.size(), tact::kPathsMax));
    for (std::size_t i = 0; i < t.count; ++i) {
        PathLevel& p = t.path[i];
        const std::string_view name = paths[i].knob.path;
        std::memcpy(p.path, name.data(), std::min(name.size(), kPathNameMax - 1));
        p.level = paths[i].level;
        p.floor = paths[i].knob.floor;
        p.reason = static_cast<std::uint8_t>(paths[i].reason);
        p.haptic = paths[i].knob.haptic ? 1 : 0;
    }
    const ForceModel& model = *c.hand[0].model;
    PathLevel& mesh = t.path[kMeshIndex];
    mesh.items_max = c.housekeeping.gui_vertices_max;
    mesh.items = static_cast<std::uint32_t>(static_cast<double>(mesh.level) * mesh.items_max + 0.5);
    mesh.cost_s = c.housekeeping.gui_busy_s;
    if (settings_.bone) {
        PathLevel& particles = t.path[kParticlesIndex];
        particles.items_max = c.housekeeping.gui_particles_max;
        particles.items =
            static_cast<std::uint32_t>(static_cast<double>(particles.level) * particles.items_max + 0.5);
        particles.cost_s = c.housekeeping.gui_particles_s;
    }
    PathLevel& force = t.path[kForceIndex];
    force.items = model.items(force.level);
    force.items_max = model.items(1.0F);
    force.cost_s = model_cost_s_;
    force.error = c.hand[0].step.load.error;
    region_.levels.publish(t);
}

void Servo::publish_trace(const CycleState& c) noexcept {
    const HandCycle& h = c.hand[0];
    TraceTopic t{};
    t.taken_at_ns = to_ns(c.now);
    t.cycle = c.cycle;
    t.lateness_ns = cut_ns(c.lateness);
    t.cost_ns = cut_ns(c.cost);
    t.model_ns = cut_ns(c.model_cost);
    t.level = governor_.level(kForceIndex);
    put(t.pos_world_m, h.tool.T_world_tool.p_m);
    put(t.force_world_n, h.shown_world.force_n);
    put(t.torque_world_n_m, h.shown_world.torque_n_m);
    t.status = static_cast<std::uint32_t>(c.run.state) | static_cast<std::uint32_t>(h.step.status) << 8;
    if (c.drives.burr_rad_s > 0.0) t.status |= kTraceBurrTurns;
    if (h.model->drill().cut_levels > 0) t.status |= kTraceCuts;
    t.model_error_n = static_cast<float>(h.step.load.error);
    t.items = static_cast<std::uint32_t>(
        h.step.load.recomputed_fraction * static_cast<float>(h.step.load.items) + 0.5F);
    region_.trace.push(t);
}

void Servo::publish_end(std::uint64_t page_faults) noexcept {
    page_faults_ = page_faults;
    publish_lateness(*c_);
    publish_health(*c_);
}

}  // namespace tact
