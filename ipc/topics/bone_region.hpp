// The region "tact.bone": the present state of the bone that a run drills. Its size depends on the scene.
//
// Writer    tact-rt, on the servo thread: densities of a brick first, then its revision, one higher
//           (release)
// Content   BoneRegionHead, one revision per brick, the densities brick by brick; each part at a multiple
//           of 64 bytes. Order of voxels in bricks: ipc/scene/bone/bone_bricks
// Reader    checks the revisions, then copies. If a brick is written during its copy, the copy is
//           inconsistent, but its revision differs again at the next check: no change is missed
// Input     untrusted: the head is copied once, when mapped, and checked; counts must fit the sealed size.
//           Densities and revisions may have any value
// Thread    create and map off the servo thread; revision() and copy_brick() any
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>

#include "ipc/shm/region.hpp"
#include "ipc/shm/topic.hpp"

namespace tact {

struct BoneRegionHead {
    static constexpr TopicInfo kInfo{.name = "bone", .version = 1, .writer = Writer::rt};
    std::uint64_t scene_checksum;
    std::uint64_t bricks;
    std::uint32_t brick_bytes;  // a multiple of 8
    std::uint32_t size[3];      // voxels
    double voxel_m;             // edge length, model
    double origin_m[3];         // centre of voxel (0, 0, 0), model
    std::uint64_t reserved[8];  // zero
};
static_assert(std::is_trivially_copyable_v<BoneRegionHead> && sizeof(BoneRegionHead) == 128);
static_assert(offsetof(BoneRegionHead, voxel_m) == 32);

inline constexpr char kBoneRegionName[] = "tact.bone";
inline constexpr std::uint64_t kBoneRegionBricksMax = std::uint64_t{1} << 23;
inline constexpr std::uint32_t kBoneRegionBrickBytesMax = 4096;

class OwnedBoneRegion {
public:
    // Throws StartupError: no memory, or counts out of bounds. Revisions and densities are 0.
    explicit OwnedBoneRegion(const BoneRegionHead& head);
    [[nodiscard]] std::span<std::uint32_t> revisions() const;
    [[nodiscard]] std::span<std::uint8_t> densities() const;
    void mark_ready() noexcept { memory_.mark_ready(); }
    [[nodiscard]] std::uint64_t generation() const { return memory_.generation(); }
    [[nodiscard]] int fd() const { return memory_.fd(); }

private:
    BoneRegionHead head_;
    RegionMemory memory_;
};

class MappedBoneRegion {
public:
    MappedBoneRegion() = default;
    static MappedBoneRegion map(FileDescriptor fd, std::string& refusal);  // empty(): refused
    [[nodiscard]] bool empty() const { return memory_.empty(); }
    [[nodiscard]] const BoneRegionHead& head() const { return head_; }
    [[nodiscard]] std::uint64_t generation() const { return memory_.generation(); }
    // brick must be below head().bricks.
    [[nodiscard]] std::uint32_t revision(std::uint64_t brick) const noexcept;
    void copy_brick(std::uint64_t brick, std::span<std::uint8_t> to) const noexcept;  // head().brick_bytes

private:
    BoneRegionHead head_{};
    RegionMemory memory_;
};

}  // namespace tact
