// Repulsive force between overlapping bodies.
//
// Energy    U(D) = F (sqrt(L^2 + D^2) - L) in joules, L = F / K. D is the overlap depth in world metres, a
//           soft maximum over the surface points of each body in the field of the other (clash_force.cpp). A
//           contact of a few atoms is thus nearly as stiff as a flush contact. The force saturates near F at any
//           depth, so a hand can always pull the body out.
// Symmetry  both bodies' points count, so U does not depend on which of the two is held, and the forces on the
//           two bodies are opposite.
// Together  an other body that moves along with the active one (kDockingTogether) makes the same motion in its own axes. Its pair is
//           shared by both and counts half, and the wrench is the derivative by the motion of both, so it stays that of an energy,
//           wherever the bodies are. The stiffness is at most twice that without.
// Units     force N, torque N m in world axes, at the active body's centre of mass; add to the density's wrench.
// Thread    servo; no allocation. About 20 ns per point within reach, at most 2048 points per other body (two
//           bodies of 3500 atoms in contact: 335 points, 6 us; fifteen bodies in contact: 0.11 ms); about 10 ns
//           for a body out of reach.
// Fails by  zero force for poses that are not finite.
#pragma once

#include <span>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"
#include "rt/force/docking/clash_field.hpp"

namespace tact {

struct ClashGains {
    double force_n = 2.0;          // F
    double stiffness_n_m = 100.0;  // K
    // Largest stiffness over the encounters of choose_clash_gains(), with its margin.
    double stiffness_n_m_max = 300.0, torque_n_m_rad_max = 0.0;
};

struct ClashBody {
    const ClashField* field;
    Pose T_model_body;
    bool moves_along = false;  // with the active one
};
// Factor on the stiffness where bodies move along.
inline constexpr double kTogetherStiffness = 2.0;

struct ClashResult {
    Wrench wrench_world;
    double energy_j = 0.0;
    double depth_model_m = 0.0;  // D: 0 where nothing overlaps
    std::uint32_t points = 0;    // points evaluated
};

[[nodiscard]] ClashResult clash_force(const ClashBody& active, std::span<const ClashBody> others,
                                      double world_per_model, const ClashGains& gains) noexcept TACT_RT;

// Chooses K so that seeded encounters of these bodies and their copies stay below 300 N/m in every direction, the limit
// of the density's gain too. Call off the servo thread (about 50 ms); deterministic.
[[nodiscard]] ClashGains choose_clash_gains(std::span<const ClashField> fields, double world_per_model);

}  // namespace tact
