// Where the parts of a made temporal bone lie: mm at full size, x front, y up, z outward to the side.
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
    // Of the whole bone as if it were solid, without its roughness; nowhere much more than the true distance.
    [[nodiscard]] static double outside(const Vec3& p);
    // Middle ear, attic and antrum.
    [[nodiscard]] static double cavity(const Vec3& p);
    // Where cells are; the rest is spongy.
    [[nodiscard]] static double cellular(const Vec3& p);
    // Whether the brain's side of the bone is nearer than the others.
    [[nodiscard]] static bool cranial(const Vec3& p);
};

}  // namespace tact
