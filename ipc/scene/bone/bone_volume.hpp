// The bone of a drilling scene: how dense each voxel is.
//
// Density  0: no bone, 1 to 255: the share of 255 of solid bone. Where the volume came from a scanner, the
//          Hounsfield units that 0 and 255 stand for are told; between them it is linear.
// Section BONE: a header of 64 bytes, then the densities in the order of BoneBricks. Read as a view on the
// mapped file, nothing is copied.
// Bounds   1 to kBoneEdgeMax voxels along an axis and kBoneBytesMax bytes in all.
// Thread   immutable; the file outlives the view.  Fails by  StartupError: every field, the length, and that
//          what lies beyond the volume's size in its last bricks is 0.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "ipc/scene/bone/bone_bricks.hpp"
#include "ipc/scene/file/scene_file.hpp"

namespace tact {

inline constexpr std::uint32_t kBoneEdgeMax = 2048;
inline constexpr std::uint64_t kBoneBytesMax = std::uint64_t{1} << 32;

struct BoneVolumeView {
    BoneBricks bricks;
    float hu_at_0 = std::numeric_limits<float>::quiet_NaN();  // both NaN where there are none
    float hu_at_255 = std::numeric_limits<float>::quiet_NaN();
    std::span<const std::uint8_t> density;  // bricks.bytes()

    [[nodiscard]] bool has_hu() const { return !std::isnan(hu_at_0); }
    // x, y, z below bricks.size.
    [[nodiscard]] std::uint8_t at(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        return density[bricks.voxel(x, y, z)];
    }
};

// What is wrong with the geometry, in words; empty: nothing. Readers, and makers before they allocate, ask it.
std::string bone_bricks_fault(const BoneBricks& bricks);

// Whether all that lies beyond the size, in the last bricks, is 0. `voxel` has bricks.bytes().
bool zero_beyond_size(const BoneBricks& bricks, std::span<const std::uint8_t> voxel);

// Throws StartupError where the view is none that could be read again.
void write_bone_volume(SceneWriter& out, const BoneVolumeView& volume);
BoneVolumeView read_bone_volume(const SceneFile& file);

}  // namespace tact
