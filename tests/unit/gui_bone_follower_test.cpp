// The window's copy of the bone: each change is reported exactly once.
#include <fcntl.h>
#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "gui/drilling/bone_follower.hpp"

namespace tact::gui_bone_follower_test {
namespace {

constexpr std::size_t kVoxels = BoneBricks::kVoxels;

// The bone of a scene and a controller that drills it.
struct DrilledBone {
    explicit DrilledBone(std::array<std::uint32_t, 3> size = {24, 16, 16}) {
        bricks.size = size;
        bricks.voxel_m = 3e-4;
        density.assign(bricks.bytes(), 200);
        region.emplace(head());
        std::copy(density.begin(), density.end(), region->densities().begin());
        region->mark_ready();
        mapped = map();
    }
    [[nodiscard]] BoneRegionHead head() const {
        BoneRegionHead h{};
        h.scene_checksum = 5;
        h.bricks = bricks.brick_count();
        h.brick_bytes = kVoxels;
        for (std::size_t i = 0; i < 3; ++i) h.size[i] = bricks.size[i];
        h.voxel_m = bricks.voxel_m;
        return h;
    }
    [[nodiscard]] MappedBoneRegion map() const {
        std::string refusal;
        return MappedBoneRegion::map(FileDescriptor(fcntl(region->fd(), F_DUPFD_CLOEXEC, 0)), refusal);
    }
    void cut(std::size_t brick, std::size_t voxel, std::uint8_t to) const {
        region->densities()[brick * kVoxels + voxel] = to;
        std::atomic_ref revision(region->revisions()[brick]);
        revision.store(revision.load() + 1, std::memory_order_release);
    }
    [[nodiscard]] BoneVolumeView view() const {
        BoneVolumeView v;
        v.bricks = bricks;
        v.density = density;
        return v;
    }
    BoneBricks bricks;
    std::vector<std::uint8_t> density;
    std::optional<OwnedBoneRegion> region;
    MappedBoneRegion mapped;
};

long long levels(std::span<const std::uint8_t> voxels) {
    return std::accumulate(voxels.begin(), voxels.end(), 0LL);
}

TEST(BoneFollower, without_a_controller_it_is_the_bone_of_the_scene) {
    const DrilledBone bone;
    BoneFollower follower(bone.view(), 5);
    EXPECT_TRUE(follower.follow(100).empty());
    EXPECT_EQ(levels(follower.volume().density), levels(bone.density));
    EXPECT_EQ(follower.volume().bricks.size, bone.bricks.size);
}

TEST(BoneFollower, reports_each_cut_once_with_before_and_after) {
    const DrilledBone bone;
    BoneFollower follower(bone.view(), 5);
    ASSERT_EQ(follower.attach(bone.mapped), "");
    EXPECT_TRUE(follower.follow(100).empty());
    bone.cut(3, 17, 120);
    bone.cut(3, 18, 0);
    bone.cut(7, 0, 199);
    const auto told = follower.follow(100);
    ASSERT_EQ(told.size(), 2U);
    EXPECT_EQ(told[0].brick, 3U);
    EXPECT_TRUE(told[0].cut_now);
    EXPECT_EQ(told[0].before[17], 200);
    EXPECT_EQ(told[0].after[17], 120);
    EXPECT_EQ(told[0].after[18], 0);
    EXPECT_EQ(told[1].brick, 7U);
    EXPECT_EQ(follower.volume().density[3 * kVoxels + 17], 120);
    EXPECT_TRUE(follower.follow(100).empty());
    bone.cut(3, 17, 119);
    const auto again = follower.follow(100);
    ASSERT_EQ(again.size(), 1U);
    EXPECT_EQ(again[0].before[17], 120);
}

TEST(BoneFollower, all_bricks_are_reached_with_one_brick_per_call) {
    const DrilledBone bone;
    BoneFollower follower(bone.view(), 5);
    ASSERT_EQ(follower.attach(bone.mapped), "");
    std::mt19937 random(4);
    long long told = 0, cut = 0;
    for (int step = 0; step < 400; ++step) {
        const std::size_t brick =
            step % 2 == 0 ? 0 : random() % bone.bricks.brick_count();  // brick 0 is cut in every other step
        const std::size_t voxel = random() % kVoxels;
        const std::uint8_t now = bone.region->densities()[brick * kVoxels + voxel];
        if (step < 300 && now > 20) {
            bone.cut(brick, voxel, static_cast<std::uint8_t>(now - 20));
            cut += 20;
        }
        const auto changes = follower.follow(1);
        ASSERT_LE(changes.size(), 1U);
        for (const BrickChange& c : changes) told += levels(c.before) - levels(c.after);
    }
    EXPECT_EQ(told, cut);
    EXPECT_EQ(levels(follower.volume().density), levels(bone.region->densities()));
}

TEST(BoneFollower, earlier_cuts_are_reported_as_not_new) {
    const DrilledBone bone;
    bone.cut(2, 5, 0);
    BoneFollower follower(bone.view(), 5);
    ASSERT_EQ(follower.attach(bone.mapped), "");
    bone.cut(4, 1, 0);
    const auto told = follower.follow(100);
    ASSERT_EQ(told.size(), 2U);
    EXPECT_FALSE(told[0].cut_now);
    EXPECT_EQ(told[0].after[5], 0);
    EXPECT_EQ(told[1].brick, 4U);
    EXPECT_TRUE(told[1].cut_now);
    bone.cut(2, 6, 0);
    const auto later = follower.follow(100);
    ASSERT_EQ(later.size(), 1U);
    EXPECT_TRUE(later[0].cut_now);
}

TEST(BoneFollower, another_controller_restores_the_bone) {
    const DrilledBone first, second;
    BoneFollower follower(first.view(), 5);
    ASSERT_EQ(follower.attach(first.mapped), "");
    first.cut(1, 9, 10);
    follower.follow(100);
    follower.detach();
    first.cut(0, 0, 0);
    EXPECT_TRUE(follower.follow(100).empty());
    EXPECT_EQ(follower.volume().density[kVoxels + 9], 10) << "the last state is kept";
    ASSERT_EQ(follower.attach(second.mapped), "");
    const auto told = follower.follow(100);
    ASSERT_EQ(told.size(), 1U);
    EXPECT_FALSE(told[0].cut_now);
    EXPECT_EQ(told[0].after[9], 200);
    EXPECT_EQ(levels(follower.volume().density), levels(second.density));
}

TEST(BoneFollower, a_region_of_another_scene_is_refused) {
    const DrilledBone bone, other({24, 24, 16});
    BoneFollower follower(bone.view(), 6);
    EXPECT_NE(follower.attach(bone.mapped).find("another scene"), std::string::npos);
    BoneFollower smaller(bone.view(), 5);
    EXPECT_NE(smaller.attach(other.mapped).find("size"), std::string::npos);
    EXPECT_NE(smaller.attach(MappedBoneRegion{}), "");
    other.cut(0, 0, 0);
    EXPECT_TRUE(smaller.follow(100).empty());
}

TEST(BoneFollower, voxels_beyond_the_size_stay_zero) {
    DrilledBone bone({20, 9, 9});  // 3 x 2 x 2 bricks, most of them partly filled
    for (std::size_t b = 0; b < bone.bricks.brick_count(); ++b)
        for (std::size_t v = 0; v < kVoxels; ++v) bone.cut(b, v, 255);
    std::fill(bone.density.begin(), bone.density.end(), std::uint8_t{0});
    BoneFollower follower(bone.view(), 5);
    ASSERT_EQ(follower.attach(bone.mapped), "");
    EXPECT_EQ(follower.follow(100).size(), 12U);
    EXPECT_EQ(levels(follower.volume().density), 255LL * 20 * 9 * 9);
    EXPECT_TRUE(zero_beyond_size(follower.volume().bricks, follower.volume().density));
}

}  // namespace
}  // namespace tact::gui_bone_follower_test
