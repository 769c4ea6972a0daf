// The bone as it is drilled: a copy of the scene's densities that follows the controller's, brick by brick.
//
// Without a controller the copy stays as it is; at first it is the scene's. What a controller's bone is when it is found
// (another one may have drilled before, or this one for a while) is told as changes as well, with cut_now false.
// Mass     of every brick, after - before over all changes is what its copy has lost, exactly; once the controller
//          rests and follow() tells nothing more, the copy is the controller's bone.
// Hostile  a region of another scene is refused in words. Densities may be any; what lies beyond the volume's size
//          stays 0.
// Thread   frame thread. follow() allocates where more is changed at once than ever before.
#pragma once

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
    bool cut_now;  // since the last look; false: it was so when the controller was found
};

class BoneFollower {
public:
    BoneFollower(const BoneVolumeView& as_baked, std::uint64_t scene_checksum);

    // From now on this bone, which stays where it is until detach() or another attach(). Returns why it cannot be
    // followed, or nothing.
    std::string attach(const MappedBoneRegion& region);
    void detach() { region_ = nullptr; }

    // Copies bricks that changed, `most` at a call, in turn. Valid until the next call.
    std::span<const BrickChange> follow(std::size_t most);

    // The copy; its densities stay where they are as long as the follower does.
    [[nodiscard]] const BoneVolumeView& volume() const { return volume_; }

private:
    void keep_to_size(std::size_t brick, std::span<std::uint8_t> voxels) const;

    std::vector<std::uint8_t> density_;
    BoneVolumeView volume_;
    std::uint64_t checksum_;
    const MappedBoneRegion* region_ = nullptr;
    std::vector<std::uint32_t> seen_;    // revision that was copied, or found
    std::vector<std::uint8_t> unknown_;  // what the region holds was not looked at yet
    std::vector<std::uint8_t> changed_;  // the copy is not as baked
    std::size_t next_ = 0;               // brick to look at first
    std::vector<std::uint8_t> before_, after_;
    std::vector<BrickChange> changes_;
};

}  // namespace tact
