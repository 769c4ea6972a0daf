// The region of the bone: its variable size, and all errors that a reader reports.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "ipc/base/error.hpp"
#include "ipc/shm/region_header.hpp"
#include "ipc/shm/topic_list.hpp"
#include "ipc/topics/bone_region.hpp"
#include "ipc/topics/regions.hpp"

namespace tact::ipc_bone_region_test {
namespace {

FileDescriptor copy_of(int fd) { return FileDescriptor(fcntl(fd, F_DUPFD_CLOEXEC, 0)); }

BoneRegionHead small_head() {
    BoneRegionHead head{};
    head.scene_checksum = 77;
    head.bricks = 6;
    head.brick_bytes = 512;
    head.size[0] = 20;
    head.size[1] = head.size[2] = 9;
    head.voxel_m = 3e-4;
    return head;
}

std::string bone_refusal_of(FileDescriptor fd) {
    std::string refusal = "not set";
    const auto region = MappedBoneRegion::map(std::move(fd), refusal);
    EXPECT_EQ(region.empty(), !refusal.empty());
    return refusal;
}

TEST(BoneRegion, a_reader_gets_the_removed_bone_and_the_scene_checksum) {
    OwnedBoneRegion owned(small_head());
    ASSERT_EQ(owned.revisions().size(), 6U);
    ASSERT_EQ(owned.densities().size(), 6U * 512);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(owned.densities().data()) % 64, 0U);
    owned.mark_ready();
    std::string refusal;
    const auto mapped = MappedBoneRegion::map(copy_of(owned.fd()), refusal);
    ASSERT_FALSE(mapped.empty()) << refusal;
    EXPECT_EQ(mapped.head().scene_checksum, 77U);
    EXPECT_EQ(mapped.head().size[0], 20U);
    EXPECT_EQ(mapped.generation(), owned.generation());
    EXPECT_EQ(mapped.revision(5), 0U);
    for (std::size_t i = 0; i < 512; ++i) owned.densities()[5 * 512 + i] = static_cast<std::uint8_t>(i);
    std::atomic_ref(owned.revisions()[5]).store(1, std::memory_order_release);
    EXPECT_EQ(mapped.revision(5), 1U);
    EXPECT_EQ(mapped.revision(4), 0U);
    std::array<std::uint8_t, 512> brick{};
    mapped.copy_brick(5, brick);
    for (std::size_t i = 0; i < 512; ++i) ASSERT_EQ(brick[i], static_cast<std::uint8_t>(i));
    mapped.copy_brick(4, brick);
    EXPECT_EQ(brick, (std::array<std::uint8_t, 512>{}));
}

TEST(BoneRegion, is_refused_until_ready_and_if_it_is_another_region) {
    OwnedBoneRegion owned(small_head());
    EXPECT_NE(bone_refusal_of(copy_of(owned.fd())).find("ready mark"), std::string::npos);
    OwnedRegion<GuiRegion> other;
    other.mark_ready();
    EXPECT_NE(bone_refusal_of(copy_of(other.fd())).find("\"tact.bone\""), std::string::npos);
    EXPECT_NE(bone_refusal_of(FileDescriptor()), "");
    owned.mark_ready();
    std::string refusal;
    EXPECT_TRUE(MappedRegion<GuiRegion>::map(copy_of(owned.fd()), refusal).empty());
}

TEST(BoneRegion, counts_out_of_range_are_refused) {
    BoneRegionHead head = small_head();
    head.bricks = 0;
    EXPECT_THROW(OwnedBoneRegion{head}, StartupError);
    head.bricks = kBoneRegionBricksMax + 1;
    EXPECT_THROW(OwnedBoneRegion{head}, StartupError);
    head = small_head();
    head.brick_bytes = 12;
    EXPECT_THROW(OwnedBoneRegion{head}, StartupError);
}

// A file with all seals and any header, size and content length.
struct ForgedBone {
    BoneRegionHead head = small_head();
    std::uint64_t content = 128 + 64 + 6 * 512;
    std::int64_t more_file = 0;

    [[nodiscard]] FileDescriptor made() const {
        FileDescriptor fd(memfd_create("forged", MFD_CLOEXEC | MFD_ALLOW_SEALING));
        const auto bytes =
            static_cast<off_t>(static_cast<std::int64_t>(kRegionHeaderBytes + content) + more_file);
        const RegionHeader header =
            make_region_header({kBoneRegionName, TopicList<BoneRegionHead>::hash(), content}, 99);
        std::vector<char> start(kRegionHeaderBytes + sizeof head);
        std::memcpy(start.data(), &header, sizeof header);
        std::memcpy(start.data() + sizeof header, &kRegionReady, sizeof kRegionReady);
        std::memcpy(start.data() + kRegionHeaderBytes, &head, sizeof head);
        EXPECT_GT(pwrite(fd.get(), start.data(), start.size(), 0), 0);
        EXPECT_EQ(ftruncate(fd.get(), bytes), 0);
        EXPECT_EQ(
            fcntl(fd.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_FUTURE_WRITE | F_SEAL_SEAL), 0);
        return fd;
    }
};

TEST(BoneRegion, forged_counts_are_refused_with_both_values) {
    EXPECT_EQ(bone_refusal_of(ForgedBone{}.made()), "");
    struct Case {
        std::function<void(ForgedBone&)> spoil;
        std::vector<std::string> words;
    };
    const std::vector<Case> cases = {
        {[](ForgedBone& f) { f.head.bricks = 7; }, {"content size is 3264", "3776"}},
        {[](ForgedBone& f) { f.head.bricks = 0; }, {"number of bricks is 0"}},
        {[](ForgedBone& f) { f.head.bricks = ~std::uint64_t{0}; }, {"number of bricks", "8388608"}},
        {[](ForgedBone& f) { f.head.brick_bytes = 4097; }, {"size of a brick is 4097", "4096"}},
        {[](ForgedBone& f) { f.head.brick_bytes = 0; }, {"size of a brick is 0"}},
        {[](ForgedBone& f) { f.content -= 8; }, {"content size is 3256", "3264"}},
        {[](ForgedBone& f) { f.content = 64; }, {"content size is 64", "128"}},
        {[](ForgedBone& f) { f.more_file = -8; }, {"file size", "3512", "3520"}},
        {[](ForgedBone& f) { f.more_file = 4096; }, {"file size", "7616", "3520"}},
    };
    for (const Case& c : cases) {
        ForgedBone f;
        c.spoil(f);
        const std::string refusal = bone_refusal_of(f.made());
        EXPECT_NE(refusal.find("region tact.bone"), std::string::npos) << refusal;
        for (const std::string& word : c.words)
            EXPECT_NE(refusal.find(word), std::string::npos) << word << " in: " << refusal;
    }
}

}  // namespace
}  // namespace tact::ipc_bone_region_test
