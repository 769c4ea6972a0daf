// Start position of the hand: in front of bone that it meets when it moves straight ahead, away from the user (-z).
//
// Height    of a column of voxels along z: the outermost voxel that is solid enough for a burr (density >= kSolid).
//           Lower densities count only if the volume has no such voxel.
// Choice    the place nearest to the middle of the bone's outermost plane, in all three directions, around which most
//           columns hold bone at about the same height; even patches are preferred. A burr can be set on such a patch,
//           but not on a hole, a flank or a splinter. If there is no such place, the outermost bone is used.
// Thread    one; add_row() takes the rows in any order.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ipc/scene/bone/bone_bricks.hpp"

namespace tact {

class BoneHeights {
public:
    static constexpr std::uint8_t kSolid = 77;
    static constexpr double kPatchM = 3e-3;    // radius of the patch
    static constexpr double kFlatM = 5e-3;     // columns of the patch lie within this height of its middle
    static constexpr double kCovered = 0.75;   // fraction of the patch's columns that must do so
    static constexpr double kAroundM = 15e-3;  // a resting hand is in front of all bone within this radius

    explicit BoneHeights(const BoneBricks& bricks);
    // `row` holds bricks.size[0] voxels or more.
    void add_row(std::uint32_t y, std::uint32_t z, std::span<const std::uint8_t> row);

    struct Place {
        Vec3 surface_m = Vec3::Zero();  // model frame
        double front_m = 0.0;           // z of the outermost voxel around it
    };
    // The volume must hold a voxel of bone. middle_m: x and y of the middle (model frame).
    [[nodiscard]] Place place(const Vec3& middle_m) const;

private:
    static constexpr std::int32_t kNone = -1;
    [[nodiscard]] std::int32_t top(std::int64_t x, std::int64_t y) const;
    template <class F>
    void around(std::uint32_t x, std::uint32_t y, double radius_m, F column) const;

    BoneBricks bricks_;
    std::vector<std::int32_t> solid_, any_;  // z of the outermost voxel, x fastest
    bool some_solid_ = false;
};

}  // namespace tact
