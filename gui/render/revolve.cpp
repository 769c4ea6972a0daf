#include "gui/render/revolve.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace tact {

void add_revolved(TubeMesh& mesh, std::span<const ProfileRing> rings, const Eigen::Vector3f& from_a,
                  const Eigen::Vector3f& axis, const Rgb8& colour) {
    constexpr std::uint32_t kSides = 16;
    const Eigen::Vector3f u = axis.unitOrthogonal();
    const Eigen::Vector3f v = axis.cross(u);
    const auto first = static_cast<std::uint32_t>(mesh.vertex.size());
    for (const ProfileRing& ring : rings) {
        for (std::uint32_t k = 0; k < kSides; ++k) {
            const float angle = 2.0F * std::numbers::pi_v<float> * static_cast<float>(k) / kSides;
            const Eigen::Vector3f out = std::cos(angle) * u + std::sin(angle) * v;
            const Eigen::Vector3f p = from_a + axis * ring.at_a + out * ring.radius_a;
            const float outwards = std::sqrt(std::max(1.0F - ring.lean * ring.lean, 0.0F));
            const Eigen::Vector3f n = (out * outwards + axis * ring.lean).normalized();
            mesh.vertex.push_back(
                {{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}, {colour[0], colour[1], colour[2], 255}});
        }
    }
    for (std::uint32_t r = 0; r + 1 < rings.size(); ++r)
        for (std::uint32_t k = 0; k < kSides; ++k) {
            const std::uint32_t a = first + r * kSides + k, b = first + r * kSides + (k + 1) % kSides;
            mesh.index.insert(mesh.index.end(), {a, b, a + kSides, b, b + kSides, a + kSides});
        }
}

}  // namespace tact
