// Where a hand begins: in front of bone that it meets when it goes straight on, away from the user.
//
// Height    of every column of voxels along z the outermost voxel that is a third solid, as a burr feels; what is
//           less dense counts only where nothing else is there.
// Choice    the place nearest to the middle of the bone's outermost plane, in all three directions, about which most
//           columns hold bone at about that height, rather an even one: a patch that a burr can be set on, not a hole, a
//           flank or a splinter. Bone that has no such place is met where it is outermost.
// Thread    one; add_row() in any order of z
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ipc/scene/bone/bone_bricks.hpp"

namespace tact {

class BoneHeights {
public:
    static constexpr std::uint8_t kFelt = 77;
    static constexpr double kPatchM = 3e-3;    // radius of the patch
    static constexpr double kFlatM = 5e-3;     // what belongs to it lies within that of its middle
    static constexpr double kCovered = 0.75;   // share of its columns
    static constexpr double kAroundM = 15e-3;  // a resting hand is in front of everything that near

    explicit BoneHeights(const BoneBricks& bricks);
    // Of bricks.size[0] voxels or more.
    void add_row(std::uint32_t y, std::uint32_t z, std::span<const std::uint8_t> row);

    struct Place {
        Vec3 surface_m = Vec3::Zero();  // model
        double front_m = 0.0;           // z of what is outermost about it
    };
    // There has to be a voxel of bone. middle_m: x and y of the middle.
    [[nodiscard]] Place place(const Vec3& middle_m) const;

private:
    static constexpr std::int32_t kNone = -1;
    [[nodiscard]] std::int32_t top(std::int64_t x, std::int64_t y) const;
    template <class F>
    void around(std::uint32_t x, std::uint32_t y, double radius_m, F column) const;

    BoneBricks bricks_;
    std::vector<std::int32_t> felt_, any_;  // z of the outermost voxel, x fastest
    bool some_felt_ = false;
};

}  // namespace tact
