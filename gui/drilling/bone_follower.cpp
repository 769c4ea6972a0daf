#include "gui/drilling/bone_follower.hpp"

#include <algorithm>

namespace tact {

BoneFollower::BoneFollower(const BoneVolumeView& as_baked, std::uint64_t scene_checksum)
    : density_(as_baked.density.begin(), as_baked.density.end()),
      volume_(as_baked),
      checksum_(scene_checksum),
      seen_(as_baked.bricks.brick_count()),
      unknown_(seen_.size()),
      changed_(seen_.size()) {
    volume_.density = density_;
}

std::string BoneFollower::attach(const MappedBoneRegion& region) {
    region_ = nullptr;
    if (region.empty()) return "the controller has no bone region";
    const BoneRegionHead& head = region.head();
    const BoneBricks& b = volume_.bricks;
    if (head.scene_checksum != checksum_) return "the controller's bone is of another scene";
    const auto same = [&](int axis) {
        return head.size[axis] == b.size[static_cast<std::size_t>(axis)] &&
               head.origin_m[axis] == b.origin_m[axis];
    };
    if (head.bricks != seen_.size() || head.brick_bytes != BoneBricks::kVoxels || head.voxel_m != b.voxel_m ||
        !same(0) || !same(1) || !same(2))
        return "size, voxel size or position of the controller's bone differ from the scene";
    region_ = &region;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
        seen_[i] = region.revision(i);
        unknown_[i] = changed_[i] != 0 || seen_[i] != 0 ? 1 : 0;
    }
    return {};
}

std::span<const BrickChange> BoneFollower::follow(std::size_t most) {
    changes_.clear();
    if (region_ == nullptr) return {};
    constexpr std::size_t kVoxels = BoneBricks::kVoxels;
    most = std::min(most, seen_.size());
    if (before_.size() < most * kVoxels) {
        before_.resize(most * kVoxels);
        after_.resize(most * kVoxels);
    }
    std::size_t i = next_;
    for (std::size_t looked = 0; looked < seen_.size() && changes_.size() < most; ++looked) {
        const std::uint32_t revision = region_->revision(i);
        if (revision != seen_[i] || unknown_[i] != 0) {
            const std::size_t at = changes_.size() * kVoxels;
            const std::span after(after_.data() + at, kVoxels);
            region_->copy_brick(i, after);
            keep_to_size(i, after);
            std::uint8_t* const mine = density_.data() + i * kVoxels;
            if (!std::equal(after.begin(), after.end(), mine)) {
                std::copy_n(mine, kVoxels, before_.data() + at);
                std::copy_n(after.data(), kVoxels, mine);
                changes_.push_back(
                    {static_cast<std::uint32_t>(i), {before_.data() + at, kVoxels}, after, unknown_[i] == 0});
                changed_[i] = 1;
            }
            seen_[i] = revision;  // loaded before the copy: a later change is copied again
            unknown_[i] = 0;
        }
        i = i + 1 == seen_.size() ? 0 : i + 1;
    }
    next_ = i;
    return changes_;
}

void BoneFollower::keep_to_size(std::size_t brick, std::span<std::uint8_t> voxels) const {
    constexpr std::uint32_t kEdge = BoneBricks::kEdge;
    const auto n = volume_.bricks.bricks();
    const std::array<std::uint32_t, 3> at{static_cast<std::uint32_t>(brick % n[0]),
                                          static_cast<std::uint32_t>(brick / n[0] % n[1]),
                                          static_cast<std::uint32_t>(brick / n[0] / n[1])};
    std::array<std::uint32_t, 3> here{};  // voxels of the brick inside the volume
    for (std::size_t axis = 0; axis < 3; ++axis)
        here[axis] = std::min(kEdge, volume_.bricks.size[axis] - at[axis] * kEdge);
    if (here == std::array{kEdge, kEdge, kEdge}) return;
    std::uint8_t* v = voxels.data();
    for (std::uint32_t z = 0; z < kEdge; ++z)
        for (std::uint32_t y = 0; y < kEdge; ++y)
            for (std::uint32_t x = 0; x < kEdge; ++x, ++v)
                if (x >= here[0] || y >= here[1] || z >= here[2]) *v = 0;
}

}  // namespace tact
