// Derivation. Let v_B(x) = (depth of x in B / u)^4, u = 4 A, and
//     s = sum over the other bodies B of [ a_A sum_{i in A} v_B(x_i) + a_B sum_{j in B} v_A(x_j) ],
// with a = point_weight. Then u s^(1/4) is the 4-norm of all depths, a soft maximum. For a smooth start,
//     D_model^2 = u^2 (sqrt(s + s_0) - sqrt(s_0)),   s_0 = (1/4)^4: reduced stiffness below 1 A,
// and with S = world_per_model, D = S D_model. So
//     dU/ds = F S^2 u^2 / (4 sqrt(L^2 + D^2) sqrt(s + s_0)),
// smooth and bounded for all s >= 0. The wrench is -dU/ds times the derivative of s with respect to position
// (divided by S for world metres) and rotation of the active body. Points of A in the field of B give gradient
// g and moment m about A's centre, in B's axes. Points of B in the field of A give g and m about B's centre, in
// A's axes, for a motion of B; a motion of A about A's centre gives -g and -(m + (c_B - c_A) x g).
//
// Why the 4-norm: with a plain sum of squares, a flush contact of a hundred points is a hundred times as stiff
// as one point, and a gain that is safe for the first cannot be felt in the second. The 4-norm reduces the
// ratio to ten.
//
// Gains. F is 2 N as for the density; choose_clash_gains() sets K per scene. Measured 2026-11-21 on
// 200 seeded encounters of the domains of 1GTE, 1KP8 chain A and the ring 1OEL, 6e6 hand metres per model
// metre, K = 88 N/m: largest eigenvalue of the stiffness 187 N/m (99th percentile 148, median 50); force
// along the push, median, 1, 3, 5, 8 A beyond the first two atoms at 2.8 A: 0.04, 0.06, 0.08, 0.13 N, at most
// 0.65 N. Also tried: a grid of 1.5 A (stiffer at the same force), points 4 A apart (40 % more cost, no stiffer),
// s_0 = (1/2)^4 (a third less force at 2 A). At their home poses, where
// bonds were cut, the domains of 1GTE repel each other with 0.1 N.
#include "rt/force/docking/clash_force.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/random.hpp"
#include "ipc/scene/density/climb.hpp"

