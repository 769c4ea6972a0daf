// The bytes of a scene file of drilling: one block of bone, 1 m of the model is 1 m of the world.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>

#include "ipc/scene/bone/bone_volume.hpp"
#include "ipc/scene/file/scene_meta.hpp"

namespace tact {

inline SceneWriter bone_scene(const BoneBricks& bricks, std::span<const std::uint8_t> density) {
    BoneVolumeView volume;
    volume.bricks = bricks;
    volume.density = density;
    SceneMeta meta{};
    meta.kind = SceneKind::drilling;
    meta.world_per_model = 1.0;
    std::strcpy(meta.title, "a block");
    SceneWriter out;
    write_meta(out, meta, "made by a test\n");
    write_bone_volume(out, volume);
    return out;
}

}  // namespace tact
