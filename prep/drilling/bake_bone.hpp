// Bakes a drilling scene: densities, labels, distances to critical structures, and the start of the hand.
//
// Place     scale 1: one millimetre of the hand is one millimetre of bone. The centre of the hand's workspace lies
//           in front of a patch of bone near the middle (approach.hpp), kInFrontM in front of all bone near it: a hand
//           at rest is outside the bone and meets bone when it moves straight ahead.
// Fails by  StartupError; Cancelled when `progress` returns false. Writes no file.
// Repeats   the same input gives the same sections.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ipc/base/progress.hpp"
#include "ipc/scene/bone/bone_labels.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "prep/volume/scan.hpp"

namespace tact {

struct BoneInput {
    static constexpr double kInFrontM = 0.01;
    std::string title;
    BoneData bone;
    std::vector<std::string> note;            // lines "key: value"
    std::vector<ScanLabel> table;             // the structures by the file's labels or colours
    std::vector<std::uint64_t> table_voxels;  // of each
};

struct BakedBone {
    SceneMeta meta{};
    std::string note;
    std::uint64_t bone_voxels = 0;  // of density above 0
    double bone_m3 = 0.0;           // solid-equivalent volume: sum of densities / 255
    std::uint32_t distance_fields = 0;
};

// Largest memory that bone and scene need together, with `fields` distance fields (0 without labels).
double bake_bytes(const BoneBricks& bricks, bool labelled, std::size_t fields);
BakedBone bake_bone(BoneInput&& input, SceneWriter& out, const Progress& progress = {});

}  // namespace tact
