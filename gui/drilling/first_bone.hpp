// Where a line first meets bone.
//
// Thread   any; no allocation
#pragma once

#include <optional>

#include "ipc/scene/bone/bone_volume.hpp"

namespace tact {

// Model metres. way: of any length. The first place along it, in steps of half a voxel, whose voxel is at least half solid.
// None: the line misses the volume or its bone, or is not a number.
[[nodiscard]] std::optional<Vec3> first_bone(const BoneVolumeView& volume, const Vec3& from_m,
                                             const Vec3& way);

}  // namespace tact
