// What is felt of a model at today's delay: field, walls and damping, each within what is stable.
#include <algorithm>

#include "rt/safety/stages.hpp"
#include "rt/servo/servo.hpp"

namespace tact {

namespace {

// Of a hand and an arm together, the lightest: what a damper is stable for at a delay hangs on it.
constexpr double kHandMassLeastKg = 0.1;

}  // namespace

void Servo::bound_by_delay() noexcept {
    const double delay_s = static_cast<double>(statistics_.metrics.delay_p99_ns) * 1e-9;
    stiffness_n_m_max_ =
        stages::stiffness_max_n_m(settings_.hand_damping_n_s_m, to_s(settings_.period), delay_s);
    damping_n_s_m_max_ = stages::damping_max_n_s_m(kHandMassLeastKg, to_s(settings_.period), delay_s);
}

// Beyond what is stable at today's delay the whole field is felt weaker, so that no pose is unstable; walls and
// damping have bounds of their own. While nothing is felt there is nothing to glide from.
void Servo::smooth_gains(HandCycle& h, double dt_s) noexcept {
    const auto within = [](double wanted, double max) { return wanted > max ? max / wanted : 1.0; };
    const bool felt = h.out.gain > 0.0;
    const auto follow = [&](SmoothGain& g, double gain) {
        if (felt)
            g.follow(gain, dt_s);
        else
            g.settle(gain);
    };
    follow(h.field, within(settings_.force_scale * h.model->stiffness_n_m(), stiffness_n_m_max_));
    follow(h.walls, within(h.chain.settings().wall_stiffness_n_m, stiffness_n_m_max_));
    follow(h.damper, within(settings_.damping_n_s_m, damping_n_s_m_max_));
}

void Servo::shape(CycleState& c) noexcept {
    const double dt_s = to_s(std::min(c.dt, stages::kStepMax));
    for (std::uint32_t i = 0; i < c.hands; ++i) {
        HandCycle& h = c.hand[i];
        smooth_gains(h, dt_s);
        const double scale = settings_.force_scale * h.field.gain();
        h.wanted_world.force_n = scale * h.step.wrench_world.force_n -
                                 settings_.damping_n_s_m * h.damper.gain() * h.tool.twist_world.linear_m_s;
        h.wanted_world.torque_n_m = h.torque ? Vec3(scale * h.step.wrench_world.torque_n_m) : Vec3::Zero();
    }
}

}  // namespace tact
