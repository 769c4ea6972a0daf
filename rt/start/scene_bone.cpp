#include "rt/start/scene_bone.hpp"

#include <algorithm>

#include "ipc/scene/bone/bone_volume.hpp"

namespace tact {

SceneBone::SceneBone(const SceneFile& scene) {
    const BoneVolumeView volume = read_bone_volume(scene);
    const BoneBricks& b = volume.bricks;
    region_.emplace(BoneRegionHead{.scene_checksum = scene.checksum(),
                                   .bricks = b.brick_count(),
                                   .brick_bytes = static_cast<std::uint32_t>(BoneBricks::kVoxels),
                                   .size = {b.size[0], b.size[1], b.size[2]},
                                   .voxel_m = b.voxel_m,
                                   .origin_m = {b.origin_m.x(), b.origin_m.y(), b.origin_m.z()},
                                   .reserved = {}});
    std::copy(volume.density.begin(), volume.density.end(), region_->densities().begin());
    bone_.emplace(b, region_->densities(), region_->revisions());
    region_->mark_ready();
}

}  // namespace tact