namespace tact {

namespace {

constexpr double kStart = 1.0 / 256.0;
constexpr double kStiffnessMaxNM = 300.0, kMargin = 1.25;
constexpr int kEncounters = 96;
constexpr double kDeepestM = 8e-10;

struct Slope {
    double value = 0.0;
    Vec3 gradient = Vec3::Zero();  // axes of the field's body
    Vec3 moment = Vec3::Zero();    // about the origin of the points' body
    std::uint32_t points = 0;
};

// Sums the field over the points of another body; skips runs out of the field's reach.
Slope sum_in(const ClashField& field, const ClashField& pushed, const Pose& T_field_points) noexcept {
    Slope out;
    const double share = pushed.point_weight() * static_cast<double>(pushed.points().size());
    for (const ClashField::Run& run : pushed.runs()) {
        const Vec3 middle = T_field_points * run.middle_m;
        const Vec3 outside = (field.low_m() - middle).cwiseMax(middle - field.high_m());
        if (!(outside.maxCoeff() < run.radius_m)) continue;
        const DensitySums sums = field.map().sum(pushed.points().view(run.begin, run.count), T_field_points);
        out.value += share * sums.density_sigma;
        out.gradient += share * sums.gradient;
        out.moment += share * sums.moment;
        out.points += static_cast<std::uint32_t>(run.count);
    }
    return out;
}

}  // namespace

ClashResult clash_force(const ClashBody& active, std::span<const ClashBody> others, double world_per_model,
                        const ClashGains& gains) noexcept {
    ClashResult result;
    if (!active.T_model_body.finite() || !(gains.force_n > 0.0) || !(gains.stiffness_n_m > 0.0))
        return result;
    const Pose& here = active.T_model_body;
    const Pose T_active_model = here.inverse();
    double s = 0.0;
    Vec3 gradient = Vec3::Zero(),
         moment = Vec3::Zero();  // of s by the active body's position and rotation, model axes
    for (const ClashBody& other : others) {
        const Pose& there = other.T_model_body;
        const Vec3 apart = there.p_m - here.p_m;
        const double reach = active.field->radius_m() + other.field->radius_m();
        if (!there.finite() || !(apart.squaredNorm() < reach * reach)) continue;
        const Slope mine = sum_in(*other.field, *active.field, there.inverse() * here);
        const Slope theirs = sum_in(*active.field, *other.field, T_active_model * there);
        result.points += mine.points + theirs.points;
        const Vec3 pulled = here.q * theirs.gradient;
        Vec3 by_shift = there.q * mine.gradient - pulled;
        Vec3 by_turn = there.q * mine.moment - (here.q * theirs.moment + apart.cross(pulled));
        double share = 1.0;
        if (other.moves_along) {
            // The other body's derivatives, by the active one's motion: its own is that one, turned from the active body's axes
            // to its own.
            const Quat back = here.q * there.q.conjugate();
            const Vec3 other_turn = apart.cross(by_shift) - by_turn;
            by_shift -= back * by_shift;
            by_turn += back * other_turn;
            share = 0.5;
        }
        s += share * (mine.value + theirs.value);
        gradient += share * by_shift;
        moment += share * by_turn;
    }
    if (!(s > 0.0)) return result;
    const double root = std::sqrt(s + kStart);
    const double depth2 = ClashField::kUnitM * ClashField::kUnitM * (root - std::sqrt(kStart));
    const double soft = gains.force_n / gains.stiffness_n_m;
    const double scale2 = world_per_model * world_per_model;
    const double far = std::sqrt(soft * soft + scale2 * depth2);
    const double slope =
        gains.force_n * scale2 * ClashField::kUnitM * ClashField::kUnitM / (4.0 * far * root);
    result.wrench_world.force_n = -slope / world_per_model * gradient;
    result.wrench_world.torque_n_m = -slope * moment;
    result.energy_j = gains.force_n * (far - soft);
    result.depth_model_m = std::sqrt(depth2);
    if (!result.wrench_world.finite()) return {};
    return result;
}

// Cycles through all pairs of structures, including a structure with its own copy. Each encounter has random rotations,
// a random direction and a random depth. Its stiffness is the largest eigenvalue, by magnitude, of the force gradient
// over half an angstrom, as in ipc/scene/density/docking_gain.cpp.
// K is scaled so that kMargin times the largest meets the limit.
ClashGains choose_clash_gains(std::span<const ClashField> fields, double world_per_model) {
    ClashGains gains;
    if (fields.empty()) return gains;
    SeededRandom random(20261121);
    double most = 0.0, most_turn = 0.0;
    std::size_t one = 0, two = 0;
    const int pairs = static_cast<int>(fields.size() * (fields.size() + 1) / 2);
    for (int k = 0; k < std::max(kEncounters, 6 * pairs); ++k) {
        const ClashBody other{&fields[two], {Vec3::Zero(), random.rotation()}};
        const Vec3 side = random.direction();
        const Pose start{Vec3::Zero(), random.rotation()};
        const auto felt = [&](const Vec3& p_m) {
            return clash_force({&fields[one], {p_m, start.q}}, {&other, 1}, world_per_model, gains);
        };
        const double depth_m = kDeepestM * random.uniform();
        double near_m = 0.0, far_m = fields[one].radius_m() + fields[two].radius_m();
        for (int halving = 0; halving < 10; ++halving) {
            const double middle_m = 0.5 * (near_m + far_m);
            (felt(middle_m * side).depth_model_m > depth_m ? near_m : far_m) = middle_m;
        }
        Eigen::Matrix3d slope, turn;
        constexpr double kTurnRad = 5e-3;
        const auto twisted = [&](const Vec3& turn_rad) {
            const Quat q = (quat_from_rotation_vector(turn_rad) * start.q).normalized();
            return clash_force({&fields[one], {far_m * side, q}}, {&other, 1}, world_per_model, gains)
                .wrench_world.torque_n_m;
        };
        for (int a = 0; a < 3; ++a) {
            turn.col(a) =
                (twisted(kTurnRad * Vec3::Unit(a)) - twisted(-kTurnRad * Vec3::Unit(a))) / (2.0 * kTurnRad);
            const Vec3 step_m = 0.5e-10 * Vec3::Unit(a);
            slope.col(a) = (felt(far_m * side + step_m).wrench_world.force_n -
                            felt(far_m * side - step_m).wrench_world.force_n) /
                           (1e-10 * world_per_model);
        }
        most = std::max(most, spectral_norm(0.5 * (slope + slope.transpose())));
        most_turn = std::max(most_turn, spectral_norm(0.5 * (turn + turn.transpose())));
        two = two + 1 < fields.size() ? two + 1 : (one = one + 1 < fields.size() ? one + 1 : 0);
    }
    const double before_n_m = gains.stiffness_n_m;
    if (most > 0.0) gains.stiffness_n_m *= kStiffnessMaxNM / (kMargin * most);
    gains.stiffness_n_m = std::min(gains.stiffness_n_m, kStiffnessMaxNM);
    gains.stiffness_n_m_max = kStiffnessMaxNM;
    gains.torque_n_m_rad_max = kMargin * most_turn * std::max(1.0, gains.stiffness_n_m / before_n_m);
    return gains;
}

}  // namespace tact
