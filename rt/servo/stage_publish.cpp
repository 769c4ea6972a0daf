#include "rt/servo/stage_publish.hpp"

#include <algorithm>

#include "rt/servo/publish_health.hpp"
#include "rt/servo/stage_shape.hpp"
#include "rt/servo/topic_fill.hpp"

namespace tact::servo {

namespace {

// The topic and the models use the same constants without including each other.
static_assert(ModelBodies::kMax == kBodiesMax && ModelBodies::kNone == kNoBody &&
              ModelBodies::kFixed == kBodyFixed);

void publish_tool(const CycleState& c, const HandCycle& h, Latest<ToolTopic>& topic) noexcept {
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
    topic.publish(t);
}

void publish_bodies(const CycleState& c, Latest<BodiesTopic>& topic) noexcept {
    const ModelBodies bodies = c.hand[0].model->bodies();
    BodiesTopic b{};
    b.taken_at_ns = to_ns(c.now);
    b.cycle = c.cycle;
    b.count = std::min(bodies.count, static_cast<std::uint32_t>(kBodiesMax));
    b.active = bodies.active;
    b.grips = bodies.grips;
    b.placements = bodies.placements;
    b.options = bodies.options;
    b.places = bodies.places;
    b.place = bodies.place;
    b.pull_n = static_cast<float>(bodies.pull_n);
    b.building = c.mailbox.building ? 1 : 0;
    for (std::uint32_t i = 0; i < b.count; ++i) {
        put(b.body[i].pos_model_m, bodies.T_model_body[i].p_m);
        put(b.body[i].quat_model_body_xyzw, bodies.T_model_body[i].q);
        b.body[i].id = bodies.id[i];
        b.body[i].structure = bodies.structure[i];
        b.body[i].flags = bodies.flags[i];
    }
    topic.publish(b);
}

}  // namespace

void publish(CycleState& c, const ServoSettings& settings, RtRegion& region) noexcept {
    for (std::uint32_t i = 0; i < c.hands; ++i) publish_tool(c, c.hand[i], region.tool[i]);
    publish_bodies(c, region.bodies);
    for (std::uint32_t i = 0; i < c.hands; ++i)
        c.hand[i].model->publish({.now = c.now, .cycle = c.cycle, .hand = i, .step = c.hand[i].step});
    if (c.dry) return;
    c.statistics.rate.count();
    c.statistics.work.add(c.recomputed_fraction);
    c.armed.add({.armed = c.run.state == RunState::active,
                 .deadline_missed = c.deadline_missed,
                 .level = static_cast<double>(c.budget.fidelity),
                 .error_n = c.hand[0].step.load.error,
                 .force_world_n = c.hand[0].shown_world.force_n},
                c.now);
    if (c.now - c.report.health_at >= std::chrono::milliseconds(100)) {
        c.statistics.rate.turn(c.now);
        c.statistics.work.turn(c.now);
        c.report.health_at = c.now;
        c.report.health_due = true;
        publish_devices(c, region.devices);
        if (c.statistics.second_over(c.now)) {
            c.armed.second_over();
            publish_lateness(c, region.lateness);
        }
        bound_by_delay(c, settings);
    }
    if (c.report.health_due) publish_health(c, settings, region.health);
}

}  // namespace tact::servo
