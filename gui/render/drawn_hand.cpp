#include "gui/render/drawn_hand.hpp"

#include <cmath>

#include "gui/render/arrow.hpp"
#include "gui/render/revolve.hpp"

namespace tact {
namespace {

// From the tip to the hand, in tool axes: to the right, downwards, and towards the user.
const Vec3 kPenAxis = Vec3(0.52, -0.42, 0.74).normalized();

void append(TubeMesh& to, const TubeMesh& more) {
    const auto first = static_cast<std::uint32_t>(to.vertex.size());
    to.vertex.insert(to.vertex.end(), more.vertex.begin(), more.vertex.end());
    for (const std::uint32_t i : more.index) to.index.push_back(first + i);
}

void add_pen(TubeMesh& mesh, const DrawnHand& hand, const Eigen::Vector3f& tip_a, float size_a) {
    const Eigen::Vector3f axis = (hand.T_model_hand.q * kPenAxis).cast<float>().normalized();
    const float thick = 0.042F * size_a, cone = 0.16F * size_a, grip = 0.27F * size_a, end = 0.62F * size_a;
    const ProfileRing point[] = {{0.0F, 0.0F, -0.3F}, {cone, thick, -0.3F}};
    const ProfileRing held[] = {{cone, thick, 0.0F}, {grip, thick, 0.0F}};
    const ProfileRing barrel[] = {
        {grip, thick, 0.0F}, {end, 0.8F * thick, 0.0F}, {end, 0.8F * thick, 1.0F}, {end, 0.0F, 1.0F}};
    add_revolved(mesh, point, tip_a, axis, hand.pen_colour);
    add_revolved(mesh, held, tip_a, axis, hand.grip_colour);
    add_revolved(mesh, barrel, tip_a, axis, hand.pen_colour);
}

void add_wall(TubeMesh& mesh, const Eigen::Vector3f& tip_a, const Eigen::Vector3f& away, float size_a) {
    const float thick = 0.012F * size_a;
    for (const float radius : {0.10F * size_a, 0.19F * size_a}) {
        const float inner = radius - 2.0F * thick;
        const ProfileRing ring[] = {{-thick, inner, -1.0F}, {-thick, radius, -1.0F}, {-thick, radius, 0.0F},
                                    {0.0F, radius, 0.0F},   {0.0F, radius, 1.0F},    {0.0F, inner, 1.0F}};
        add_revolved(mesh, ring, tip_a, away, kTouchedWallColour);
    }
}

}  // namespace

TubeMesh build_second_hand(const DrawnHand& hand, const Eigen::Vector3f& tip_a, float size_a,
                           float arrow_a_per_n) {
    TubeMesh mesh;
    if (!tip_a.allFinite() || !(size_a > 0.0F)) return mesh;
    if (hand.pen) add_pen(mesh, hand, tip_a, size_a);
    const Eigen::Vector3f force = hand.force_world_n.cast<float>();
    const float size_n = force.norm();
    if (!std::isfinite(size_n) || size_n <= 0.0F) return mesh;
    const float length = std::min(size_n * arrow_a_per_n, 3.0F * size_a);
    append(mesh, build_arrow(tip_a, force * (length / size_n), 0.014F * size_a, hand.force_colour));
    return mesh;
}

TubeMesh build_touched_wall(const DrawnHand& hand, const Eigen::Vector3f& tip_a, float size_a) {
    TubeMesh mesh;
    const Eigen::Vector3f force = hand.force_world_n.cast<float>();
    const float size_n = force.norm();
    if (hand.at_wall && tip_a.allFinite() && std::isfinite(size_n) && size_n > 0.0F)
        add_wall(mesh, tip_a, force / size_n, size_a);
    return mesh;
}

}  // namespace tact
