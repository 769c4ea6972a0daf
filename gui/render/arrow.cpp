#include "gui/render/arrow.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace tact {

TubeMesh build_arrow(const Eigen::Vector3f& from_a, const Eigen::Vector3f& along_a, float thickness_a,
                     const Rgb8& colour) {
    TubeMesh mesh;
    const float length = along_a.norm();
    if (!std::isfinite(length) || !(length > thickness_a)) return mesh;
    constexpr int kSides = 16;
    const Eigen::Vector3f axis = along_a / length;
    const Eigen::Vector3f u = axis.unitOrthogonal();
    const Eigen::Vector3f v = axis.cross(u);
    const float head = std::min(3.2F * thickness_a, 0.6F * length);
    // Rings along the axis: place, radius, and how much the normal leans forward.
    struct Ring {
        float at, radius, lean;
    };
    const Ring rings[] = {{0.0F, 0.0F, -1.0F},
                          {0.0F, thickness_a, -1.0F},
                          {0.0F, thickness_a, 0.0F},
                          {length - head, thickness_a, 0.0F},
                          {length - head, thickness_a, -1.0F},
                          {length - head, 2.2F * thickness_a, -1.0F},
                          {length - head, 2.2F * thickness_a, 0.45F},
                          {length, 0.0F, 0.45F}};
    for (const Ring& ring : rings) {
        for (int k = 0; k < kSides; ++k) {
            const float angle = 2.0F * std::numbers::pi_v<float> * static_cast<float>(k) / kSides;
            const Eigen::Vector3f out = std::cos(angle) * u + std::sin(angle) * v;
            const Eigen::Vector3f p = from_a + axis * ring.at + out * ring.radius;
            const Eigen::Vector3f n =
                (out * std::sqrt(1.0F - ring.lean * ring.lean) + axis * ring.lean).normalized();
            mesh.vertex.push_back(
                {{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}, {colour[0], colour[1], colour[2], 255}});
        }
    }
    for (std::uint32_t r = 0; r + 1 < std::size(rings); ++r)
        for (std::uint32_t k = 0; k < kSides; ++k) {
            const std::uint32_t a = r * kSides + k, b = r * kSides + (k + 1) % kSides;
            mesh.index.insert(mesh.index.end(), {a, b, a + kSides, b, b + kSides, a + kSides});
        }
    return mesh;
}

}  // namespace tact
