#include "gui/render/arrow.hpp"

#include <algorithm>
#include <cmath>

#include "gui/render/revolve.hpp"

namespace tact {

TubeMesh build_arrow(const Eigen::Vector3f& from_a, const Eigen::Vector3f& along_a, float thickness_a,
                     const Rgb8& colour) {
    TubeMesh mesh;
    const float length = along_a.norm();
    if (!std::isfinite(length) || !(length > thickness_a)) return mesh;
    const float head = std::min(3.2F * thickness_a, 0.6F * length);
    const ProfileRing rings[] = {{0.0F, 0.0F, -1.0F},
                                 {0.0F, thickness_a, -1.0F},
                                 {0.0F, thickness_a, 0.0F},
                                 {length - head, thickness_a, 0.0F},
                                 {length - head, thickness_a, -1.0F},
                                 {length - head, 2.2F * thickness_a, -1.0F},
                                 {length - head, 2.2F * thickness_a, 0.45F},
                                 {length, 0.0F, 0.45F}};
    add_revolved(mesh, rings, from_a, along_a / length, colour);
    return mesh;
}

}  // namespace tact
