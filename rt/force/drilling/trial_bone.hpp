// Bone in which a drill's first contact is tried (drill_rehearsal.hpp): solid, or a copy of a scene's own.
//
// Why      what a burr cuts, and how many blocks of its surface are partly bone and looked at in halves, depend on the bone
// Place    of a copy: under the column with bone that is nearest to the middle of the volume, from above
// Frame    metres of the world, its axes those of the model. A ball of the burr's radius above the origin touches the bone
//          with its lowest point at z = 0
// Thread   any but the servo: allocates. Nothing may change the scene's bone meanwhile
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ipc/scene/bone/bone_bricks.hpp"

namespace tact {

struct TrialBone {
    BoneBricks bricks;
    std::vector<std::uint8_t> density;
};

// As wide as a burr's pocket in it. voxel_m: edge of a voxel.
[[nodiscard]] TrialBone solid_bone(double radius_m, double voxel_m);
// Of a volume, so deep below the place of contact. Solid where the volume has no bone. voxel_m: in the world.
[[nodiscard]] TrialBone bone_of(const BoneBricks& bricks, std::span<const std::uint8_t> density,
                                double radius_m, double depth_m, double voxel_m);

}  // namespace tact
