// Puts a drilling scene together: densities, labels, distances to critical structures, and where the hand is.
//
// Place     a hand's millimetre is a bone's. The middle of the hand's space lies straight before a patch of bone that a
//           tool can be set on, near the middle (approach.hpp), kInFrontM in front of all bone that is near: a hand at
//           rest is outside and meets bone when it goes straight on.
// Fails by  StartupError; Cancelled when `progress` returns false. Nothing is written here.
// Repeats   the same input gives the same sections.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ipc/base/progress.hpp"
#include "ipc/scene/bone/bone_labels.hpp"
#include "ipc/scene/file/scene_meta.hpp"

namespace tact {

struct BoneInput {
    static constexpr double kInFrontM = 0.01;
    std::string title;
    BoneData bone;
    std::vector<std::string> note;  // lines "key: value"
};

struct BakedBone {
    SceneMeta meta{};
    std::string note;
    std::uint64_t bone_voxels = 0;  // of any density but 0
    double bone_m3 = 0.0;           // as if all of it were solid: densities / 255, summed
    std::uint32_t distance_fields = 0;
};

// The most that bone and scene take side by side, with that many distance fields; without labels: none.
double bake_bytes(const BoneBricks& bricks, bool labelled, std::size_t fields);
BakedBone bake_bone(BoneInput&& input, SceneWriter& out, const Progress& progress = {});

}  // namespace tact
