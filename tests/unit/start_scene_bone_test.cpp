// The bone of a run: the region contains the bone of the scene, and readers of the region get the drilled bone.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/base/error.hpp"
#include "ipc/scene/bone/bone_volume.hpp"
#include "rt/start/scene_bone.hpp"
#include "tests/support/bone_scene.hpp"

namespace tact::start_scene_bone_test {
namespace {

TEST(SceneBone, removed_bone_appears_in_the_region) {
    BoneBricks bricks;
    bricks.size = {40, 40, 20};
    bricks.voxel_m = 3e-4;
    bricks.origin_m = -3e-4 * Vec3(19.5, 19.5, 19.5);  // bone below z = 0
    std::vector<std::uint8_t> density(bricks.bytes());
    for (std::uint32_t z = 0; z < 20; ++z)
        for (std::uint32_t y = 0; y < 40; ++y)
            for (std::uint32_t x = 0; x < 40; ++x) density[bricks.voxel(x, y, z)] = 255;
    const SceneWriter out = bone_scene(bricks, density);
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("tact-scene-bone-" + std::to_string(getpid()) + ".tact");
    out.write(path);
    const SceneFile scene = SceneFile::open(path);
    SceneBone bone(scene);
    std::filesystem::remove(path);

    std::string refusal;
    const auto seen = MappedBoneRegion::map(FileDescriptor(fcntl(bone.fd(), F_DUPFD_CLOEXEC, 0)), refusal);
    ASSERT_FALSE(seen.empty()) << refusal;
    EXPECT_EQ(seen.head().scene_checksum, scene.checksum());
    EXPECT_EQ(seen.head().bricks, bricks.brick_count());
    const auto levels_seen = [&seen] {
        std::vector<std::uint8_t> brick(seen.head().brick_bytes);
        std::uint64_t levels = 0;
        for (std::uint64_t b = 0; b < seen.head().bricks; ++b) {
            seen.copy_brick(b, brick);
            for (const std::uint8_t v : brick) levels += v;
        }
        return levels;
    };
    const std::uint64_t whole = levels_seen();
    EXPECT_EQ(whole, 255ULL * 40 * 40 * 20);

    DrillModel model(read_meta(scene), bone.bone(), DrillSettings{});
    model.turn_burr({6283.0, 1e-3});
    ToolState tool;
    tool.T_world_tool.p_m = Vec3(0.0, 0.0, 1e-3);
    model.reset(tool);
    Budget budget;
    budget.fidelity = 0.5F;
    budget.deadline = Instant::max();
    for (int i = 0; i < 200; ++i) {
        tool.T_world_tool.p_m.x() = 1e-5 * i;
        model.step(tool, budget);
    }
    EXPECT_GT(model.removed_levels(), 1000U);
    EXPECT_EQ(whole - levels_seen(), model.removed_levels());
    std::uint64_t moved = 0;
    for (std::uint64_t b = 0; b < seen.head().bricks; ++b) moved += seen.revision(b) != 0 ? 1 : 0;
    EXPECT_GT(moved, 0U);
    EXPECT_LT(moved, seen.head().bricks / 2);
}

TEST(SceneBone, a_scene_without_bone_is_refused) {
    SceneMeta meta{};
    meta.kind = SceneKind::drilling;
    meta.world_per_model = 1.0;
    SceneWriter out;
    write_meta(out, meta, "made by a test\n");
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("tact-no-bone-" + std::to_string(getpid()) + ".tact");
    out.write(path);
    const SceneFile scene = SceneFile::open(path);
    std::filesystem::remove(path);
    EXPECT_THROW(SceneBone{scene}, StartupError);
}

}  // namespace
}  // namespace tact::start_scene_bone_test
