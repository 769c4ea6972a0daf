// Bodies push each other apart: the wall that is felt when the active body meets another.
//
// Energy    U(D) = F (sqrt(L^2 + D^2) - L) in joules, L = F / K. D is the depth of the overlap in the hand's
//           metres, a soft maximum over the surface points of either body in the field of the other
//           (clash_force.cpp). So a first touch of a few atoms is nearly as firm as a flush contact, and the
//           force stays about at F, however deep: a hand can always pull out.
// Symmetry  both bodies' points count, so U does not depend on which of the two is held, and the force on
//           one is minus that on the other.
// Units     force N, torque N m in world axes, at the active body's centre of mass: add to the density's.
// Thread    servo; no allocation. Some 20 ns per point that comes near, at most 2048 points per neighbour
//           (two bodies of 3500 atoms in contact: 335 points, 6 us; fifteen neighbours in contact: 0.11 ms);
//           a neighbour that is out of reach costs some 10 ns.
// Fails by  no force: poses that are not finite.
#pragma once

#include <span>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"
#include "rt/force/docking/clash_field.hpp"

namespace tact {

struct ClashGains {
    double force_n = 2.0;          // F
    double stiffness_n_m = 100.0;  // K
};

struct ClashBody {
    const ClashField* field;
    Pose T_model_body;
};

struct ClashResult {
    Wrench wrench_world;
    double energy_j = 0.0;
    double depth_model_m = 0.0;  // D: 0 where nothing overlaps
    std::uint32_t points = 0;    // looked at
};

[[nodiscard]] ClashResult clash_force(const ClashBody& active, std::span<const ClashBody> others,
                                      double world_per_model, const ClashGains& gains) noexcept TACT_RT;

// K such that seeded encounters of these bodies and of their copies stay below 300 N/m in every direction:
// what the density's gain is limited to. Off the servo thread (some 50 ms); repeats exactly.
[[nodiscard]] ClashGains choose_clash_gains(std::span<const ClashField> fields, double world_per_model);

}  // namespace tact
