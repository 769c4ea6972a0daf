// A run that starts with the bone of an earlier one: the same bone to the bit, and its strokes can be undone.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <numeric>
#include <vector>

#include "rt/force/drilling/drill_model.hpp"
#include "rt/start/resume_bone.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/says.hpp"

namespace tact::start_resume_bone_test {
namespace {

namespace fs = std::filesystem;
constexpr std::uint32_t kEdge = 40;
constexpr double kVoxelM = 3e-4;
constexpr std::size_t kVoxels = BoneBricks::kVoxels;

// A solid block, drilled by a burr, and the file that keeps it.
struct Site {
    fs::path dir = fs::temp_directory_path() / ("tact-resume-" + std::to_string(getpid()));
    BoneVolumeView baked;
    std::vector<std::uint8_t> baked_density, density;
    std::vector<std::uint32_t> revision, seen;
    std::vector<std::byte> bytes;
    std::unique_ptr<SceneFile> scene;
    std::unique_ptr<DrillBone> bone;
    std::unique_ptr<DrillModel> model;
    std::unique_ptr<DrilledBoneWriter> out;

    Site() {
        fs::remove_all(dir);
        baked.bricks = {.size = {kEdge, kEdge, kEdge}, .voxel_m = kVoxelM};
        baked.bricks.origin_m = -kVoxelM * Vec3::Constant(0.5 * kEdge - 0.5);
        baked_density.assign(baked.bricks.bytes(), 0);
        for (std::uint32_t z = 0; z < kEdge / 2; ++z)
            for (std::uint32_t y = 0; y < kEdge; ++y)
                for (std::uint32_t x = 0; x < kEdge; ++x) baked_density[baked.bricks.voxel(x, y, z)] = 255;
        baked.density = baked_density;
        SceneWriter writer;
        write_bone_volume(writer, baked);
        bytes = writer.to_bytes();
        scene = std::make_unique<SceneFile>(SceneFile::from_bytes(bytes, "block"));
        start();
        out = std::make_unique<DrilledBoneWriter>(file(), drilled_bone_head(baked.bricks, scene->checksum()));
    }
    ~Site() { fs::remove_all(dir); }
    [[nodiscard]] fs::path file() const { return dir / "a.bone"; }
    void start() {
        model.reset();
        density = baked_density;
        revision.assign(baked.bricks.brick_count(), 0);
        seen = revision;
        bone = std::make_unique<DrillBone>(baked.bricks, density, revision);
        SceneMeta meta{};
        meta.kind = SceneKind::drilling;
        meta.world_per_model = 1.0;
        DrillSettings s;
        s.tool.radius_m = 1.5e-3;
        model = std::make_unique<DrillModel>(meta, *bone, s);
        model->reset(at({0.0, 0.0, 4e-3}));
    }
    static ToolState at(const Vec3& p_m) {
        ToolState tool;
        tool.T_world_tool.p_m = p_m;
        return tool;
    }
    void step(const Vec3& p_m) {
        model->turn_burr({6283.0, 1e-3});
        Budget budget;
        budget.fidelity = 1.0F;
        (void)model->step(at(p_m), budget);
    }
    // Written after the first half of it, and at its end.
    void stroke(double x_m) {
        for (int i = 0; i < 300; ++i) step({x_m, 0.0, 4e-3});
        for (int i = 0; i < 40; ++i) step({x_m, 5e-5 * i, 1.2e-3});
        keep();
        for (int i = 40; i < 80; ++i) step({x_m, 5e-5 * i, 1.2e-3});
        for (int i = 0; i < 310; ++i) step({x_m, 0.0, 4e-3});
        keep();
    }
    void exchange(bool good) {
        ASSERT_TRUE(good);
        for (int i = 0; i < 600; ++i) step({0.0, 0.0, 4e-3});
        ASSERT_FALSE(bone->strokes.exchanging());
    }
    // As the keeper does: what changed since, with the strokes in effect.
    void keep() {
        std::vector<std::uint32_t> bricks;
        std::vector<std::uint8_t> all;
        for (std::uint32_t i = 0; i < revision.size(); ++i) {
            if (revision[i] == seen[i]) continue;
            seen[i] = revision[i];
            bricks.push_back(i);
            all.insert(all.end(), density.begin() + static_cast<std::ptrdiff_t>(i * kVoxels),
                       density.begin() + static_cast<std::ptrdiff_t>((i + 1) * kVoxels));
        }
        if (!bricks.empty()) out->write(bone->strokes.strokes(), bricks, all);
    }
    DrilledBoneSummary resume() {
        start();
        return resume_bone(file(), *scene, *bone);
    }
    [[nodiscard]] std::int64_t missing() const {
        return std::accumulate(baked_density.begin(), baked_density.end(), std::int64_t{0}) -
               std::accumulate(density.begin(), density.end(), std::int64_t{0});
    }
};

TEST(ResumeBone, is_the_same_to_the_bit_and_every_stroke_can_be_undone) {
    Site s;
    std::vector<std::vector<std::uint8_t>> states{s.density};
    for (int k = 0; k < 6; ++k) {
        s.stroke(-3e-3 + 1e-3 * k);
        states.push_back(s.density);
    }
    const DrilledBoneSummary sum = s.resume();
    EXPECT_EQ(sum.strokes, 6U);
    EXPECT_EQ(sum.bytes_left_out, 0U);
    ASSERT_EQ(s.density, states.back());
    EXPECT_EQ(s.bone->strokes.strokes(), 6U);
    EXPECT_EQ(-s.bone->returned_levels, s.missing());
    const MomentOctree fresh(s.baked.bricks, s.density);
    EXPECT_EQ(fresh.total().m1, s.bone->octree.total().m1);
    for (std::size_t i = 0; i < s.revision.size(); ++i) {
        const auto first = static_cast<std::ptrdiff_t>(i * kVoxels);
        const bool same = std::equal(s.density.begin() + first, s.density.begin() + first + kVoxels,
                                     s.baked_density.begin() + first);
        EXPECT_EQ(s.revision[i] == 0, same) << i;
    }
    for (std::size_t k = 6; k > 0; --k) {
        s.exchange(s.bone->strokes.undo());
        ASSERT_EQ(s.density, states[k - 1]) << k;
    }
    EXPECT_FALSE(s.bone->strokes.undo());
}

TEST(ResumeBone, knows_what_was_undone_and_can_redo_it) {
    Site s;
    s.stroke(-3e-3);
    s.stroke(-1e-3);
    const auto two = s.density;
    s.stroke(1e-3);
    s.exchange(s.bone->strokes.undo());
    s.keep();
    s.exchange(s.bone->strokes.undo());
    s.keep();
    s.exchange(s.bone->strokes.redo());
    s.keep();
    ASSERT_EQ(s.density, two);
    s.resume();
    EXPECT_EQ(s.density, two);
    EXPECT_EQ(s.bone->strokes.strokes(), 2U);
    s.exchange(s.bone->strokes.undo());
    s.exchange(s.bone->strokes.redo());
    EXPECT_EQ(s.density, two);
    // The file says what the second stroke is, since it was redone.
    s.exchange(s.bone->strokes.undo());
    s.exchange(s.bone->strokes.undo());
    EXPECT_EQ(s.density, s.baked_density);
}

TEST(ResumeBone, strokes_from_before_the_file_cannot_be_undone) {
    Site s;
    s.stroke(-3e-3);
    // A keeper that started after it: the first frame is all that differs.
    s.out.reset();
    fs::remove(s.file());
    s.out =
        std::make_unique<DrilledBoneWriter>(s.file(), drilled_bone_head(s.baked.bricks, s.scene->checksum()));
    s.seen.assign(s.seen.size(), 0);
    s.stroke(1e-3);
    const auto second = s.density;
    s.resume();
    EXPECT_EQ(s.density, second);
    EXPECT_EQ(s.bone->strokes.strokes(), 2U);
    EXPECT_EQ(s.bone->strokes.undoable(), 1U);
}

TEST(ResumeBone, of_another_scene_is_refused) {
    Site s;
    s.stroke(0.0);
    std::vector<std::uint8_t> other = s.baked_density;
    other[5] = 254;
    BoneVolumeView view = s.baked;
    view.density = other;
    SceneWriter writer;
    write_bone_volume(writer, view);
    const auto bytes = writer.to_bytes();
    const SceneFile scene = SceneFile::from_bytes(bytes, "other");
    EXPECT_TRUE(says(sample::error_of([&] { resume_bone(s.file(), scene, *s.bone); }), {"another scene"}));
}

}  // namespace
}  // namespace tact::start_resume_bone_test
