// Positions of the parts of the synthetic temporal bone: mm at full size, x front, y up, z lateral.
#pragma once

#include <array>
#include <vector>

#include "prep/synthetic/shapes.hpp"
#include "prep/synthetic/temporal_bone.hpp"

namespace tact {

inline constexpr std::size_t kEarParts = 10;
inline constexpr double kEarMm = 50.0;

struct EarPlan {
    std::array<std::vector<shape::Bar>, kEarParts>
        part;  // by EarPart; the first is the ear canal, which is air

    EarPlan();
    // Distance to the smooth surface of the whole bone as a solid; nowhere much more than the true distance.
    [[nodiscard]] static double outside(const Vec3& p);
    // Distance to the middle ear, attic and antrum.
    [[nodiscard]] static double cavity(const Vec3& p);
    // Distance to the region of air cells; the rest is spongy.
    [[nodiscard]] static double cellular(const Vec3& p);
    // True if the cranial side of the bone is nearer than the other sides.
    [[nodiscard]] static bool cranial(const Vec3& p);
};

}  // namespace tact
