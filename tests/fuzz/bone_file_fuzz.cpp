// Files of drilled bone from anywhere, and a run that starts with one.
//
// First byte   0: the bytes as a file. Otherwise each four bytes are a frame of one brick: stroke, brick, density, voxels.
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <sstream>

#include "ipc/base/error.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "rt/start/resume_bone.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tact::fuzz {
namespace {

constexpr std::size_t kVoxels = BoneBricks::kVoxels, kBytesMost = 1 << 14;
constexpr std::uint8_t kBaked = 200;

struct BakedBlock {
    BoneVolumeView view;
    std::vector<std::uint8_t> density;
    std::vector<std::byte> bytes;
    BakedBlock() {
        view.bricks = {.size = {20, 9, 8}, .voxel_m = 3e-4};
        density.assign(view.bricks.bytes(), 0);
        for (std::uint32_t z = 0; z < 8; ++z)
            for (std::uint32_t y = 0; y < 9; ++y)
                for (std::uint32_t x = 0; x < 20; ++x) density[view.bricks.voxel(x, y, z)] = kBaked;
        view.density = density;
        SceneWriter out;
        write_bone_volume(out, view);
        bytes = out.to_bytes();
    }
};
const BakedBlock& block() {
    static const BakedBlock it;
    return it;
}
const SceneFile& scene() {
    static const SceneFile it = SceneFile::from_bytes(block().bytes, "scene");
    return it;
}
std::filesystem::path file() {
    return std::filesystem::temp_directory_path() / ("tact-bone-fuzz-" + std::to_string(getpid()) + ".bone");
}

void write_frames(std::span<const std::byte> input) {
    std::filesystem::remove(file());
    DrilledBoneWriter out(file(), drilled_bone_head(block().view.bricks, scene().checksum()));
    for (; input.size() >= 4; input = input.subspan(4)) {
        const std::uint32_t brick = std::to_integer<std::uint32_t>(input[1]) % 7;
        std::vector<std::uint8_t> v(kVoxels, 0);
        if (brick < 6)
            std::copy_n(block().density.begin() + static_cast<std::ptrdiff_t>(brick * kVoxels), kVoxels,
                        v.begin());
        const std::size_t count = std::min<std::size_t>(2U * std::to_integer<std::size_t>(input[3]), kVoxels);
        const auto level = std::to_integer<std::uint8_t>(input[2]);
        const bool possible = std::to_integer<unsigned>(input[3]) % 2 == 0;
        std::transform(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(count), v.begin(),
                       [&](std::uint8_t baked) { return possible ? std::min(level, baked) : level; });
        out.write(std::to_integer<std::uint32_t>(input[0]) % 5, std::vector<std::uint32_t>{brick}, v);
    }
}

std::int64_t mass(std::span<const std::uint8_t> density) {
    return std::accumulate(density.begin(), density.end(), std::int64_t{0});
}

void check(const DrillBone& bone) {
    require(bone.octree.total().m0 == mass(bone.density));
    require(bone.returned_levels == mass(bone.density) - mass(block().density));
    require(std::equal(bone.density.begin(), bone.density.end(), block().density.begin(),
                       [](std::uint8_t now, std::uint8_t baked) { return now <= baked; }));
}

bool resume() {
    std::vector<std::uint8_t> density = block().density;
    std::vector<std::uint32_t> revision(block().view.bricks.brick_count());
    DrillBone bone(block().view.bricks, density, revision);
    try {
        const DrilledBoneSummary sum = resume_bone(file(), scene(), bone);
        require(sum.frames == 0 || bone.strokes.strokes() <= sum.strokes);
    } catch (const StartupError&) {
        return false;
    }
    check(bone);
    while (bone.strokes.undo())
        while (bone.strokes.exchanging()) bone.exchange();
    check(bone);
    return true;
}

}  // namespace

bool run(std::span<const std::byte> input) {
    if (input.empty() || input.size() > kBytesMost) return false;
    if (input[0] != std::byte{0}) {
        write_frames(input.subspan(1));
    } else {
        std::ofstream out(file(), std::ios::binary | std::ios::trunc);
        out.write(reinterpret_cast<const char*>(input.data() + 1),
                  static_cast<std::streamsize>(input.size() - 1));
    }
    const bool good = resume();
    std::filesystem::remove(file());
    return good;
}

std::vector<Input> seeds() {
    Input frames{std::byte{1}};
    for (const int b :
         {1, 0, 100, 30, 1, 1, 90, 200, 2, 1, 0, 254, 2, 4, 3, 8, 1, 1, 90, 200, 2, 5, 9, 8, 4, 0, 0, 254})
        frames.push_back(static_cast<std::byte>(b));
    write_frames(std::span(frames).subspan(1));
    std::ifstream in(file(), std::ios::binary);
    std::stringstream text;
    text << in.rdbuf();
    Input whole{std::byte{0}};
    for (const char c : text.str()) whole.push_back(static_cast<std::byte>(c));
    std::filesystem::remove(file());
    return {frames, whole};
}

}  // namespace tact::fuzz
