// With x the translation of the body in the world, phi its rotation vector and v, c the vector and scalar part of the rotation from a
// place to the body: d^2 = |dp|^2 + 4 r^2 |v|^2, r^2 = 2/3 g^2, because 1 - cos angle = 2 |v|^2. Hence
//     -dU_i/dx   = -F dp / sqrt(d^2 + w^2)
//     -dU_i/dphi = -F s r^2 2 c v / sqrt(d^2 + w^2)        (sin angle times the axis is 2 c v)
// and the pull is their mean with the weights exp(-U_i / T) / sum. T = F s w: about as wide as the spring near a place.
//
// Stiffness: the Hessian of U_i has eigenvalues of at most F s / w in the metric (dp, r phi). The soft minimum subtracts the variance of
// the forces over T, at most F^2 / T = F s / w too, so the norm is at most F s / w, and a quarter of it where the rotation is near 180 degrees.
#include "rt/force/docking/basin_pull.hpp"

#include <algorithm>
#include <cmath>

namespace tact {
namespace {

double width_m(double world_per_model) noexcept {
    return BasinPull::kForce_n / (BasinPull::kStiffness_n_m * world_per_model);
}

}  // namespace

bool BasinPull::add(std::uint32_t body, const Pose& T_model_body, double worth) noexcept {
    if (body != body_) count_ = 0;
    if (count_ == kMax) return false;
    body_ = body;
    place_[count_] = T_model_body;
    worth_[count_++] = worth;
    return true;
}

BasinPull::Pull BasinPull::at(const Pose& here, double gyration_m, double world_per_model) const noexcept {
    const double w_m = width_m(world_per_model), r2_m2 = 2.0 / 3.0 * gyration_m * gyration_m;
    const double slope_n = kForce_n * world_per_model;  // joules per metre of the model
    std::array<double, kMax> long_m{}, away_m{};        // sqrt(d^2 + w^2); the same with the handicap
    Pull pull;
    for (std::uint32_t i = 0; i < count_; ++i) {
        const Vec3 v = (here.q * place_[i].q.conjugate()).vec();
        long_m[i] =
            std::sqrt((here.p_m - place_[i].p_m).squaredNorm() + 4.0 * r2_m2 * v.squaredNorm() + w_m * w_m);
        away_m[i] = long_m[i] + kHandicap * gyration_m * (1.0 - worth_[i]);
        if (away_m[i] < away_m[pull.nearest]) pull.nearest = i;
    }
    double sum = 0.0;
    for (std::uint32_t i = 0; i < count_; ++i) {
        const double weight = std::exp((away_m[pull.nearest] - away_m[i]) / w_m);
        sum += weight;
        const Quat turn = here.q * place_[i].q.conjugate();
        const double share = weight / long_m[i];
        pull.wrench_world.force_n -= share * kForce_n * (here.p_m - place_[i].p_m);
        pull.wrench_world.torque_n_m -= share * slope_n * r2_m2 * 2.0 * turn.w() * turn.vec();
    }
    pull.wrench_world.force_n /= sum;
    pull.wrench_world.torque_n_m /= sum;
    pull.energy_j = slope_n * (away_m[pull.nearest] - w_m - w_m * std::log(sum));
    return pull;
}

ModelStiffness BasinPull::stiffness(double gyration_m, double world_per_model) noexcept {
    const double r_world_m = std::sqrt(2.0 / 3.0) * gyration_m * world_per_model;
    return {.force_n_m = kStiffness_n_m, .torque_n_m_rad = kStiffness_n_m * r_world_m * r_world_m};
}

}  // namespace tact
