// The window's reader of the region "tact.bone", with an arbitrary controller. The input bytes are the region as found,
// including the header, and writes into it between two reads.
//
// First byte   0: map the bytes unchanged. Otherwise fix the header and its counts first, so that the later code is reached
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <numeric>

#include "gui/drilling/bone_follower.hpp"
#include "ipc/shm/region_header.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tact::fuzz {
namespace {

constexpr std::uint64_t kChecksum = 7;
constexpr std::size_t kVoxels = BoneBricks::kVoxels;
constexpr std::size_t kBytesMost = 1 << 16;

BoneBricks scene_bricks() { return {.size = {20, 9, 8}, .voxel_m = 3e-4}; }

BoneRegionHead right_head() {
    const BoneBricks b = scene_bricks();
    BoneRegionHead head{};
    head.scene_checksum = kChecksum;
    head.bricks = b.brick_count();
    head.brick_bytes = kVoxels;
    for (std::size_t i = 0; i < 3; ++i) head.size[i] = b.size[i];
    head.voxel_m = b.voxel_m;
    return head;
}

// A complete valid region.
Input right_region() {
    OwnedBoneRegion region(right_head());
    std::fill(region.densities().begin(), region.densities().end(), std::uint8_t{200});
    region.mark_ready();
    Input bytes(static_cast<std::size_t>(::lseek(region.fd(), 0, SEEK_END)));
    require(::pread(region.fd(), bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()));
    return bytes;
}

// A region from an untrusted process: sealed memory, and the writer's own mapping of it.
class Stranger {
public:
    explicit Stranger(std::span<const std::byte> bytes) : bytes_(std::max<std::size_t>(bytes.size(), 1)) {
        fd_ = FileDescriptor(memfd_create("fuzz", MFD_CLOEXEC | MFD_ALLOW_SEALING));
        require(fd_.valid() && ftruncate(fd_.get(), static_cast<off_t>(bytes_)) == 0);
        map_ = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED, fd_.get(), 0);
        require(map_ != MAP_FAILED);
        write(0, bytes);
        require(fcntl(fd_.get(), F_ADD_SEALS,
                      F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_FUTURE_WRITE | F_SEAL_SEAL) == 0);
    }
    Stranger(const Stranger&) = delete;
    Stranger& operator=(const Stranger&) = delete;
    ~Stranger() { munmap(map_, bytes_); }
    void write(std::size_t at, std::span<const std::byte> what) const {
        if (at >= bytes_) return;
        std::memcpy(static_cast<std::byte*>(map_) + at, what.data(), std::min(what.size(), bytes_ - at));
    }
    [[nodiscard]] FileDescriptor handed_over() const {
        return FileDescriptor(fcntl(fd_.get(), F_DUPFD_CLOEXEC, 0));
    }

private:
    std::size_t bytes_;
    FileDescriptor fd_;
    void* map_ = nullptr;
};

std::int64_t levels(std::span<const std::uint8_t> voxels) {
    return std::accumulate(voxels.begin(), voxels.end(), std::int64_t{0});
}

}  // namespace

bool run(std::span<const std::byte> input) {
    if (input.size() < 2 || input.size() > kBytesMost) return false;
    static const Input right = right_region();
    const bool fixed = input[0] != std::byte{0};
    // Half of the remaining input is the initial content; the other half is written between reads, in pieces of 64 bytes anywhere.
    const std::span<const std::byte> rest = input.subspan(1);
    const std::size_t first = fixed ? rest.size() / 2 : std::min(rest.size(), right.size());
    Input found = fixed ? right : Input(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(first));
    const std::size_t head_bytes = kRegionHeaderBytes + sizeof(BoneRegionHead);
    if (fixed)
        std::copy_n(rest.begin(), std::min(first, found.size() - head_bytes),
                    found.begin() + static_cast<std::ptrdiff_t>(head_bytes));
    const Stranger stranger(found);
    std::string refusal;
    const MappedBoneRegion region = MappedBoneRegion::map(stranger.handed_over(), refusal);
    require(region.empty() == !refusal.empty() && refusal.size() < 600);
    if (region.empty()) return false;

    const BoneBricks bricks = scene_bricks();
    const std::vector<std::uint8_t> baked = [&] {
        std::vector<std::uint8_t> d(bricks.bytes(), 0);
        for (std::uint32_t z = 0; z < bricks.size[2]; ++z)
            for (std::uint32_t y = 0; y < bricks.size[1]; ++y)
                for (std::uint32_t x = 0; x < bricks.size[0]; ++x) d[bricks.voxel(x, y, z)] = 200;
        return d;
    }();
    BoneVolumeView view;
    view.bricks = bricks;
    view.density = baked;
    BoneFollower follower(view, kChecksum);
    if (!follower.attach(region).empty()) {
        require(!fixed && follower.follow(100).empty());
        return false;
    }
    std::int64_t lost = 0;
    std::span<const std::byte> later = rest.subspan(first);
    for (std::size_t look = 0; look < 40; ++look) {
        const std::size_t most = look % 3;
        const auto changes = follower.follow(most);
        require(changes.size() <= most);
        for (const BrickChange& c : changes) {
            require(c.brick < bricks.brick_count() && c.before.size() == kVoxels &&
                    c.after.size() == kVoxels);
            lost += levels(c.before) - levels(c.after);
        }
        if (later.empty()) continue;
        const auto piece = later.first(std::min<std::size_t>(later.size(), 64));
        std::uint32_t at = 0;
        std::memcpy(&at, piece.data(), std::min(sizeof at, piece.size()));
        stranger.write(at % found.size(),
                       piece);  // also the header, which the reader copied when it checked it
        later = later.subspan(piece.size());
    }
    require(lost == levels(baked) - levels(follower.volume().density));
    require(zero_beyond_size(follower.volume().bricks, follower.volume().density));
    follower.detach();
    require(follower.follow(100).empty());
    return true;
}

std::vector<Input> seeds() {
    const Input right = right_region();
    Input as_it_is(right.size() + 1, std::byte{0});
    std::copy(right.begin(), right.end(), as_it_is.begin() + 1);
    Input written(2049, std::byte{1});
    for (std::size_t i = 1; i < written.size(); ++i) written[i] = static_cast<std::byte>(i * 37);
    return {as_it_is, written, Input(600, std::byte{255})};
}

}  // namespace tact::fuzz
