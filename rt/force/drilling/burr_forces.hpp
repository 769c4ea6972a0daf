// What a burr in bone is pushed with: penetration, elastic force, friction and impact.
//
// Source   eqs 2, 3, 13 and 14 of Agus et al. F_mu = c_mu R^2 (h / R) (m1 / m0) x omega: the print loses the power of
//          R; squared it scales as the elastic force does.
// Unit     SI. Masses are volumes of solid bone: m0 in m^3, m1 in m^4, about the ball's centre.
// Thread   any; no allocation
#pragma once

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

struct BurrLaw {
    double elastic_pa = 4e5;       // c_e
    double friction_n_s_m3 = 5e3;  // c_mu
    double impact_n_s_m3 = 1.5e5;  // c_i
    double friction_share =
        0.25;  // of the elastic force, that friction comes near and does not reach; 0: no bound
};

// x = h / R of eq. 2, x^2 - x^3 / 3 = m0 / (pi R^3): closed, exact at both ends, and rising from 0 to 2, which is a
// ball full of bone. What is more than full is taken as full.
[[nodiscard]] double penetration_of(double m0_m3, double radius_m) noexcept TACT_RT;

struct BurrForce {
    double depth = 0.0;          // h / R
    Vec3 normal = Vec3::Zero();  // away from the bone; shorter than 1 where bone is on all sides
    bool held_in = false;        // bone on all sides: the push differs from eq. 3 by more than kHeldInShare
    Wrench wrench;               // at the ball's centre
    double stiffness_n_m = 0.0;  // of the elastic force along the normal, for a flat surface
};

// c_e with which a flat surface holds a ball with 1 N at this depth, or at half its radius where that is less.
[[nodiscard]] double elastic_for(double radius_m, double depth_at_1_n_m) noexcept;

// Where bone is on all sides m1 vanishes and the normal has no direction: it shrinks to nothing as soon as m1 is less
// than a quarter of what the same mass in a cap would have, so a burr in a slot is not thrown from wall to wall. What
// is missing is taken from `way_out`, the direction it was last pushed in, from two thirds full on: pressed into
// solid bone it does not fall through. A ball that never had one feels friction and impact alone there.
[[nodiscard]] BurrForce burr_force(const BurrLaw& law, double radius_m, double m0_m3, const Vec3& m1_m4,
                                   const Vec3& velocity_m_s, const Vec3& spin_rad_s,
                                   const Vec3& way_out = Vec3::Zero()) noexcept TACT_RT;
inline constexpr double kHeldInShare = 0.005;
// The depth h / R from which on way_out counts, and from which on wholly.
inline constexpr double kWayOutFrom = 1.2, kWayOutTo = 1.7;

}  // namespace tact
