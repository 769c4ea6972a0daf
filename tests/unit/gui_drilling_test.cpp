// Drilling metrics: distances to structures, strokes, a trainee's results, the report.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "gui/drilling/drill_metrics.hpp"
#include "gui/drilling/drill_report.hpp"
#include "ipc/base/error.hpp"

namespace tact::gui_drilling_test {
namespace {

// A cube of 16 mm of bone; a nerve begins at x = 10 mm, and beyond x = 0 is a sinus.
struct Ear {
    static constexpr std::uint32_t kEdge = 32;
    static constexpr double kVoxelM = 5e-4;
    BoneBricks bricks;
    std::vector<std::uint8_t> label;
    BoneLabelsView labels;
    std::vector<std::int16_t> to_nerve, to_sinus;
    std::vector<DistanceField> fields;
    SceneMeta meta{};

    Ear() {
        bricks.size = {kEdge, kEdge, kEdge};
        bricks.voxel_m = kVoxelM;
        label.assign(bricks.bytes(), 0);
        for (std::uint32_t z = 0; z < kEdge; ++z)
            for (std::uint32_t y = 0; y < kEdge; ++y)
                for (std::uint32_t x = 20; x < kEdge; ++x) label[bricks.voxel(x, y, z)] = x < 24 ? 1 : 3;
        labels.structure = {{"facial nerve", {255, 221, 64, 255}, true},
                            {"sinus", {56, 92, 200, 255}, true},
                            {"malleus", {238, 226, 190, 255}, false}};
        labels.label = label;
        fields = {plane(1, to_nerve, [](double x) { return 10e-3 - x; }),
                  plane(2, to_sinus, [](double x) { return x; })};
        meta.kind = SceneKind::drilling;
        meta.world_per_model = 1.0;
        meta.centre_model_m[0] = 8e-3;
    }
    template <class Distance>
    DistanceField plane(std::uint32_t of, std::vector<std::int16_t>& quanta, const Distance& distance) {
        DistanceField f;
        f.label = of;
        f.size = {17, 17, 17};
        f.spacing_m = 1e-3;
        f.quantum_m = 1e-5;
        for (std::size_t i = 0; i < f.points(); ++i)
            quanta.push_back(static_cast<std::int16_t>(
                std::lround(distance(1e-3 * static_cast<double>(i % 17)) / f.quantum_m)));
        f.quanta = quanta;
        return f;
    }
};

DrillTopic tools(double x_m) {
    DrillTopic t{};
    t.level_m3 = std::pow(Ear::kVoxelM, 3) / 255.0;
    DrillHand& burr = t.hand[0];
    burr.kind = DrillKind::burr;
    burr.pos_model_m[0] = x_m;
    burr.pos_model_m[1] = burr.pos_model_m[2] = 8e-3;
    burr.quat_model_tool_xyzw[3] = 1.0;
    burr.radius_m = burr.tip_radius_m = 2e-3F;
    burr.length_m = 4e-3F;
    return t;
}

TEST(StructureWatch, gives_the_distance_of_the_head_and_its_approach_speed) {
    Ear ear;
    StructureWatch watch(ear.fields, 1.0);
    DrillTopic t = tools(3e-3);
    ASSERT_EQ(watch.look(t, 0).size(), 2U);
    EXPECT_TRUE(watch.look(t, 1).empty());  // that hand has no tool
    for (int i = 1; i <= 100; ++i) {        // 20 mm/s
        t.taken_at_ns = 10'000'000LL * i;
        t.hand[0].pos_model_m[0] = 3e-3 + 2e-4 * 0.1 * i;
        (void)watch.look(t, 0);
    }
    const auto now = watch.look(t, 0);
    EXPECT_EQ(now[0].label, 1U);
    EXPECT_NEAR(now[0].distance_m, 10e-3 - 5e-3 - 2e-3, 2e-5);
    EXPECT_NEAR(now[0].closing_m_s, 2e-3, 5e-4);
    EXPECT_NEAR(now[1].distance_m, 5e-3 - 2e-3, 2e-5);
    EXPECT_NEAR(now[1].closing_m_s, -2e-3, 5e-4);
    t.taken_at_ns += 5'000'000'000;  // after a pause the speed is unknown
    t.hand[0].pos_model_m[0] = 9e-3;
    EXPECT_EQ(watch.look(t, 0)[0].closing_m_s, 0.0);
    EXPECT_NEAR(watch.look(t, 0)[0].distance_m, -1e-3, 2e-5);
}

TEST(StructureWatch, says_on_which_side_of_the_burr_a_structure_lies) {
    Ear ear;
    StructureWatch watch(ear.fields, 1.0);
    const auto towards = [&](double x_m, std::size_t field) {
        DrillTopic t = tools(x_m);
        return watch.look(t, 0)[field].towards_model;
    };
    // The first structure lies at larger x, the second at smaller.
    EXPECT_NEAR((towards(3e-3, 0) - Vec3::UnitX()).norm(), 0.0, 0.05);
    EXPECT_NEAR((towards(3e-3, 1) + Vec3::UnitX()).norm(), 0.0, 0.05);
    // A patient whose left is the model's -x: it lies to the right.
    PatientFrame patient;
    patient.axes.col(0) = -Vec3::UnitX();
    patient.axes.col(1) = -Vec3::UnitY();
    EXPECT_EQ(patient_letters(patient.axes * towards(3e-3, 0)), "R");
    EXPECT_EQ(patient_letters(patient.axes * towards(3e-3, 1)), "L");
}

TEST(StructureWatch, a_long_head_is_measured_along_its_axis) {
    Ear ear;
    DrillTopic t = tools(5e-3);
    DrillHand& burr = t.hand[0];
    burr.shape = DrillShape::cylinder;
    burr.radius_m = 1e-3F;
    burr.length_m = 8e-3F;
    // The tool's +z points along +x of the model: the far end is 4 mm ahead of the centre.
    burr.quat_model_tool_xyzw[1] = burr.quat_model_tool_xyzw[3] = std::sqrt(0.5);
    EXPECT_NEAR(distance_m(ear.fields[0], head_balls(burr, 1.0), 1.0), 1e-3, 2e-5);
    burr.shape = DrillShape::cone;
    burr.tip_radius_m = 5e-4F;
    EXPECT_NEAR(distance_m(ear.fields[1], head_balls(burr, 1.0), 1.0), 1e-3, 2e-5);
    // In world units the distance doubles.
    EXPECT_NEAR(distance_m(ear.fields[0], head_balls(tools(5e-3).hand[0], 2.0), 2.0), 8e-3, 4e-5);
}

TEST(Strokes, are_counted_from_turning_point_to_turning_point) {
    Strokes strokes;
    const auto at = [](double t) { return Vec3(5e-3 * std::sin(2.0 * std::numbers::pi * t), 1e-4 * t, 0.0); };
    for (int i = 0; i <= 4250; ++i) strokes.step(1e-3 * i, at(1e-3 * i), true);
    // One half stroke from the centre, eight full strokes, and one in progress.
    const StrokeMetrics f = strokes.metrics();
    EXPECT_EQ(f.count, 9U);
    EXPECT_NEAR(f.length_m, 5e-3 + 8 * 10e-3, 1e-3);
    EXPECT_NEAR(f.mean_speed_m_s(), 0.02, 2e-3);
}

TEST(Strokes, end_after_a_pause_in_cutting_and_short_ones_do_not_count) {
    Strokes strokes;
    for (int i = 0; i < 1000; ++i) strokes.step(1e-3 * i, Vec3(2e-5 * i, 0, 0), i < 300);
    EXPECT_EQ(strokes.metrics().count, 1U);
    EXPECT_NEAR(strokes.metrics().length_m, 2e-5 * 450,
                1e-4);  // a pause counts until it is recognised
    Strokes trembling;
    for (int i = 0; i < 1000; ++i) trembling.step(1e-3 * i, Vec3(3e-4 * std::sin(0.1 * i), 0, 0), true);
    EXPECT_EQ(trembling.metrics().count, 0U);
    EXPECT_EQ(Strokes().metrics().mean_length_m(), 0.0);
}

TraceTopic cycle(int ms, double x_m, double force_n, std::uint32_t flags) {
    TraceTopic t{};
    t.taken_at_ns = 1'000'000LL * ms;
    t.pos_world_m[0] = static_cast<float>(x_m - 8e-3);
    t.pos_world_m[1] = t.pos_world_m[2] = 8e-3F;
    t.force_world_n[2] = static_cast<float>(force_n);
    t.status = flags;
    return t;
}

TEST(DrillMetrics, add_up_times_forces_and_nearness_of_every_cycle) {
    Ear ear;
    DrillMetrics m(ear.bricks, ear.labels, ear.fields, ear.meta);
    m.tools(tools(5e-3));
    int ms = 0;
    const auto for_ms = [&](int n, double x_m, double force_n, std::uint32_t flags) {
        for (int i = 0; i < n; ++i) m.cycle(cycle(++ms, x_m, force_n, flags));
    };
    for_ms(1001, 5e-3, 3.0, 0);                              // burr off
    for_ms(1000, 5e-3, 1.0, kTraceBurrTurns | kTraceCuts);   // 3 mm from both
    for_ms(500, 6.5e-3, 2.5, kTraceBurrTurns);               // 1.5 mm from the nerve
    for_ms(250, 7.5e-3, 1.0, kTraceBurrTurns | kTraceCuts);  // 0.5 mm
    ms += 10000;                                             // no data
    m.unseen(10000);
    for_ms(1, 7.5e-3, 1.0, kTraceBurrTurns);
    m.cycle(cycle(++ms, std::nan(""), 1.0, kTraceBurrTurns));  // a non-finite position is ignored
    const DrillMetricsRow f = m.metrics();
    EXPECT_NEAR(f.seen_s, 2.75, 0.003);
    EXPECT_NEAR(f.drilling_s, 1.75, 0.003);
    EXPECT_NEAR(f.cutting_s, 1.25, 0.003);
    EXPECT_NEAR(f.force_cutting_n(), 1.0, 1e-3);
    EXPECT_NEAR(f.force_n_most, 2.5, 1e-6);
    EXPECT_NEAR(f.excess_s, 0.5, 0.003);
    EXPECT_NEAR(f.near_s[0], 0.25, 0.003);
    EXPECT_NEAR(f.near_s[1], 0.75, 0.003);
    EXPECT_NEAR(f.structure[1].nearest_m, 5e-4, 3e-5);
    EXPECT_NEAR(f.structure[2].nearest_m, 3e-3, 3e-5);
    EXPECT_EQ(f.structure[2].near_s[1], 0.0);
    EXPECT_NEAR(f.path_m, 2.5e-3, 4e-4);
    EXPECT_EQ(f.unseen_cycles, 10000U);
}

struct Brick {
    std::vector<std::uint8_t> before = std::vector<std::uint8_t>(BoneBricks::kVoxels, 200), after = before;
};

TEST(DrillMetrics, split_removed_bone_by_structure_and_nearness_and_count_injuries) {
    Ear ear;
    DrillMetrics m(ear.bricks, ear.labels, ear.fields, ear.meta);
    // The third brick along x: voxels 16 to 23; 20 to 23 are the nerve, whose surface is at 10 mm.
    Brick b;
    b.after[0] = 100;  // voxel 16, 2 mm away: the range of the fields
    b.after[3] = 150;  // voxel 19, 0.5 mm
    EXPECT_EQ(m.brick(2, b.before, b.after, true), 0);
    Brick c;
    c.after[5] = 190;  // in the nerve
    m.cycle(cycle(5000, 5e-3, 0.0, 0));
    EXPECT_EQ(m.brick(2, c.before, c.after, true), 1);
    EXPECT_EQ(m.brick(2, c.before, c.after, true), 0);  // the same injury
    m.cycle(cycle(7000, 5e-3, 0.0, 0));
    EXPECT_EQ(m.brick(2, c.before, c.after, true), 1);
    EXPECT_EQ(m.brick(2, c.before, c.after, false), 0);  // not a new cut
    // A structure that is not critical cannot be injured.
    Brick d;
    d.after[0] = 0;
    EXPECT_EQ(m.brick(3, d.before, d.after, true), 0);
    EXPECT_EQ(m.brick(1000, d.before, d.after, true), 0);
    const DrillMetricsRow f = m.metrics();
    EXPECT_EQ(f.structure[0].removed_levels, 150U);
    EXPECT_EQ(f.structure[1].removed_levels, 40U);
    EXPECT_EQ(f.structure[3].removed_levels, 200U);
    EXPECT_EQ(f.removed_levels, 390U);
    EXPECT_EQ(f.injuries, 2U);
    EXPECT_EQ(f.structure[1].injuries, 2U);
    EXPECT_EQ(f.near_levels[0], 50U + 40U + 200U);  // inside the surface distances are negative
    EXPECT_GE(f.near_levels[1], f.near_levels[0]);
    // Strokes are undone: the bone is no longer removed, and injuries stay. Bone that never was removed is no debt.
    m.cycle(cycle(9000, 5e-3, 0.0, 0));
    EXPECT_EQ(m.brick(3, d.after, d.before, true), 0);
    EXPECT_EQ(m.brick(2, c.after, c.before, true), 0);
    const DrillMetricsRow u = m.metrics();
    EXPECT_EQ(u.structure[3].removed_levels, 0U);
    EXPECT_EQ(u.structure[1].removed_levels, 30U);
    EXPECT_EQ(u.removed_levels, 180U);
    EXPECT_EQ(u.near_levels[0], 50U + 30U);
    EXPECT_EQ(u.injuries, 2U);
    for (int i = 0; i < 9; ++i) m.brick(3, d.after, d.before, true);
    EXPECT_EQ(m.metrics().removed_levels, 0U);
    EXPECT_EQ(m.metrics().structure[3].removed_levels, 0U);
    EXPECT_EQ(m.metrics().near_levels[0], 0U);
}

TEST(DrillMetrics, each_burr_has_its_own_times_and_bone) {
    Ear ear;
    DrillMetrics m(ear.bricks, ear.labels, ear.fields, ear.meta);
    DrillTopic t = tools(5e-3);
    const auto use = [&](float radius_m, DrillGrit grit, std::uint64_t levels) {
        t.hand[0].radius_m = radius_m;
        t.hand[0].grit = grit;
        t.hand[0].removed_levels += levels;
        m.tools(t);
    };
    int ms = 0;
    const auto drill = [&](int cycles, std::uint32_t flags) {
        for (int i = 0; i < cycles; ++i) m.cycle(cycle(++ms, 5e-3, 0.5, flags));
    };
    t.hand[0].removed_levels = 1000;  // by a burr before the window looked
    use(2e-3F, DrillGrit::cutting, 0);
    drill(101, kTraceBurrTurns | kTraceCuts);
    use(2e-3F, DrillGrit::cutting, 300);
    use(1e-3F, DrillGrit::diamond, 20);  // the last of the first burr
    drill(200, kTraceBurrTurns);
    use(1e-3F, DrillGrit::diamond, 7);
    use(2e-3F, DrillGrit::cutting, 0);
    drill(50, kTraceBurrTurns | kTraceCuts);
    use(2e-3F, DrillGrit::cutting, 5);
    const std::vector<BurrUse> burrs = m.metrics().burr;
    ASSERT_EQ(burrs.size(), 2U);
    EXPECT_NEAR(burrs[0].diameter_m, 4e-3, 1e-9);
    EXPECT_EQ(burrs[0].grit, DrillGrit::cutting);
    EXPECT_NEAR(burrs[0].drilling_s, 0.150, 1e-9);
    EXPECT_NEAR(burrs[0].cutting_s, 0.150, 1e-9);
    EXPECT_EQ(burrs[0].removed_levels, 325U);
    EXPECT_EQ(burrs[1].grit, DrillGrit::diamond);
    EXPECT_NEAR(burrs[1].drilling_s, 0.200, 1e-9);
    EXPECT_EQ(burrs[1].cutting_s, 0.0);
    EXPECT_EQ(burrs[1].removed_levels, 7U);
    const nlohmann::json j = drill_report(m.metrics(), ear.labels, {});
    EXPECT_EQ(j["burrs"][1]["grit"], "diamond");
    EXPECT_EQ(j["burrs"][0]["shape"], "sphere");
    EXPECT_NEAR(j["burrs"][0]["removed_mm3"].get<double>(), 325.0 * 1e9 * m.metrics().level_m3, 1e-9);
    // More kinds than a run ever has: the table stays bounded.
    for (int i = 0; i < 1000; ++i) use(1e-3F + 2e-5F * static_cast<float>(i), DrillGrit::cutting, 1);
    EXPECT_LE(m.metrics().burr.size(), 64U);
}

TEST(DrillMetrics, bone_on_all_sides_counts_when_it_lasts) {
    Ear ear;
    DrillMetrics m(ear.bricks, ear.labels, ear.fields, ear.meta);
    m.tools(tools(5e-3));
    int ms = 0;
    const auto run = [&](int n, std::uint32_t flags) {
        for (int i = 0; i < n; ++i) m.cycle(cycle(++ms, 5e-3, 1.0, flags));
        return m.held_in();
    };
    EXPECT_FALSE(run(1000, kTraceBurrTurns));
    EXPECT_FALSE(run(20, kTraceHeldIn));
    EXPECT_TRUE(run(1000, kTraceHeldIn));
    EXPECT_FALSE(run(1000, kTraceCuts));
}

TEST(DrillReport, contains_the_metrics_and_null_for_unknown_ones) {
    Ear ear;
    DrillMetrics m(ear.bricks, ear.labels, ear.fields, ear.meta);
    m.tools(tools(5e-3));
    nlohmann::json j = drill_report(m.metrics(), ear.labels, {});
    EXPECT_TRUE(j["force"]["mean_cutting_n"].is_null());
    EXPECT_TRUE(j["strokes"]["mean_length_mm"].is_null());
    EXPECT_TRUE(j["structures"][0]["nearest_mm"].is_null());
    EXPECT_EQ(j["injuries"], 0);
    EXPECT_TRUE(j["burr_visible_share"].is_null());
    for (int i = 0; i < 1000; ++i) m.cycle(cycle(i, 5e-3, 1.0, kTraceBurrTurns | kTraceCuts));
    Brick b;
    b.after[5] = 145;  // 55 levels of the nerve
    (void)m.brick(2, b.before, b.after, true);
    j = drill_report(m.metrics(), ear.labels, BurrVisibility{8.0, 6.0});
    EXPECT_NEAR(j["drilling_s"].get<double>(), 0.999, 1e-3);
    EXPECT_NEAR(j["removed_mm3"].get<double>(), 55.0 / 255.0 * 0.125, 1e-9);
    EXPECT_EQ(j["burr_visible_share"], 0.75);
    EXPECT_EQ(j["structures"][0]["name"], "facial nerve");
    EXPECT_NEAR(j["structures"][0]["nearest_mm"].get<double>(), 3.0, 0.03);
    EXPECT_FALSE(j["structures"][0].contains("nearest_at_patient_mm")) << "the scan does not say where";
    PatientFrame patient;
    patient.origin_mm = Vec3(100.0, 200.0, 300.0);
    const auto at =
        drill_report(m.metrics(), ear.labels, {}, patient)["structures"][0]["nearest_at_patient_mm"];
    EXPECT_NEAR(at.at(0).get<double>() - 100.0, 1e3 * m.metrics().structure[1].nearest_at_model_m.x(), 1e-6);
    EXPECT_NEAR(at.at(2).get<double>() - 300.0, 1e3 * m.metrics().structure[1].nearest_at_model_m.z(), 1e-6);
    EXPECT_EQ(j["structures"][0]["injuries"], 1);
    EXPECT_FALSE(j["structures"][2].contains("nearest_mm"));  // not critical
    // Without labels there is no critical structure to avoid.
    const BoneLabelsView none;
    DrillMetrics bare(ear.bricks, none, {}, ear.meta);
    (void)bare.brick(2, b.before, b.after, true);
    j = drill_report(bare.metrics(), none, BurrVisibility{});
    EXPECT_TRUE(j["burr_visible_share"].is_null());  // the burr never ran
    EXPECT_TRUE(j["near_critical"].is_null());
    EXPECT_TRUE(j["injuries"].is_null());
    EXPECT_NEAR(j["removed_bone_mm3"].get<double>(), 55.0 / 255.0 * 0.125, 1e-9);
}

TEST(DrillReport, is_written_completely_or_not_at_all) {
    const auto path =
        std::filesystem::temp_directory_path() / ("drilling-" + std::to_string(getpid()) + ".json");
    write_drill_report(path, {{"a", 1}});
    std::ifstream in(path);
    EXPECT_EQ(nlohmann::json::parse(in)["a"], 1);
    std::filesystem::remove(path);
    EXPECT_THROW(write_drill_report("/nowhere/at/all.json", {}), StartupError);
}

}  // namespace
}  // namespace tact::gui_drilling_test
