// Force shading: a smooth surface of flat triangles feels smooth, and an edge stays one.
//
// Turn     what holds the tool at a touched place pushes along the normal that is interpolated between the triangle's
//          corners instead of its own, where both are less than 20 degrees apart; not at all where they are more than 40
//          degrees apart, and by a share of it between.
// Pace     other triangles may hold the tool in the next step, so the turn changes by glide_m a step, and by kTurnShare of
//          what the way from the tool to the proxy changed by besides, as far as both together stay within kForceSteps
//          times what the tool went, and two glides.
// Unit     metres of the model: times the stiffness it is a force.  Thread  servo, TACT_RT.
#pragma once

#include <algorithm>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"
#include "ipc/scene/mesh/surface_mesh.hpp"

namespace tact {

// What a place adds to the way from the tool to the proxy. proxy_m: the centre of the ball there. normal: unit, towards
// the tool, along which the triangle pushes by weight_m.
[[nodiscard]] Vec3 shaded_turn_m(const SurfaceMesh& mesh, std::uint32_t triangle, const Vec3& proxy_m,
                                 const Vec3& normal, double weight_m) noexcept TACT_RT;

// Vec: three lengths, or a twist of six.
template <class Vec>
class PacedTurn {
public:
    static constexpr double kForceSteps = 2.5;
    static constexpr double kTurnShare = 0.3;

    void reset() noexcept TACT_RT {
        turn_m_.setZero();
        way_m_.setZero();
    }
    // wanted_m: the turn without a pace. way_m: from the tool to the proxy. gone_m: by the tool, since the last step.
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
