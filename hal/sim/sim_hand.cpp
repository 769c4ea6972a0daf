// m dv/dt = F - b v over a step h with constant F has the solution
//     v(h) = F/b + (v - F/b) e,  x(h) = x + F/b h + (v - F/b) (m/b) (1 - e),  e = exp(-b h / m)
// and the same holds for the rotation about the centre. No explicit scheme, no limit on h.
#include "hal/sim/sim_hand.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include "ipc/base/error.hpp"

namespace tact {

namespace {

// Velocity and displacement of one damped step.
struct Glide {
    Vec3 velocity, way;
};

Glide glide(const Vec3& velocity, const Vec3& force, double inertia, double damping, double h_s) noexcept {
    const double rest = std::exp(-damping * h_s / inertia);
    const Vec3 terminal = force / damping;
    const Vec3 excess = velocity - terminal;
    return {terminal + rest * excess, terminal * h_s + excess * (inertia / damping * (1.0 - rest))};
}

// Pull of the wandering hand on the tool: soft, so that rendered forces still have an effect.
constexpr double kPullStiffness = 60.0;      // N/m
constexpr double kPullTurnStiffness = 0.05;  // N m/rad
constexpr double kSubstepS = 1e-3;           // the pull changes with the position; 1 ms keeps K h < b
constexpr double kStrokedUp = 0.2;           // "stroke": fraction of the vertical wandering
constexpr double kDrilledAside = 0.2;        // "drill": fraction of the lateral wandering
constexpr double kLoweredS = 0.5;
constexpr double kPauseMaxS = 0.05;  // after a longer pause, the hand counts as still for the rest

}  // namespace

SimHand::SimHand(const SimHandSettings& settings, const Vec3& reach_m)
    : settings_(settings),
      reach_m_(reach_m),
      strokes_(settings.script == "stroke"),
      drills_(settings.script == "drill"),
      mouse_(reach_m) {
    wanders_ = strokes_ || drills_ || settings.script == "wander";
    if (settings.script == "surgeon" || settings.script == "suction-tube") {
        surgeon_.emplace(SimSurgeonSettings{
            .suction_tube = settings.script == "suction-tube", .seed = settings.seed, .at_m = settings.at_m});
        pose_ = surgeon_->begin();
    } else if (settings.script != "passive" && !is_led_hand(settings.script) && !wanders_) {
        throw StartupError("emulated hand", "no script has the name \"" + settings.script + "\"",
                           "use \"passive\", \"wander\", \"stroke\", \"drill\", \"surgeon\", "
                           "\"suction-tube\", \"mouse\", \"spacemouse\" or \"gamepad\" (device.hand)");
    }
    std::mt19937_64 random(settings.seed);
    const auto uniform = [&random](double low, double high) {
        return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
    };
    for (auto& axis : waves_) {
        double sum = 0.0;
        for (Wave& w : axis) {
            w = {2.0 * std::numbers::pi * uniform(0.05, 0.5), uniform(0.0, 2.0 * std::numbers::pi),
                 uniform(0.3, 1.0)};
            sum += w.weight;
        }
        for (Wave& w : axis) w.weight /= sum;
    }
}

double SimHand::wave(std::size_t axis) const noexcept {
    double sum = 0.0;
    for (const Wave& w : waves_[axis]) {
        // The difference starts at zero, so that the hand does not jump at the start.
        sum += w.weight * (std::sin(w.frequency_rad_s * time_s_ + w.phase_rad) - std::sin(w.phase_rad));
    }
    return 0.5 * sum;
}

Wrench SimHand::pull() const noexcept {
    Vec3 there = settings_.wander_m * Vec3(wave(0), wave(1), wave(2));
    if (strokes_) {
        there.y() *= kStrokedUp;
        there.y() -= settings_.press_m * (1.0 - std::exp(-time_s_ / kLoweredS));
    }
    if (drills_) {
        there *= kDrilledAside;
        there.z() = kDrilledAside * there.z() - settings_.press_m * (1.0 - std::exp(-time_s_ / kLoweredS));
    }
    const Vec3 turn = settings_.wander_rad * Vec3(wave(3), wave(4), wave(5));
    return {kPullStiffness * (there - pose_.p_m), kPullTurnStiffness * (turn - rotation_vector_rad(pose_.q))};
}

void SimHand::step(Duration dt, const Wrench& wrench_dev, bool powered) noexcept {
    const double h_all = std::min(to_s(dt), kPauseMaxS);
    if (h_all <= 0.0) return;
    const bool led = mouse_.leads() && !held_m_, scripted = !mouse_.taken() && !held_m_;
    const bool pulled = held_m_ || led || (scripted && (wanders_ || surgeon_));
    const int substeps = pulled ? static_cast<int>(std::ceil(h_all / kSubstepS)) : 1;
    const double h = h_all / substeps;
    for (int i = 0; i < substeps; ++i) {
        Wrench w = wrench_dev;
        if (held_m_) {
            w.force_n += kPullStiffness * (*held_m_ - pose_.p_m);
        } else if (led) {
            mouse_.step(h);
            const Wrench hand = mouse_.pull(pose_, twist_);
            w.force_n += hand.force_n;
            w.torque_n_m += hand.torque_n_m;
        } else if (scripted && wanders_) {
            const Wrench hand = pull();
            w.force_n += hand.force_n;
            w.torque_n_m += hand.torque_n_m;
        }
        if (surgeon_ && scripted) {
            surgeon_->step(h, pose_.p_m, wrench_dev.force_n, powered);
            const Wrench hand = surgeon_->pull(pose_, twist_);
            w.force_n += hand.force_n;
            w.torque_n_m += hand.torque_n_m;
        }
        const Glide move = glide(twist_.linear_m_s, w.force_n, settings_.mass_kg, settings_.damping_n_s_m, h);
        const Glide turn =
            glide(twist_.angular_rad_s, w.torque_n_m, settings_.inertia_kg_m2, settings_.damping_n_m_s, h);
        pose_.p_m += move.way;
        pose_.q = (quat_from_rotation_vector(turn.way) * pose_.q).normalized();
        twist_ = {move.velocity, turn.velocity};
        // The mechanical stops of the arm: the position stays there, and the velocity along that axis is zero.
        for (int axis = 0; axis < 3; ++axis) {
            if (std::abs(pose_.p_m[axis]) <= reach_m_[axis]) continue;
            pose_.p_m[axis] = std::copysign(reach_m_[axis], pose_.p_m[axis]);
            twist_.linear_m_s[axis] = 0.0;
        }
        time_s_ += h;
    }
}

}  // namespace tact
