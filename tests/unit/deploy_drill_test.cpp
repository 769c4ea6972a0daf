// Measurements of drilling: the same bone in each pass, and rows that follow from the model.
#include <gtest/gtest.h>

#include <fstream>

#include <nlohmann/json.hpp>

#include "deploy/tact/drilling/drilling.hpp"
#include "deploy/tact/files.hpp"
#include "ipc/base/error.hpp"
#include "ipc/scene/bone/bone_labels.hpp"
#include "ipc/scene/bone/bone_volume.hpp"
#include "ipc/scene/bone/patient_frame.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "tests/bench/bench_drilling.hpp"
#include "tests/bench/drill_run.hpp"
#include "tests/reproduce/drilling.hpp"

namespace tact::launch::deploy_drill_test {
namespace {

TEST(DrillRun, repeats_the_same_path_through_fresh_bone_in_every_pass) {
    BoneSample once = bone_block({64, 64, 64}, 3e-4), thrice = once;
    std::vector<Vec3> path = drill_stroke_m(once, 1e-3, 900);
    for (Vec3& at : path) at.z() -= 8e-4;
    const auto a = drill_along(once, path, {.radius_m = 1e-3, .passes = 1, .count_voxels = true});
    const auto b = drill_along(thrice, path, {.radius_m = 1e-3, .passes = 3});
    std::uint64_t levels = 0, voxels = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
        ASSERT_EQ(a[i].force_n, b[i].force_n) << i;
        ASSERT_EQ(a[i].removed_levels, b[i].removed_levels) << i;
        levels += a[i].removed_levels;
        voxels += a[i].removed_voxels;
    }
    EXPECT_EQ(once.density, thrice.density);
    EXPECT_GT(levels, 1000U);
    EXPECT_GT(voxels, 0U);
    // The steps report exactly the missing voxels.
    const BoneSample fresh = bone_block({64, 64, 64}, 3e-4);
    std::uint64_t missing = 0, gone = 0;
    for (std::size_t v = 0; v < fresh.density.size(); ++v) {
        missing += fresh.density[v] - once.density[v];
        gone += fresh.density[v] > 0 && once.density[v] == 0 ? 1 : 0;
    }
    EXPECT_EQ(missing, levels);
    EXPECT_EQ(gone, voxels);
    EXPECT_GT(times_us(a).p50, 0.0);
    EXPECT_EQ(times_us(a).max, best_times_us(a).max);  // of one pass
    for (const DrillStep& s : b) ASSERT_LE(s.best_us, s.us);
}

TEST(DrillRun, a_users_volume_is_drilled_along_a_users_path) {
    const ScratchFolder scratch;
    const auto volume = scratch.path() / "v.raw", way = scratch.path() / "way.txt";
    std::ofstream(volume, std::ios::binary) << std::string(24 * 16 * 16, '\xff');
    std::ofstream(way) << "# mm\n3.6 2.4 2.4\n3.7 2.4 2.4\n\n3.8 2.4 2.4\n";
    DrillingWork work{.volume = volume, .trajectory = way, .size = {24, 16, 16}, .radius_mm = 1.0};
    const std::string csv = drilling_work_csv(work);
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 4);  // a header and three positions
    work.size = {24, 16, 15};
    EXPECT_THROW(drilling_work_csv(work), StartupError);
    std::ofstream(way) << "1 2\n";
    work.size = {24, 16, 16};
    EXPECT_THROW(drilling_work_csv(work), StartupError);
}

TEST(DrillingRows, the_force_rises_with_the_penetration_and_blocks_are_near_the_voxels) {
    const auto rows = drilling_rows(3.0, 10, 1, false);
    ASSERT_EQ(rows.size(), 10U);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_GT(rows[i].true_n, i > 0 ? rows[i - 1].true_n : 0.0);
        if (rows[i].true_n < 0.05) continue;
        for (std::size_t way = 0; way < kDrillWays; ++way)
            EXPECT_NEAR(rows[i].force_n[way] / rows[i].true_n, 1.0, 0.1) << i << ' ' << way;
    }
    EXPECT_NEAR(rows.back().penetration_mm, 3.0, 1e-12);
}

TEST(DrillingInfo, has_all_data_for_another_program_to_compute_the_same) {
    BoneSample bone = bone_block({16, 16, 16}, 5e-4);
    std::vector<std::uint8_t> label(bone.bricks.bytes(), 0);
    for (std::uint32_t x = 0; x < 4; ++x) label[bone.bricks.voxel(x, 3, 3)] = 1;
    SceneWriter out;
    SceneMeta meta{};
    meta.kind = SceneKind::drilling;
    meta.world_per_model = 1.0;
    write_meta(out, meta, "made by: a test\n");
    write_bone_volume(out, {.bricks = bone.bricks, .density = bone.density});
    write_bone_labels(out, bone.bricks, {.structure = {{"nerve", {255, 255, 0, 255}, true}}, .label = label});
    PatientFrame frame;  // the model's x to the head, y to the left, z to the back
    frame.axes << 0, 1, 0, 0, 0, 1, 1, 0, 0;
    frame.origin_mm = Vec3(4.0, -5.0, 6.0);
    write_patient_frame(out, frame);
    const ScratchFolder scratch;
    const auto path = scratch.path() / "bone.tact";
    const std::vector<std::byte> bytes = out.to_bytes();
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    const nlohmann::json told = drilling_info(SceneFile::open(path));
    EXPECT_EQ(told["bone"]["size_voxels"], (std::vector<int>{16, 16, 16}));
    EXPECT_DOUBLE_EQ(told["bone"]["voxel_mm"], 0.5);
    double mass = 0.0;
    for (const std::uint8_t d : bone.density) mass += d / 255.0;
    EXPECT_NEAR(told["bone"]["solid_volume_mm3"].get<double>(), 0.125 * mass, 1e-9);
    ASSERT_EQ(told["structures"].size(), 1U);
    EXPECT_EQ(told["structures"][0]["name"], "nerve");
    EXPECT_DOUBLE_EQ(told["structures"][0]["volume_mm3"], 0.5);
    EXPECT_TRUE(told["structures"][0]["distance_error_mm"].is_null());
    EXPECT_EQ(told["elastic_pa"], BurrLaw{}.elastic_pa);
    const auto& axes = told["patient"]["model_axes"];
    EXPECT_EQ(axes["x"]["to"], "H");
    EXPECT_EQ(axes["y"]["to"], "L");
    EXPECT_EQ(axes["z"]["direction_lps"], (std::vector<double>{0.0, 1.0, 0.0}));
    EXPECT_EQ(told["patient"]["origin_lps_mm"], (std::vector<double>{4.0, -5.0, 6.0}));
}

}  // namespace
}  // namespace tact::launch::deploy_drill_test
