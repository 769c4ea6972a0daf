// Drilled bone, kept in a file while it is drilled: the bricks that changed, in the order of their changes, with the
// number of the stroke that changed them.
//
// File     NAME.bone: a head of 128 bytes (magic "TACTBON1", checksum of the scene, size, CRC-32), then frames: a head of
//          32 bytes (magic "BRIK", number of strokes in effect, bricks, bytes, CRC-32 of both) and zlib data, which are
//          the indices of the bricks and their densities. Little endian.
// Strokes  a lower number than that of the frame before: strokes were undone.
// Crash    what follows the last whole frame is left out and counted: a writer that was killed loses that frame only
// Input    untrusted: sizes, indices and checksums are checked; no voxel may hold more than in the scene
// Errors   StartupError: no such file, another scene, damaged content, a full disk
// Thread   any but the servo thread
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "ipc/scene/bone/bone_volume.hpp"

namespace tact {

struct DrilledBoneHead {
    char magic[8];
    std::uint64_t scene_checksum;
    std::uint32_t size[3];  // voxels
    std::uint32_t bricks;
    double voxel_m;
    std::uint8_t reserved[84];  // zero
    std::uint32_t crc;          // of the bytes before it
};
static_assert(sizeof(DrilledBoneHead) == 128);

[[nodiscard]] DrilledBoneHead drilled_bone_head(const BoneBricks& bricks, std::uint64_t scene_checksum);

struct DrilledBrick {
    std::uint32_t stroke;  // number of strokes in effect, with this one
    std::uint32_t brick;
    std::span<const std::uint8_t> voxels;  // BoneBricks::kVoxels; valid during the call
};

struct DrilledBoneSummary {
    std::uint64_t frames = 0, bricks = 0;  // written, with repetitions
    std::uint32_t strokes = 0;             // in effect
    std::uint64_t bytes = 0;               // of head and whole frames
    std::uint64_t bytes_left_out = 0;      // behind them: not written whole
};

// Calls take for each brick in the order of the file. scene: as baked. name: for messages.
DrilledBoneSummary read_drilled_bone(std::istream& in, const std::string& name, const BoneVolumeView& scene,
                                     std::uint64_t scene_checksum,
                                     const std::function<void(const DrilledBrick&)>& take);
DrilledBoneSummary read_drilled_bone(const std::filesystem::path& path, const BoneVolumeView& scene,
                                     std::uint64_t scene_checksum,
                                     const std::function<void(const DrilledBrick&)>& take);

// Checksum of the scene of a file; 0: not a file of drilled bone.
[[nodiscard]] std::uint64_t drilled_bone_scene(const std::filesystem::path& path);
// Length and CRC-32 of a file, as text.
[[nodiscard]] std::string file_identity(const std::filesystem::path& path);

class DrilledBoneWriter {
public:
    static constexpr std::uint32_t kFrameBricksMax = 65536;

    // Creates the file and its folder. Refuses a file that exists.
    DrilledBoneWriter(const std::filesystem::path& path, const DrilledBoneHead& head);
    ~DrilledBoneWriter();
    DrilledBoneWriter(const DrilledBoneWriter&) = delete;
    DrilledBoneWriter& operator=(const DrilledBoneWriter&) = delete;

    // Appends the bricks as frames. densities: BoneBricks::kVoxels a brick. If it fails, the file is as before.
    void write(std::uint32_t stroke, std::span<const std::uint32_t> bricks,
               std::span<const std::uint8_t> densities);
    // Appends the whole frames of a file of the same scene, bytes of which were read (DrilledBoneSummary).
    void copy_frames(const std::filesystem::path& from, std::uint64_t bytes);
    [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

private:
    void append(std::span<const std::uint8_t> data);

    std::filesystem::path path_;
    int fd_ = -1;
    std::uint64_t bytes_ = 0;
    std::vector<std::uint8_t> raw_, packed_;
};

}  // namespace tact
