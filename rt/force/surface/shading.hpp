// Force shading: flat triangles of a smooth surface feel smooth, and real edges stay sharp.
//
// Turn     The contact force of a triangle acts along the normal interpolated between its corners instead of the facet
//          normal, if both are less than 20 degrees apart; shading fades out between 20 and 40 degrees.
// Pace     (tools that are meshes; points and balls: contact_force.hpp) Other triangles may be active in the next step, so the change of the turn per step is limited to lag_m plus
//          kTurnShare of the change of the way (tool to proxy), as long as the changes of turn and way together stay
//          within kForceSteps times the tool's displacement plus 2 lag_m.
// Unit     metres of the model; times the stiffness, a force.  Thread  servo, TACT_RT.
#pragma once

#include <algorithm>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"
#include "ipc/scene/mesh/surface_mesh.hpp"

namespace tact {

// The shading correction of one contact, added to the way from the tool to the proxy. proxy_m: centre of the ball at the
// contact. normal: unit, towards the tool. weight_m: of the contact along the normal.
[[nodiscard]] Vec3 shaded_turn_m(const SurfaceMesh& mesh, std::uint32_t triangle, const Vec3& proxy_m,
                                 const Vec3& normal, double weight_m) noexcept TACT_RT;

// The same for a facet that is touched in step after step: what depends on the triangle alone is kept.
class ShadedFacet {
public:
    [[nodiscard]] Vec3 turn_m(const SurfaceMesh& mesh, std::uint32_t triangle, const Vec3& proxy_m,
                              const Vec3& normal, double weight_m) noexcept TACT_RT;

private:
    std::uint32_t triangle_ = SurfacePoint::kNone;
    bool thin_ = true;  // no area
    Vec3 corner_m_ = Vec3::Zero(), facet_ = Vec3::Zero();
    Vec3 per_b_ = Vec3::Zero(), per_c_ = Vec3::Zero();  // gradients of the barycentric parts
    Vec3 smooth_ = Vec3::Zero(), smooth_b_ = Vec3::Zero(),
         smooth_c_ = Vec3::Zero();  // normal, and its change to b, c
};

// Vec: a 3-D vector, or a 6-D twist.
template <class Vec>
class PacedTurn {
public:
    static constexpr double kForceSteps = 2.5;
    static constexpr double kTurnShare = 0.3;

    void reset() noexcept TACT_RT {
        turn_m_.setZero();
        way_m_.setZero();
    }
    // wanted_m: the turn before rate limiting. way_m: from the tool to the proxy. gone_m: displacement of the tool since
    // the last step.
    const Vec& follow(const Vec& wanted_m, const Vec& way_m, double gone_m, double lag_m) noexcept TACT_RT {
        const double pulled = (way_m - way_m_).norm(), left = kForceSteps * gone_m + lag_m - pulled;
        const double most = lag_m + std::clamp(kTurnShare * pulled, 0.0, std::max(left, 0.0));
        const Vec change_m = wanted_m - turn_m_;
        const double change = change_m.norm();
        turn_m_ += (change > most ? most / change : 1.0) * change_m;
        way_m_ = way_m;
        return turn_m_;
    }

private:
    Vec turn_m_ = Vec::Zero(), way_m_ = Vec::Zero();
};

}  // namespace tact
