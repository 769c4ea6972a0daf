// What was drilled out of a bone, as surfaces and numbers, and how far two cavities differ.
//
// Taken    a voxel of bone (kBoneLeast and above, as baked) of which half or more is gone. Air cells are no bone and belong
//          to no cavity.
// Distance from each voxel at the border of one cavity to the nearest one at the border of the other, both ways; exact
//          between voxel centres
// Frame    surfaces in model metres
// Thread   any
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ipc/base/progress.hpp"
#include "ipc/scene/bone/bone_volume.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

inline constexpr std::uint8_t kBoneLeast = 26;  // a tenth of solid bone
// As the window draws it.
inline constexpr double kBoneSurface = 77.0;

// In the order of BoneBricks: 1 where taken. baked and now: bricks.bytes().
std::vector<std::uint8_t> taken_voxels(std::span<const std::uint8_t> baked,
                                       std::span<const std::uint8_t> now);

struct CavityVolumes {
    double removed_mm3 = 0.0;  // solid bone that is gone, by its density
    double cavity_mm3 = 0.0;   // of the voxels that were taken
};
CavityVolumes cavity_volumes(const BoneVolumeView& baked, std::span<const std::uint8_t> now);

// The surface of the bone that is left, and of what was taken. Closed also at the border of the volume.
TriangleMesh bone_surface(const BoneVolumeView& now, const Progress& progress = {});
TriangleMesh cavity_surface(const BoneVolumeView& baked, std::span<const std::uint8_t> now,
                            const Progress& progress = {});

struct CavityDifference {
    double a_mm3 = 0.0, b_mm3 = 0.0, both_mm3 = 0.0;
    std::optional<double> dice;                         // none: both are empty
    std::optional<double> mean_mm, p95_mm, largest_mm;  // distances; none: one is empty
};
CavityDifference compare_cavities(const BoneBricks& bricks, std::span<const std::uint8_t> a,
                                  std::span<const std::uint8_t> b);

// Signed distance (mm) of points (model, metres) from the border of a cavity: above 0 outside of it.
std::vector<float> distances_from(const BoneBricks& bricks, std::span<const std::uint8_t> cavity,
                                  std::span<const float> position_m);

}  // namespace tact
