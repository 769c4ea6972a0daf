// A synthetic right temporal bone for the demo and for tests: a hard outer shell, connected air cells beneath it, the
// middle ear with its ossicles, the labyrinth in the hardest bone of the body, the facial nerve in its canal, sigmoid
// sinus, dura, carotid artery.
//
// Frame     model: x anterior, y up, z lateral (where the surgeon stands). The centre of the volume is (0, 0, 0).
// Size      the anatomy is 50 mm wide and is scaled to the width of the volume. Cells and canals scale with it.
// Density   of bone 105 (spongy) to 255 (labyrinth); soft structures are labelled and have kSoftDensity, so that a
//           burr has contact with them. Air is 0. A voxel at a surface has the fraction that is inside.
// Repeats   the same settings give the same bytes, on any number of cores.
#pragma once

#include <cstdint>

#include "ipc/base/progress.hpp"
#include "ipc/scene/bone/bone_labels.hpp"

namespace tact {

struct TemporalBone {
    std::uint32_t voxels = 256;  // along each axis, 16 to 1024
    double voxel_m = 0.2e-3;
    std::uint64_t seed = 1;  // of the cells and the roughness
};

inline constexpr std::uint8_t kSoftDensity = 40;
enum class EarPart : std::uint8_t {
    none,
    facial_nerve,
    chorda_tympani,
    sigmoid_sinus,
    dura,
    carotid_artery,
    labyrinth,
    malleus,
    incus,
    stapes
};

BoneData make_temporal_bone(const TemporalBone& settings = {}, const Progress& progress = {});

}  // namespace tact
