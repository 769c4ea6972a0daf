#include "gui/render/mouse_handle.hpp"

#include "gui/render/revolve.hpp"

namespace tact {
namespace {

constexpr float kThinPx = 1.0F, kThickPx = 1.8F, kLinePx = 1.4F, kDotPx = 5.0F;

}  // namespace

TubeMesh build_mouse_handle(const DrawnHandle& handle, const Eigen::Vector3f& at_a,
                            const Eigen::Vector3f& target_a, const Eigen::Vector3f& to_eye, float a_per_px) {
    TubeMesh mesh;
    if (!at_a.allFinite() || !target_a.allFinite() || !to_eye.allFinite() || !(a_per_px > 0.0F)) return mesh;
    const float radius = handle.radius_px * a_per_px;
    const float thick = (handle.state == HandleState::far ? kThinPx : kThickPx) * a_per_px;
    const ProfileRing ring[] = {{0.0F, radius - thick, 1.0F}, {0.0F, radius + thick, 1.0F}};
    add_revolved(mesh, ring, at_a, to_eye, kHandleColour);
    if (handle.state != HandleState::held) return mesh;
    const float dot = kDotPx * a_per_px;
    const ProfileRing disc[] = {{0.0F, 0.0F, 1.0F}, {0.0F, dot, 1.0F}};
    add_revolved(mesh, disc, target_a, to_eye, kHandleColour);
    const Eigen::Vector3f along = target_a - at_a;
    const float length = along.norm(), line = kLinePx * a_per_px;
    if (!(length > 2.0F * dot)) return mesh;
    const ProfileRing bar[] = {{0.0F, line, 0.0F}, {length, line, 0.0F}};
    add_revolved(mesh, bar, at_a, along / length, kHandleColour);
    return mesh;
}

}  // namespace tact
