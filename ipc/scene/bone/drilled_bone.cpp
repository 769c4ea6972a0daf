#include "ipc/scene/bone/drilled_bone.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <istream>

#include "ipc/base/error.hpp"
#include "ipc/base/printed.hpp"
#include "ipc/scene/file/packing.hpp"

namespace tact {
namespace {

constexpr char kBoneFileMagic[8] = {'T', 'A', 'C', 'T', 'B', 'O', 'N', '1'};
constexpr char kFrameMagic[4] = {'B', 'R', 'I', 'K'};
constexpr std::size_t kBrickBytes = sizeof(std::uint32_t) + BoneBricks::kVoxels;

struct FrameHead {
    char magic[4];
    std::uint32_t stroke, bricks;
    std::uint32_t data_crc;
    std::uint64_t data_bytes;
    std::uint32_t reserved;
    std::uint32_t crc;  // of the bytes before it
};
static_assert(sizeof(FrameHead) == 32);

// Of a head whose last member is its checksum.
template <class Head>
std::uint32_t head_crc(const Head& head) {
    return crc_of(&head, sizeof head - sizeof head.crc);
}

// False: the data end before.
bool read_all(std::istream& in, void* to, std::size_t size) {
    in.read(static_cast<char*>(to), static_cast<std::streamsize>(size));
    return static_cast<std::size_t>(in.gcount()) == size;
}

class FrameReader {
public:
    FrameReader(std::istream& in, std::uint32_t bricks) : in_(in), bricks_(bricks) {}

    // False: no whole frame follows.
    bool next() {
        if (!read_all(in_, &head_, sizeof head_)) return false;
        const bool sane = std::equal(std::begin(kFrameMagic), std::end(kFrameMagic), head_.magic) &&
                          head_.crc == head_crc(head_) && head_.bricks > 0 &&
                          head_.bricks <= std::min(bricks_, DrilledBoneWriter::kFrameBricksMax) &&
                          head_.data_bytes <= packed_most(head_.bricks * kBrickBytes);
        if (!sane) return false;
        packed_.resize(head_.data_bytes);
        return read_all(in_, packed_.data(), packed_.size()) &&
               crc_of(packed_.data(), packed_.size()) == head_.data_crc;
    }
    // False: the data are not those of so many bricks.
    bool unpack() {
        raw_.resize(head_.bricks * kBrickBytes);
        return tact::unpack(packed_, raw_);
    }
    [[nodiscard]] const FrameHead& head() const { return head_; }
    [[nodiscard]] std::uint64_t bytes() const { return sizeof head_ + packed_.size(); }
    [[nodiscard]] std::uint32_t brick(std::size_t i) const {
        std::uint32_t b = 0;
        std::memcpy(&b, raw_.data() + i * sizeof b, sizeof b);
        return b;
    }
    [[nodiscard]] std::span<const std::uint8_t> voxels(std::size_t i) const {
        return std::span(raw_).subspan(head_.bricks * sizeof(std::uint32_t) + i * BoneBricks::kVoxels,
                                       BoneBricks::kVoxels);
    }

private:
    std::istream& in_;
    std::uint32_t bricks_;
    FrameHead head_{};
    std::vector<std::uint8_t> packed_, raw_;
};

constexpr const char* kFixOther = "give the scene in which the bone was drilled, or drill this one anew";

}  // namespace

DrilledBoneHead drilled_bone_head(const BoneBricks& bricks, std::uint64_t scene_checksum) {
    DrilledBoneHead head{};
    std::copy(std::begin(kBoneFileMagic), std::end(kBoneFileMagic), head.magic);
    head.scene_checksum = scene_checksum;
    std::copy(bricks.size.begin(), bricks.size.end(), head.size);
    head.bricks = static_cast<std::uint32_t>(bricks.brick_count());
    head.voxel_m = bricks.voxel_m;
    head.crc = head_crc(head);
    return head;
}

DrilledBoneSummary read_drilled_bone(std::istream& in, const std::string& name, const BoneVolumeView& scene,
                                     std::uint64_t scene_checksum,
                                     const std::function<void(const DrilledBrick&)>& take) {
    const std::string attempt = "reading drilled bone from " + name;
    constexpr const char* kFixDamaged = "the file is damaged: use another one";
    DrilledBoneHead head{};
    if (!read_all(in, &head, sizeof head) ||
        !std::equal(std::begin(kBoneFileMagic), std::end(kBoneFileMagic), head.magic))
        throw StartupError(attempt, "it is not a file of drilled bone",
                           "give a .bone file of an earlier run");
    if (head.crc != head_crc(head)) throw StartupError(attempt, "its head is damaged", kFixDamaged);
    const DrilledBoneHead expected = drilled_bone_head(scene.bricks, scene_checksum);
    if (head.scene_checksum != scene_checksum)
        throw StartupError(attempt, "it belongs to another scene", kFixOther);
    if (!std::equal(std::begin(head.size), std::end(head.size), expected.size) ||
        head.bricks != expected.bricks || head.voxel_m != expected.voxel_m)
        throw StartupError(attempt, "size or voxels of the bone differ from the scene's", kFixOther);
    DrilledBoneSummary sum;
    sum.bytes = sizeof head;
    FrameReader frame(in, head.bricks);
    while (frame.next()) {
        const auto damaged = [&](const std::string& why) {
            throw StartupError(attempt,
                               printed("frame %llu: ", static_cast<unsigned long long>(sum.frames)) + why,
                               kFixDamaged);
        };
        if (!frame.unpack()) damaged("its bricks cannot be unpacked");
        for (std::size_t i = 0; i < frame.head().bricks; ++i) {
            const std::uint32_t brick = frame.brick(i);
            if (brick >= head.bricks)
                damaged(printed("brick %u is outside the bone of %u bricks", brick, head.bricks));
            const auto voxels = frame.voxels(i);
            const std::uint8_t* const baked = scene.density.data() + std::size_t{brick} * BoneBricks::kVoxels;
            if (!std::equal(voxels.begin(), voxels.end(), baked,
                            [](std::uint8_t now, std::uint8_t before) { return now <= before; }))
                damaged(printed("brick %u holds more bone than the scene", brick));
            take({frame.head().stroke, brick, voxels});
        }
        ++sum.frames;
        sum.bricks += frame.head().bricks;
        sum.strokes = frame.head().stroke;
        sum.bytes += frame.bytes();
    }
    in.clear();
    in.seekg(0, std::ios::end);
    const auto end = static_cast<std::uint64_t>(in.tellg());
    sum.bytes_left_out = end > sum.bytes ? end - sum.bytes : 0;
    return sum;
}

DrilledBoneSummary read_drilled_bone(const std::filesystem::path& path, const BoneVolumeView& scene,
                                     std::uint64_t scene_checksum,
                                     const std::function<void(const DrilledBrick&)>& take) {
    std::ifstream in(path, std::ios::binary);
    if (!in)
        throw StartupError("reading drilled bone from " + path.string(), last_error(),
                           "check the path and the permissions");
    return read_drilled_bone(in, path.string(), scene, scene_checksum, take);
}

std::uint64_t drilled_bone_scene(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    DrilledBoneHead head{};
    const bool good = read_all(in, &head, sizeof head) &&
                      std::equal(std::begin(kBoneFileMagic), std::end(kBoneFileMagic), head.magic) &&
                      head.crc == head_crc(head);
    return good ? head.scene_checksum : 0;
}

std::string file_identity(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::vector<char> part(std::size_t{1} << 20U);
    std::uint64_t bytes = 0;
    std::uint32_t crc = 0;
    while (in) {
        in.read(part.data(), static_cast<std::streamsize>(part.size()));
        const auto size = static_cast<std::size_t>(in.gcount());
        crc = crc_of(part.data(), size, crc);
        bytes += size;
    }
    return printed("%llx-%08x", static_cast<unsigned long long>(bytes), crc);
}

DrilledBoneWriter::DrilledBoneWriter(const std::filesystem::path& path, const DrilledBoneHead& head)
    : path_(path) {
    std::error_code failed;
    if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), failed);
    fd_ = open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0644);
    if (fd_ < 0)
        throw StartupError("keeping drilled bone in " + path.string(), last_error(),
                           errno == EEXIST ? "give another name, or remove the file"
                                           : "choose a folder that can be written to");
    try {
        append({reinterpret_cast<const std::uint8_t*>(&head), sizeof head});
    } catch (...) {
        close(fd_);
        unlink(path.c_str());
        throw;
    }
}

