// The live drill model against its reference, on bone with air cells.
#include <gtest/gtest.h>

#include <cmath>

#include "ipc/scene/bone/bone_volume.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "tests/reference/certify.hpp"
#include "tests/support/bone_block.hpp"

namespace tact::certify_drilling_test {
namespace {

constexpr std::uint32_t kEdge = 72;

// rough: how many times smaller the air cells are than 20 voxels.
SceneWriter porous_scene(double voxel_m, double rough = 1.0) {
    const BoneBlock bone(
        kEdge, voxel_m,
        [rough](const Vec3& p) {
            const double cells = std::sin(0.31 * rough * p.x()) + std::sin(0.37 * rough * p.y() + 1.0) +
                                 std::sin(0.29 * rough * p.z());
            const double top = 44.0 + 4.0 * std::sin(0.13 * p.x()) * std::cos(0.11 * p.y());
            return std::clamp(0.5 + top - p.z(), 0.0, 1.0) * std::clamp(1.5 - 2.0 * cells, 0.0, 1.0);
        },
        2);
    SceneMeta meta{};
    meta.kind = SceneKind::drilling;
    meta.body_count = 0;
    meta.world_per_model = 1.0;
    meta.energy_j_per_sigma = 0.0;
    meta.map_sigma = 1.0;
    SceneWriter out;
    write_meta(out, meta, "");
    BoneVolumeView view;
    view.bricks = bone.bricks;
    view.density = bone.density;
    write_bone_volume(out, view);
    return out;
}

TEST(CertifyDrilling, keeps_every_promise_at_fine_and_coarse_voxels) {
    for (const double voxel_m : {3e-4, 8e-4}) {
        const std::vector<std::byte> bytes = porous_scene(voxel_m).to_bytes();
        const SceneFile scene = SceneFile::from_bytes(bytes, "porous");
        const reference::Promises promises = certify(scene, {.poses = 1500, .seed = 5, .progress = {}});
        ASSERT_EQ(promises.size(), 7U);
        for (const reference::Promise& p : promises) {
            EXPECT_GT(p.steps, 0U) << p.name;
            EXPECT_EQ(p.violations, 0U) << p.name << ": " << p.worst_ratio << " at " << p.worst_at;
        }
    }
}

// As in scans of 1 to 3 mm: cells of a few voxels, and a burr of little more than two.
TEST(CertifyDrilling, keeps_every_promise_in_voxels_of_half_the_burr) {
    const std::vector<std::byte> bytes = porous_scene(1.3e-3, 2.5).to_bytes();
    const SceneFile scene = SceneFile::from_bytes(bytes, "coarse");
    for (const reference::Promise& p : certify(scene, {.poses = 6000, .seed = 5, .progress = {}}))
        EXPECT_EQ(p.violations, 0U) << p.name << ": " << p.worst_ratio << " at " << p.worst_at;
}

}  // namespace
}  // namespace tact::certify_drilling_test
