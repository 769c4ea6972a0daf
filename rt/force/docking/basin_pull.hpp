// Pull of a body towards places that a search found.
//
// Energy    U = -T ln sum_i exp(-U_i / T), U_i = F s (sqrt(d_i^2 + w^2) - w + h_i), in joules. d_i: root mean square distance of the
//           body's atoms, in the model, from place i: d_i^2 = |dp|^2 + 2/3 g^2 * 2 (1 - cos angle), g the radius of gyration. s:
//           world per model. So the body is drawn to the place that it leans to; between two places the pull changes smoothly
// Worth     a place with a lower score counts as farther away by h_i = kHandicap g (1 - score / best score)
// Size      force at most F, torque at most F s g; far from a place constant, so that a body comes from anywhere and a hand can
//           always hold against it; near a place a spring of F / (s w) = kStiffness_n_m
// Passive   the pull is the derivative of U: no closed path gives energy away
// Units     force N, torque N m in world axes, about the centre of mass
// Thread    servo; no allocation; constant time (kMax places, about 20 ns each)
#pragma once

#include <array>
#include <cstdint>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"
#include "rt/force/force_model.hpp"

namespace tact {

class BasinPull {
public:
    static constexpr std::size_t kMax = 20;
    static constexpr double kForce_n = 0.8, kStiffness_n_m = 150.0, kHandicap = 5.0;

    struct Pull {
        Wrench wrench_world;
        double energy_j = 0.0;
        std::uint32_t nearest = 0;  // index of the place that the body leans to
    };

    // Places of one body: one of another body replaces them all. worth: score / best score, in [0, 1]. False: there are kMax already.
    // q must be a unit quaternion.
    bool add(std::uint32_t body, const Pose& T_model_body, double worth) noexcept TACT_RT;
    void clear() noexcept TACT_RT { count_ = 0; }
    [[nodiscard]] std::uint32_t count() const noexcept { return count_; }
    [[nodiscard]] std::uint32_t body() const noexcept { return body_; }  // id
    // There must be a place.
    [[nodiscard]] Pull at(const Pose& T_model_body, double gyration_m,
                          double world_per_model) const noexcept TACT_RT;
    // The largest anywhere.
    [[nodiscard]] static ModelStiffness stiffness(double gyration_m, double world_per_model) noexcept TACT_RT;

private:
    std::uint32_t body_ = 0, count_ = 0;
    std::array<Pose, kMax> place_;
    std::array<double, kMax> worth_{};
};

}  // namespace tact
