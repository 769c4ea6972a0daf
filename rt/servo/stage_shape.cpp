#include "rt/servo/stage_shape.hpp"

#include <algorithm>

#include "rt/safety/stages.hpp"

namespace tact::servo {

namespace {

// Least effective mass of hand and arm; bounds the damping that is stable at a delay.
constexpr double kHandMassLeastKg = 0.1;

// Scales the whole field down to the stiffness that is stable at the present delay: force and torque by one gain, so that
// the field stays conservative. At a wall of the workspace both stiffnesses add up and share the bound. Damping has a bound
// of its own. Without force at the device, the gains settle at once.
void smooth_gains(HandCycle& h, const ServoSettings& settings, const DelayBounds& bounds,
                  double dt_s) noexcept {
    const auto within = [](double wanted, double max) { return wanted > max ? max / wanted : 1.0; };
    const bool felt = h.out.gain > 0.0;
    const auto follow = [&](SmoothGain& g, double gain) {
        if (felt)
            g.follow(gain, dt_s);
        else
            g.settle(gain);
    };
    h.stiffness = h.model->stiffness();
    h.stiffness.force_n_m *= settings.force_scale;
    h.stiffness.torque_n_m_rad *= h.torque ? settings.force_scale : 0.0;
    const double walls_n_m = h.chain.settings().wall_stiffness_n_m;
    const bool at_wall = (h.out.acts & kChainWall) != 0;
    const double beside_field_n_m = at_wall ? walls_n_m : 0.0,
                 beside_walls_n_m = at_wall ? h.stiffness.force_n_m : 0.0;
    follow(h.field, std::min(within(h.stiffness.force_n_m + beside_field_n_m, bounds.stiffness_n_m),
                             within(h.stiffness.torque_n_m_rad, bounds.torque_n_m_rad)));
    follow(h.walls, within(walls_n_m + beside_walls_n_m, bounds.stiffness_n_m));
    follow(h.damper, within(settings.damping_n_s_m, bounds.damping_n_s_m));
}

}  // namespace

void bound_by_delay(CycleState& c, const ServoSettings& settings) noexcept {
    const double delay_s = static_cast<double>(c.statistics.metrics.delay_p99_ns) * 1e-9;
    // A freely running loop has another period than the configured one, and so has a loop that cannot keep it.
    const double rate_hz = c.statistics.rate.rate_hz();
    const double period_s = rate_hz > 0.0 ? 1.0 / rate_hz : to_s(settings.period);
    c.bounds.stiffness_n_m = stages::stiffness_max_n_m(settings.hand_damping_n_s_m, period_s, delay_s);
    c.bounds.torque_n_m_rad =
        stages::stiffness_max_n_m(settings.hand_turn_damping_n_m_s_rad, period_s, delay_s);
    c.bounds.damping_n_s_m = stages::damping_max_n_s_m(kHandMassLeastKg, period_s, delay_s);
}

void shape(CycleState& c, const ServoSettings& settings) noexcept {
    const double dt_s = to_s(std::min(c.dt, stages::kStepMax));
    for (std::uint32_t i = 0; i < c.hands; ++i) {
        HandCycle& h = c.hand[i];
        smooth_gains(h, settings, c.bounds, dt_s);
        const double scale = settings.force_scale * h.field.gain();
        h.wanted_world.force_n = scale * h.step.wrench_world.force_n -
                                 settings.damping_n_s_m * h.damper.gain() * h.tool.twist_world.linear_m_s;
        h.wanted_world.torque_n_m = h.torque ? Vec3(scale * h.step.wrench_world.torque_n_m) : Vec3::Zero();
    }
}

}  // namespace tact::servo
