// Force shading: flat triangles of a smooth surface feel smooth, and real edges stay sharp.
//
// Turn     The contact force of a triangle acts along the normal interpolated between its corners instead of the facet
//          normal, if both are less than 20 degrees apart; shading fades out between 20 and 40 degrees.
// Unit     metres of the model; times the stiffness, a force.  Thread  servo, TACT_RT.
#pragma once

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

}  // namespace tact
