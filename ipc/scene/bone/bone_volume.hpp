// The bone of a drilling scene: the density of each voxel.
//
// Density  0: no bone, 1 to 255: fraction of solid bone, times 255. For a volume from a scanner, the
//          Hounsfield units of 0 and 255 are stored; values between them are linear.
// Section  BONE: a header of 64 bytes, then the densities in the order of BoneBricks. Read as a view of the
//          mapped file, without a copy.
// Bounds   1 to kBoneEdgeMax voxels along an axis and kBoneBytesMax bytes in all
// Thread   immutable; the file outlives the view
// Errors   StartupError: an invalid field or length, or a non-zero voxel beyond the volume's size in its
//          last bricks
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
    float hu_at_0 = std::numeric_limits<float>::quiet_NaN();  // both NaN: unknown
    float hu_at_255 = std::numeric_limits<float>::quiet_NaN();
    std::span<const std::uint8_t> density;  // bricks.bytes()

    [[nodiscard]] bool has_hu() const { return !std::isnan(hu_at_0); }
    // x, y, z below bricks.size.
    [[nodiscard]] std::uint8_t at(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        return density[bricks.voxel(x, y, z)];
    }
};

// The fault of the geometry as text; empty: none. For readers, and for writers before they allocate.
std::string bone_bricks_fault(const BoneBricks& bricks);

// True if all voxels beyond the size, in the last bricks, are 0. `voxel` has bricks.bytes().
bool zero_beyond_size(const BoneBricks& bricks, std::span<const std::uint8_t> voxel);

// Throws StartupError for a view that could not be read again.
void write_bone_volume(SceneWriter& out, const BoneVolumeView& volume);
BoneVolumeView read_bone_volume(const SceneFile& file);

}  // namespace tact
