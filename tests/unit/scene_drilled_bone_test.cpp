// The file of drilled bone: what was written is read, a torn end is left out, and what does not belong is refused.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <numeric>
#include <sstream>
#include <vector>

#include "ipc/scene/bone/drilled_bone.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/says.hpp"

namespace tact::scene_drilled_bone_test {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kVoxels = BoneBricks::kVoxels;
constexpr std::uint64_t kScene = 0x123456789ABCDEFULL;

struct DrilledBone : ::testing::Test {
    fs::path dir = fs::temp_directory_path() / ("tact-drilled-" + std::to_string(getpid()));
    fs::path file = dir / "deep" / "a.bone";
    BoneVolumeView scene;
    std::vector<std::uint8_t> baked;

    DrilledBone() {
        scene.bricks = {.size = {20, 9, 8}, .voxel_m = 3e-4};
        baked.assign(scene.bricks.bytes(), 0);
        for (std::uint32_t z = 0; z < 8; ++z)
            for (std::uint32_t y = 0; y < 9; ++y)
                for (std::uint32_t x = 0; x < 20; ++x)
                    baked[scene.bricks.voxel(x, y, z)] = static_cast<std::uint8_t>(100 + x);
        scene.density = baked;
        fs::remove_all(dir);
    }
    ~DrilledBone() override { fs::remove_all(dir); }
    [[nodiscard]] DrilledBoneHead head() const { return drilled_bone_head(scene.bricks, kScene); }
    // A brick of the scene, lower by `less`.
    [[nodiscard]] std::vector<std::uint8_t> lower(std::uint32_t brick, std::uint8_t less) const {
        std::vector<std::uint8_t> v(baked.begin() + static_cast<std::ptrdiff_t>(brick * kVoxels),
                                    baked.begin() + static_cast<std::ptrdiff_t>((brick + 1) * kVoxels));
        for (std::uint8_t& level : v) level = static_cast<std::uint8_t>(level - std::min(level, less));
        return v;
    }
    void write(DrilledBoneWriter& out, std::uint32_t stroke, const std::vector<std::uint32_t>& bricks,
               std::uint8_t less) const {
        std::vector<std::uint8_t> all;
        for (const std::uint32_t b : bricks) {
            const auto v = lower(b, less);
            all.insert(all.end(), v.begin(), v.end());
        }
        out.write(stroke, bricks, all);
    }
    // Three frames: strokes 1 and 2, and stroke 2 undone.
    void write_three() const {
        DrilledBoneWriter out(file, head());
        write(out, 1, {0, 2}, 5);
        write(out, 2, {2, 5}, 9);
        write(out, 1, {2, 5}, 5);
        EXPECT_EQ(out.bytes(), fs::file_size(file));
    }
    struct Read {
        DrilledBoneSummary sum;
        std::vector<std::pair<std::uint32_t, std::uint32_t>> order;  // stroke, brick
        std::map<std::uint32_t, std::vector<std::uint8_t>> last;
    };
    [[nodiscard]] Read read() const {
        Read r;
        r.sum = read_drilled_bone(file, scene, kScene, [&](const DrilledBrick& b) {
            r.order.emplace_back(b.stroke, b.brick);
            r.last[b.brick].assign(b.voxels.begin(), b.voxels.end());
        });
        return r;
    }
    [[nodiscard]] std::string bytes() const {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    void put(const std::string& content) const {
        std::ofstream(file, std::ios::binary | std::ios::trunc) << content;
    }
};

TEST_F(DrilledBone, is_read_as_it_was_written) {
    write_three();
    const Read r = read();
    const std::vector<std::pair<std::uint32_t, std::uint32_t>> order{{1, 0}, {1, 2}, {2, 2},
                                                                     {2, 5}, {1, 2}, {1, 5}};
    EXPECT_EQ(r.order, order);
    EXPECT_EQ(r.sum.frames, 3U);
    EXPECT_EQ(r.sum.bricks, 6U);
    EXPECT_EQ(r.sum.strokes, 1U);
    EXPECT_EQ(r.sum.bytes, fs::file_size(file));
    EXPECT_EQ(r.sum.bytes_left_out, 0U);
    for (const std::uint32_t b : {0U, 2U, 5U}) EXPECT_EQ(r.last.at(b), lower(b, 5)) << b;
    EXPECT_EQ(drilled_bone_scene(file), kScene);
    EXPECT_EQ(drilled_bone_scene(dir / "none.bone"), 0U);
}

TEST_F(DrilledBone, a_torn_end_is_left_out_wherever_it_was_torn) {
    write_three();
    const std::string whole = bytes();
    std::vector<std::size_t> ends{sizeof(DrilledBoneHead)};
    for (std::size_t frames = 0; frames < 3; ++frames) {
        std::uint64_t data = 0;
        whole.copy(reinterpret_cast<char*>(&data), sizeof data, ends.back() + 16);
        ends.push_back(ends.back() + 32 + data);
    }
    ASSERT_EQ(ends.back(), whole.size());
    for (std::size_t cut = sizeof(DrilledBoneHead); cut <= whole.size(); ++cut) {
        put(whole.substr(0, cut));
        const Read r = read();
        std::size_t frames = 0;
        while (frames < 3 && ends[frames + 1] <= cut) ++frames;
        ASSERT_EQ(r.sum.frames, frames) << cut;
        ASSERT_EQ(r.sum.bytes, ends[frames]) << cut;
        ASSERT_EQ(r.sum.bytes_left_out, cut - ends[frames]) << cut;
    }
}

TEST_F(DrilledBone, every_changed_byte_is_noticed) {
    write_three();
    const std::string whole = bytes();
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string other = whole;
        other[i] = static_cast<char>(other[i] ^ 0x10);
        put(other);
        try {
            const Read r = read();
            ASSERT_LT(r.sum.frames, 3U) << i;
            ASSERT_GT(r.sum.bytes_left_out, 0U) << i;
            ASSERT_GE(i, sizeof(DrilledBoneHead));
        } catch (const StartupError&) {
            ASSERT_LT(i, sizeof(DrilledBoneHead)) << i;
        }
    }
}

TEST_F(DrilledBone, what_does_not_belong_is_refused_with_the_reason) {
    write_three();
    const auto none = [](const DrilledBrick&) {};
    EXPECT_TRUE(says(sample::error_of([&] { read_drilled_bone(file, scene, kScene + 1, none); }),
                     {"another scene", "fix:"}));
    BoneVolumeView other = scene;
    other.bricks.voxel_m = 4e-4;
    EXPECT_TRUE(
        says(sample::error_of([&] { read_drilled_bone(file, other, kScene, none); }), {"size or voxels"}));
    EXPECT_TRUE(says(sample::error_of([&] { read_drilled_bone(dir / "none.bone", scene, kScene, none); }),
                     {"none.bone", "No such file"}));
    put("a text\n");
    EXPECT_TRUE(says(sample::error_of([&] { read_drilled_bone(file, scene, kScene, none); }),
                     {"not a file of drilled bone"}));
    fs::remove(file);
    {
        DrilledBoneWriter out(file, head());
        out.write(1, std::vector<std::uint32_t>{0}, std::vector<std::uint8_t>(kVoxels, 255));
    }
    EXPECT_TRUE(says(sample::error_of([&] { read_drilled_bone(file, scene, kScene, none); }),
                     {"brick 0 holds more bone"}));
    fs::remove(file);
    {
        DrilledBoneWriter out(file, head());
        out.write(1, std::vector<std::uint32_t>{6}, std::vector<std::uint8_t>(kVoxels, 0));
    }
    EXPECT_TRUE(says(sample::error_of([&] { read_drilled_bone(file, scene, kScene, none); }),
                     {"brick 6 is outside the bone of 6"}));
}

TEST_F(DrilledBone, is_never_overwritten) {
    write_three();
    const std::string whole = bytes();
    EXPECT_TRUE(says(sample::error_of([&] { DrilledBoneWriter(file, head()); }),
                     {"a.bone", "exists", "another name"}));
    EXPECT_EQ(bytes(), whole);
}

TEST_F(DrilledBone, goes_on_from_a_copy_of_another_file_without_its_torn_end) {
    write_three();
    put(bytes() + "torn");
    const Read before = read();
    const fs::path next = dir / "b.bone";
    {
        DrilledBoneWriter out(next, head());
        out.copy_frames(file, before.sum.bytes);
        write(out, 2, {1}, 7);
    }
    file = next;
    const Read r = read();
    EXPECT_EQ(r.sum.frames, 4U);
    EXPECT_EQ(r.sum.bytes_left_out, 0U);
    EXPECT_EQ(r.last.at(5), lower(5, 5));
    EXPECT_EQ(r.last.at(1), lower(1, 7));
}

// The disk is full in the middle of a frame: the file stays as before, and writing goes on when there is space.
TEST_F(DrilledBone, a_frame_that_does_not_fit_leaves_the_file_as_it_was) {
    DrilledBoneWriter out(file, head());
    write(out, 1, {0, 2}, 5);
    const std::string before = bytes();
    rlimit limit{};
    getrlimit(RLIMIT_FSIZE, &limit);
    const rlim_t all = limit.rlim_cur;
    auto* const handler = std::signal(SIGXFSZ, SIG_IGN);
    limit.rlim_cur = before.size() + 40;
    setrlimit(RLIMIT_FSIZE, &limit);
    EXPECT_THROW(write(out, 2, {2, 5}, 9), StartupError);
    limit.rlim_cur = all;
    setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(bytes(), before);
    write(out, 2, {2, 5}, 9);
    const Read r = read();
    EXPECT_EQ(r.sum.frames, 2U);
    EXPECT_EQ(r.sum.bytes_left_out, 0U);
    EXPECT_EQ(r.last.at(5), lower(5, 9));
}

}  // namespace
}  // namespace tact::scene_drilled_bone_test