DrilledBoneWriter::~DrilledBoneWriter() {
    fdatasync(fd_);
    close(fd_);
}

void DrilledBoneWriter::append(std::span<const std::uint8_t> data) {
    std::size_t done = 0;
    while (done < data.size()) {
        const ssize_t n = ::write(fd_, data.data() + done, data.size() - done);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) {
            const std::string why = n < 0 ? last_error() : "nothing was written";
            // A frame that is not whole would hide those that follow.
            const auto whole = static_cast<off_t>(bytes_);
            if (ftruncate(fd_, whole) != 0 || lseek(fd_, whole, SEEK_SET) != whole)
                throw StartupError("keeping drilled bone in " + path_.string(),
                                   why + "; the part of a frame could not be removed", "free disk space");
            throw StartupError("keeping drilled bone in " + path_.string(), why, "free disk space");
        }
        done += static_cast<std::size_t>(n);
    }
    bytes_ += data.size();
}

void DrilledBoneWriter::write(std::uint32_t stroke, std::span<const std::uint32_t> bricks,
                              std::span<const std::uint8_t> densities) {
    for (std::size_t from = 0; from < bricks.size(); from += kFrameBricksMax) {
        const std::size_t count = std::min<std::size_t>(bricks.size() - from, kFrameBricksMax);
        raw_.resize(count * kBrickBytes);
        std::memcpy(raw_.data(), bricks.data() + from, count * sizeof(std::uint32_t));
        std::memcpy(raw_.data() + count * sizeof(std::uint32_t),
                    densities.data() + from * BoneBricks::kVoxels, count * BoneBricks::kVoxels);
        packed_.resize(sizeof(FrameHead));
        const std::size_t size = pack(raw_, packed_);
        FrameHead head{};
        std::copy(std::begin(kFrameMagic), std::end(kFrameMagic), head.magic);
        head.stroke = stroke;
        head.bricks = static_cast<std::uint32_t>(count);
        head.data_bytes = size;
        head.data_crc = crc_of(packed_.data() + sizeof head, size);
        head.crc = head_crc(head);
        std::memcpy(packed_.data(), &head, sizeof head);
        append(packed_);
    }
}

void DrilledBoneWriter::copy_frames(const std::filesystem::path& from, std::uint64_t bytes) {
    std::ifstream in(from, std::ios::binary);
    std::vector<std::uint8_t> all(bytes > sizeof(DrilledBoneHead) ? bytes - sizeof(DrilledBoneHead) : 0);
    in.seekg(sizeof(DrilledBoneHead));
    if (!read_all(in, all.data(), all.size()))
        throw StartupError("copying drilled bone from " + from.string(), "the file became shorter",
                           "let no other program write to it");
    append(all);
}

}  // namespace tact
