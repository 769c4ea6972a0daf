// Visible bone: the opacity of each voxel, and for each place a lower bound of the distance to bone.
//
// Solid     opacity, 0 to 255. Bone is as opaque as it is dense. A soft labelled structure (nerve, vessel, dura) has
//           the opacity of its remaining fraction, so it is as visible as bone; one invisible in the scan is shown
//           as labelled.
// Smooth    a segmented volume has voxels that are bone or not, and would show their edges as steps: its opacity is
//           weighted 1 4 6 4 1 over five voxels along each axis. A plate of one voxel stays visible; the surface of thick
//           bone lies half a voxel farther out than without
// Cells     of 4 voxels a side. 0: may hold something; k: all cells nearer than k (the largest of the three
//           differences) are empty, so a ray can skip them at once. Distances stay valid while bone is removed; bone that
//           comes back shortens them in settle().
// Surface   where the opacity, interpolated linearly between voxel centres, reaches kSurface.
// Thread    frame thread
#pragma once

#include <array>
#include <cstdint>
#include <optional>
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

    // All arguments must outlive this object; `now` changes brick by brick, reported to changed(). free_cells: of an
    // earlier field with the same `now`, because measuring a large volume takes much of a second; measured if empty
    // or of another size.
    BoneField(const BoneVolumeView& baked, const BoneLabelsView& labels, const BoneVolumeView& now,
              std::span<const std::uint8_t> free_cells = {});

    [[nodiscard]] const BoneBricks& bricks() const { return now_.bricks; }
    [[nodiscard]] bool labelled() const { return !labels_.label.empty(); }
    [[nodiscard]] std::uint8_t label(std::size_t voxel) const {
        return labels_.label.empty() ? std::uint8_t{0} : labels_.label[voxel];
    }
    // Segmented: see above. A change of a brick then changes the bricks around it.
    [[nodiscard]] bool smooth() const { return smooth_; }
    // Opacities of a brick, x fastest.
    void solids(std::uint32_t brick, std::span<std::uint8_t, BoneBricks::kVoxels> out) const;
    // Updates the cells of a brick; grown: bone came back in it, and settle() must follow before cells are used.
    void changed(std::uint32_t brick, bool grown = false);
    // Shortens the distances to bone that came back. True: some cells changed.
    bool settle();

    [[nodiscard]] const std::array<std::uint32_t, 3>& cells() const { return cells_; }
    // Radius of a ball about a centre that contains everything visible, voxels; 0: nothing.
    [[nodiscard]] double reach_voxels(const Vec3& centre) const;
    [[nodiscard]] std::span<const std::uint8_t> free_cells() const { return free_; }  // x fastest

private:
    [[nodiscard]] std::uint8_t solid(std::uint32_t x, std::uint32_t y, std::uint32_t z) const;
    [[nodiscard]] bool segmented() const;
    void as_stored(std::uint32_t brick, std::span<std::uint8_t, BoneBricks::kVoxels> out) const;
    void smoothed(std::uint32_t brick, std::span<std::uint8_t, BoneBricks::kVoxels> out) const;
    // The value of all voxels of a brick and of those around it, if there is one.
    [[nodiscard]] std::optional<std::uint8_t> one_value_around(std::uint32_t brick) const;
    [[nodiscard]] bool empty(std::uint32_t cx, std::uint32_t cy, std::uint32_t cz) const;
    void mark_own();
    void measure();

    const BoneVolumeView& baked_;
    const BoneLabelsView& labels_;
    const BoneVolumeView& now_;
    bool smooth_ = false;
    // Of each brick, when it was first asked for: kMixed, or the value of all its voxels.
    mutable std::vector<std::uint16_t> one_value_;
    std::array<std::uint32_t, 3> cells_{};
    std::vector<std::uint8_t> free_;
    std::vector<std::uint32_t> filled_, next_;  // cells that bone came back to; those at the next distance
};

}  // namespace tact
