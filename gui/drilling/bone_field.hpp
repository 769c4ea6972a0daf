// What of a bone volume is seen: how solid each voxel is to the eye, and how far from bone each place is at least.
//
// Solid     0 to 255. Bone is as solid as it is dense. A labelled structure that is soft (nerve, vessel, dura) is solid by
//           the share of it that is left, so it is seen as clearly as bone; what a scan shows nothing of stays as labelled.
// Cells     of 4 voxels a side. 0: there may be something; k: all cells nearer than k (the largest of the three differences)
//           are empty, so a ray may leave them at once. Bone only goes: distances stay true while it is drilled.
// Surface   where solid, interpolated linearly between voxel centres, reaches kSurface.
// Thread    frame thread
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ipc/scene/bone/bone_labels.hpp"
#include "ipc/scene/bone/bone_volume.hpp"

namespace tact {

[[nodiscard]] constexpr std::uint8_t solid_of(std::uint8_t density, std::uint8_t baked,
                                              std::uint8_t label) noexcept {
    constexpr std::uint8_t kSoft = 128;
    if (label == 0 || baked >= kSoft) return density;
    if (baked == 0) return 255;
    return static_cast<std::uint8_t>(density >= baked ? 255U : 255U * density / baked);
}

class BoneField {
public:
    static constexpr std::uint32_t kCell = 4;
    static constexpr std::uint8_t kSurface = 77;

    // All must outlive it; `now` changes brick by brick, told by changed(). free_cells: of one made before for the same
    // `now`, as measuring a large volume takes a good part of a second; of another size, or none: they are measured.
    BoneField(const BoneVolumeView& baked, const BoneLabelsView& labels, const BoneVolumeView& now,
              std::span<const std::uint8_t> free_cells = {});

    [[nodiscard]] const BoneBricks& bricks() const { return now_.bricks; }
    [[nodiscard]] bool labelled() const { return !labels_.label.empty(); }
    [[nodiscard]] std::uint8_t label(std::size_t voxel) const {
        return labels_.label.empty() ? std::uint8_t{0} : labels_.label[voxel];
    }
    // Of a brick, x fastest.
    void solids(std::uint32_t brick, std::span<std::uint8_t, BoneBricks::kVoxels> out) const;
    // Its cells, as they are now. False: there is bone where there was none, so all distances are measured anew.
    bool changed(std::uint32_t brick);

    [[nodiscard]] const std::array<std::uint32_t, 3>& cells() const { return cells_; }
    // Of a ball about a place, voxels, that holds all that may be seen; 0: nothing.
    [[nodiscard]] double reach_voxels(const Vec3& centre) const;
    [[nodiscard]] std::span<const std::uint8_t> free_cells() const { return free_; }  // x fastest

private:
    [[nodiscard]] std::uint8_t solid(std::uint32_t x, std::uint32_t y, std::uint32_t z) const;
    [[nodiscard]] bool empty(std::uint32_t cx, std::uint32_t cy, std::uint32_t cz) const;
    void mark_own();
    void measure();

    const BoneVolumeView& baked_;
    const BoneLabelsView& labels_;
    const BoneVolumeView& now_;
    std::array<std::uint32_t, 3> cells_{};
    std::vector<std::uint8_t> free_;
};

}  // namespace tact
