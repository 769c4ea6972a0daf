// From the contact to the force: shading, friction cone, pace and energy of a point, a ball or a mesh tool.
//
// Push     the lift (sum of the active constraints, from the tool to the frictionless proxy) with each normal turned by
//          shading (shading.hpp). It is the normal of the force.
// Cone     friction adds a part across the push, at most the coefficient times the push. So the force is in the friction
//          cone about the push in every step, and along it without friction.
// Pace     per step, the force changes by at most kForceSteps times what the tool's displacement compresses, plus twice the
//          lag force. Push and force are blended together, then put back into the cone.
// Energy   of an excursion, from free to free: what the hand has put in, less what it got back (trapezoids between steps).
//          The springs need U, the energy of the unshaded force. Shading is no gradient and friction, edges and sampling
//          are not exact, so the account may differ from U. Above kShadedFrom of U nothing happens; from there to
//          kShadedTo shading fades out; below, the whole force is scaled by the account over kShadedTo U. Pressing
//          and withdrawing then give and take in the same proportion, so the force fades to zero with U, without a
//          step. At most kOpenJ are ever given away. More than kKeptShares U are not kept: what friction took in
//          one place is not given back in another.
// Error    off_n(): size of the difference from the full, unpaced, shaded force.
// Vec      a 3-D vector, or of a tool (displacement, radius of gyration times rotation) and (force, torque over that radius):
//          their product is work too. A tool has friction at each of its contacts: its lift is the whole way to the proxy.
// Unit     metres, newtons and joules of the world.  Thread  servo, TACT_RT
#pragma once

#include <algorithm>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

struct ContactForceSettings {
    double stiffness_n_m = 0.0, damping_n_s_m = 0.0, damped_depth_m = 1.0;
    double friction = 0.0, force_n_max = 0.0;
    double lag_m = 0.0;  // displacement of the lag force
};

template <class Vec>
class ContactForceOf {
public:
    static constexpr double kForceSteps = 2.5;
    static constexpr double kShadedFrom = 0.8, kShadedTo = 0.7;
    static constexpr double kKeptShares = 2.0;
    static constexpr double kOpenJ = 2.5e-7;

    struct Input {
        Vec lift_m = Vec::Zero(), turn_m = Vec::Zero(), rub_m = Vec::Zero();
        Vec moved_m = Vec::Zero();  // by the tool since the last step
        Vec velocity_m_s = Vec::Zero();
        double gain = 1.0;  // of the fade
    };

    explicit ContactForceOf(const ContactForceSettings& settings) : settings_(settings) {}

    void reset() noexcept TACT_RT;
    // Newtons.
    Vec step(const Input& in) noexcept TACT_RT;

    [[nodiscard]] const Vec& push_m() const noexcept TACT_RT { return push_m_; }
    [[nodiscard]] double off_n() const noexcept TACT_RT { return off_n_; }
    [[nodiscard]] double account_j() const noexcept TACT_RT { return account_j_; }

private:
    [[nodiscard]] Vec in_cone_m(const Vec& push_m, const Vec& rub_m) const noexcept TACT_RT;
    [[nodiscard]] double spring_j(double way_m) const noexcept TACT_RT;
    void pace(const Vec& push_m, const Vec& way_m, double most_m) noexcept TACT_RT;

    ContactForceSettings settings_;
    Vec push_m_ = Vec::Zero(),
        way_m_ = Vec::Zero();  // times the stiffness: normal part of the force, force
    Vec shown_n_ = Vec::Zero();
    double spring_m_ = 0.0;  // length of the unscaled force, paced
    double account_j_ = 0.0, gain_ = 0.0, off_n_ = 0.0;
};

using ContactForce = ContactForceOf<Vec3>;
using ToolContactForce = ContactForceOf<Vec6>;

}  // namespace tact
