// A copy of the scene's bone densities that follows the controller's drilling, brick by brick.
//
// Without a controller the copy stays as it is; initially it is the scene's. The bone of a newly found controller
// (which
// may have drilled before) is also reported as changes, with cut_now false.
// Mass     for each brick, after - before over all changes is exactly the loss of its copy; once the controller
//          rests and follow() reports no more changes, the copy equals the controller's bone.
// Hostile  a region of another scene is refused with a reason. Densities may have any value; voxels beyond the
//          volume's size stay 0.
// Thread   frame thread. follow() allocates only for more simultaneous changes than ever before.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ipc/scene/bone/bone_volume.hpp"
#include "ipc/topics/bone_region.hpp"

namespace tact {

struct BrickChange {
    std::uint32_t brick;                          // index, order of BoneBricks
    std::span<const std::uint8_t> before, after;  // BoneBricks::kVoxels each
    bool cut_now;  // since the last call; false: before the controller was found
    // Bone came back: a stroke was undone.
    [[nodiscard]] bool grown() const {
        return !std::equal(after.begin(), after.end(), before.begin(),
                           [](std::uint8_t now, std::uint8_t then) { return now <= then; });
    }
};

class BoneFollower {
public:
    BoneFollower(const BoneVolumeView& as_baked, std::uint64_t scene_checksum);

    // Follows this bone, which must stay mapped until detach() or another attach(). Returns the reason if it cannot
    // be followed, else nothing.
    std::string attach(const MappedBoneRegion& region);
    void detach() { region_ = nullptr; }

    // Copies changed bricks, at most `most` per call, round robin. Valid until the next call.
    std::span<const BrickChange> follow(std::size_t most);

    // The copy; its densities keep their address as long as the follower lives.
    [[nodiscard]] const BoneVolumeView& volume() const { return volume_; }

private:
    void keep_to_size(std::size_t brick, std::span<std::uint8_t> voxels) const;

    std::vector<std::uint8_t> density_;
    BoneVolumeView volume_;
    std::uint64_t checksum_;
    const MappedBoneRegion* region_ = nullptr;
    std::vector<std::uint32_t> seen_;    // revision copied or found
    std::vector<std::uint8_t> unknown_;  // not yet compared with the region
    std::vector<std::uint8_t> changed_;  // the copy differs from the baked bone
    std::size_t next_ = 0;               // first brick to check
    std::vector<std::uint8_t> before_, after_;
    std::vector<BrickChange> changes_;
};

}  // namespace tact
