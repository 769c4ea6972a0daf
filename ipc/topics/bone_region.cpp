#include "ipc/topics/bone_region.hpp"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <new>

#include "ipc/base/error.hpp"
#include "ipc/shm/topic_list.hpp"
#include "ipc/shm/words.hpp"

namespace tact {
namespace {

constexpr std::uint64_t kPart = 64;

constexpr std::uint64_t whole_parts(std::uint64_t bytes) { return (bytes + kPart - 1) / kPart * kPart; }

struct BonePlaces {  // bytes from the start of the content
    explicit BonePlaces(const BoneRegionHead& head)
        : densities(sizeof(BoneRegionHead) + whole_parts(head.bricks * sizeof(std::uint32_t))),
          end(densities + head.bricks * head.brick_bytes) {}
    static constexpr std::uint64_t kRevisions = sizeof(BoneRegionHead);
    std::uint64_t densities, end;
};

std::string bone_head_fault(const BoneRegionHead& head) {
    if (head.bricks == 0 || head.bricks > kBoneRegionBricksMax)
        return "the number of bricks is " + std::to_string(head.bricks) + ", expected 1 to " +
               std::to_string(kBoneRegionBricksMax);
    if (head.brick_bytes == 0 || head.brick_bytes > kBoneRegionBrickBytesMax || head.brick_bytes % 8 != 0)
        return "the size of a brick is " + std::to_string(head.brick_bytes) +
               ", expected a multiple of 8 up to " + std::to_string(kBoneRegionBrickBytesMax);
    return {};
}

RegionIdentity bone_identity() {
    return {
        kBoneRegionName, TopicList<BoneRegionHead>::hash(), sizeof(BoneRegionHead),
        sizeof(BoneRegionHead) + kBoneRegionBricksMax * (kBoneRegionBrickBytesMax + sizeof(std::uint32_t))};
}

std::byte* content_of(const RegionMemory& memory) { return static_cast<std::byte*>(memory.content()); }

}  // namespace

OwnedBoneRegion::OwnedBoneRegion(const BoneRegionHead& head) : head_(head) {
    if (const std::string fault = bone_head_fault(head); !fault.empty())
        throw StartupError(std::string("create region ") + kBoneRegionName, fault, "crop the volume");
    RegionIdentity identity = bone_identity();
    identity.bytes = BonePlaces(head).end;
    identity.bytes_most = 0;
    memory_ = RegionMemory::create(identity);
    auto* const shared = new (memory_.content()) SharedWords<BoneRegionHead>;
    shared->store(head);
}

std::span<std::uint32_t> OwnedBoneRegion::revisions() const {
    return {reinterpret_cast<std::uint32_t*>(content_of(memory_) + BonePlaces::kRevisions), head_.bricks};
}

std::span<std::uint8_t> OwnedBoneRegion::densities() const {
    return {reinterpret_cast<std::uint8_t*>(content_of(memory_) + BonePlaces(head_).densities),
            head_.bricks * head_.brick_bytes};
}

MappedBoneRegion MappedBoneRegion::map(FileDescriptor fd, std::string& refusal) {
    MappedBoneRegion m;
    m.memory_ = RegionMemory::map(static_cast<FileDescriptor&&>(fd), bone_identity(), refusal);
    if (m.memory_.empty()) return {};
    static_cast<const SharedWords<BoneRegionHead>*>(m.memory_.content())->load(m.head_);
    std::string fault = bone_head_fault(m.head_);
    if (fault.empty() && BonePlaces(m.head_).end != m.memory_.content_bytes())
        fault = "the content size is " + std::to_string(m.memory_.content_bytes()) +
                ", its header requires " + std::to_string(BonePlaces(m.head_).end);
    if (fault.empty()) return m;
    refusal = std::string("region ") + kBoneRegionName + ": " + fault;
    return {};
}

// std::atomic_ref requires non-const memory; a load writes nothing.
std::uint32_t MappedBoneRegion::revision(std::uint64_t brick) const noexcept {
    auto* const all = reinterpret_cast<std::uint32_t*>(content_of(memory_) + BonePlaces::kRevisions);
    return std::atomic_ref(all[brick]).load(std::memory_order_acquire);  // pairs with the writer's release
}

void MappedBoneRegion::copy_brick(std::uint64_t brick, std::span<std::uint8_t> to) const noexcept {
    auto* const from = reinterpret_cast<std::uint64_t*>(content_of(memory_) + BonePlaces(head_).densities +
                                                        brick * head_.brick_bytes);
    const std::size_t words = std::min<std::size_t>(to.size(), head_.brick_bytes) / sizeof(std::uint64_t);
    for (std::size_t i = 0; i < words; ++i) {
        const std::uint64_t w = std::atomic_ref(from[i]).load(std::memory_order_relaxed);
        std::memcpy(to.data() + i * sizeof w, &w, sizeof w);
    }
}

}  // namespace tact
