// The window's controller for drilling with a hand-published controller: displayed data, messages, report.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "gui/drilling/drill_controller.hpp"
#include "gui/window/load_scene.hpp"
#include "tests/unit/gui_fake.hpp"

namespace tact::gui_drill_controller_test {
namespace {

constexpr double kVoxelM = 5e-4;

// A cube of 16 mm of bone; a nerve begins at x = 10 mm.
void write_ear(const std::filesystem::path& path) {
    BoneBricks bricks;
    bricks.size = {32, 32, 32};
    bricks.voxel_m = kVoxelM;
    std::vector<std::uint8_t> density(bricks.bytes(), 200), label(bricks.bytes(), 0);
    for (std::uint32_t z = 0; z < 32; ++z)
        for (std::uint32_t y = 0; y < 32; ++y)
            for (std::uint32_t x = 20; x < 32; ++x) label[bricks.voxel(x, y, z)] = 1;
    DistanceField field;
    field.label = 1;
    field.size = {17, 17, 17};
    field.spacing_m = 1e-3;
    field.quantum_m = 1e-5;
    field.error_m = 1e-4;
    std::vector<std::int16_t> quanta;
    for (int i = 0; i < 17 * 17 * 17; ++i) quanta.push_back(static_cast<std::int16_t>(1000 - 100 * (i % 17)));
    field.quanta = quanta;
    SceneMeta meta{};
    meta.kind = SceneKind::drilling;
    meta.world_per_model = 1.0;
    SceneWriter out;
    BoneVolumeView volume;
    volume.bricks = bricks;
    volume.density = density;
    write_bone_volume(out, volume);
    write_distance_field(out, 0, field);
    BoneLabelsView labels;
    labels.structure = {{"facial nerve", {255, 221, 64, 255}, true}};
    labels.label = label;
    write_bone_labels(out, bricks, labels);
    write_meta(out, meta, "bone: made by a test\n");
    out.write(path);
}

class DrillControllerTest : public testing::Test {
protected:
    void SetUp() override {
        std::string name = (std::filesystem::temp_directory_path() / "tact-dashboard-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        folder_ = name;
        setenv("TACT_RUNTIME_DIR", name.c_str(), 1);
        write_ear(folder_ / "ear.tact");
        content_ = load_scene(folder_ / "ear.tact");
        running_.emplace("dashboard", (folder_ / "ear.tact").string(), content_->checksum);
        own_.mark_ready();
        gui_.emplace("dashboard", own_.fd());
        dashboard_.use(content_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    void attach() {
        for (int i = 0; i < 2000 && !gui_->attached(); ++i) {
            running_->serve(2);
            if (gui_->poll().arrived) dashboard_.meet();
        }
        ASSERT_TRUE(gui_->attached());
    }
    // Publishes the burr's centre; its radius is 2 mm.
    void burr(double x_m, bool turns) {
        ms_ += 20;
        DrillTopic t{};
        t.taken_at_ns = 1'000'000LL * ms_;
        t.level_m3 = std::pow(kVoxelM, 3) / 255.0;
        t.removed_levels = 2550;
        t.burr_rad_s_most = 5000.0F;
        t.irrigation_m3_s_most = 3e-7F;
        t.suction_m3_s_most = 2e-4F;
        t.changing_burr = 1;
        DrillHand& h = t.hand[0];
        h.kind = DrillKind::burr;
        h.pos_model_m[0] = x_m;
        h.pos_model_m[1] = h.pos_model_m[2] = 8e-3;
        h.quat_model_tool_xyzw[3] = 1.0;
        h.radius_m = h.tip_radius_m = 2e-3F;
        h.length_m = 4e-3F;
        h.burr_rad_s = turns ? 6283.1853F : 0.0F;
        h.irrigation = turns ? 1.0F : 0.0F;
        t.hand[1] = h;
        t.hand[1].kind = DrillKind::suction_tube;
        t.hand[1].pos_model_m[0] = 4e-3;
        t.hand[1].burr_rad_s = t.hand[1].irrigation = 0.0F;
        t.hand[1].suction = 1.0F;
        running_->region().drill.publish(t);
        for (int i = 20; i > 0; --i) {
            TraceTopic c{};
            c.taken_at_ns = 1'000'000LL * (ms_ - i);
            c.pos_world_m[0] = static_cast<float>(x_m);
            c.pos_world_m[1] = c.pos_world_m[2] = 8e-3F;
            c.status = turns ? kTraceBurrTurns : 0U;
            running_->region().trace.push(c);
        }
        frame({});
    }
    void frame(std::span<const BrickChange> changes) {
        static_cast<void>(gui_->read());
        dashboard_.follow(*gui_, changes, state_, drilling_);
    }
    [[nodiscard]] long message(const std::string& text) const {
        return std::count_if(state_.events.begin(), state_.events.end(),
                             [&](const EventLine& e) { return e.text == text; });
    }

    std::filesystem::path folder_;
    std::shared_ptr<const SceneContent> content_;
    std::optional<fake::Controller> running_;
    OwnedRegion<GuiRegion> own_;
    std::optional<Controller> gui_;
    DrillController dashboard_;
    DashboardState state_;
    DrillingState drilling_;
    int ms_ = 0;
};

TEST_F(DrillControllerTest, shows_tools_and_distances_in_world_units) {
    frame({});
    EXPECT_FALSE(drilling_.known);
    EXPECT_TRUE(drilling_.labelled);
    attach();
    burr(5e-3, true);
    const DrillingState& d = drilling_;
    ASSERT_TRUE(d.known);
    EXPECT_NEAR(d.burr.diameter_m, 4e-3, 1e-8);
    EXPECT_NEAR(d.burr.rpm, 60000.0, 0.1);
    EXPECT_TRUE(d.burr.water && !d.burr.suction);
    EXPECT_TRUE(d.suction_tube.valid && d.suction_tube.suction && !d.suction_tube.water);
    EXPECT_EQ(d.burr.grit, DrillGrit::cutting);
    EXPECT_NEAR(d.burr_rad_s_most, 5000.0, 1e-3);
    EXPECT_NEAR(d.irrigation_m3_s, 3e-7, 1e-12);
    EXPECT_NEAR(d.suction_m3_s, 2e-4, 1e-9);
    EXPECT_TRUE(d.changing_burr);
    EXPECT_NEAR(d.removed_m3, 10.0 * std::pow(kVoxelM, 3), 1e-15);
    ASSERT_EQ(d.structures.size(), 1U);
    EXPECT_EQ(d.structures[0].name, "facial nerve");
    EXPECT_NEAR(d.structures[0].burr_m, 3e-3, 2e-5);
    EXPECT_NEAR(d.structures[0].suction_tube_m, 4e-3, 2e-5);
    EXPECT_TRUE(state_.events.empty());
}

TEST_F(DrillControllerTest, reports_once_that_the_burr_is_near_and_again_only_after_retraction) {
    attach();
    burr(6.2e-3, false);  // 1.8 mm away, burr off
    EXPECT_TRUE(state_.events.empty());
    EXPECT_EQ(drilling_.nearness, Grade::good);
    burr(5e-3, true);
    EXPECT_EQ(drilling_.nearness, Grade::good);
    for (int i = 0; i < 5; ++i) burr(6.2e-3, true);
    EXPECT_EQ(message("burr 1.8 mm from the facial nerve"), 1);
    EXPECT_EQ(state_.events.front().grade, Grade::watch);
    EXPECT_EQ(drilling_.nearness, Grade::watch);
    for (int i = 0; i < 5; ++i) burr(7.1e-3, true);
    EXPECT_EQ(message("burr 0.9 mm from the facial nerve"), 1);
    EXPECT_EQ(state_.events.front().grade, Grade::bad);
    EXPECT_EQ(drilling_.nearness, Grade::bad);
    burr(6.9e-3, true);  // 1.1 mm: not far enough
    burr(7.1e-3, true);
    EXPECT_EQ(state_.events.size(), 2U);
    burr(6.5e-3, true);
    burr(7.1e-3, true);
    EXPECT_EQ(message("burr 0.9 mm from the facial nerve"), 2);
    burr(8.5e-3, true);  // still red
    EXPECT_EQ(state_.events.size(), 3U);
}

TEST_F(DrillControllerTest, an_injury_is_displayed_and_reported) {
    attach();
    burr(6e-3, true);
    std::vector<std::uint8_t> before(BoneBricks::kVoxels, 200), after = before;
    after[5] = 100;  // in the third brick: the nerve
    const BrickChange change{2, before, after, true};
    frame({&change, 1});
    EXPECT_EQ(message("facial nerve cut"), 1);
    EXPECT_EQ(drilling_.injuries, 1U);
    const auto file = folder_ / "report.json";
    dashboard_.save("", std::nullopt);
    EXPECT_FALSE(std::filesystem::exists(file));
    dashboard_.save(file.string(), BurrVisibility{4.0, 3.0});
    std::ifstream in(file);
    const auto report = nlohmann::json::parse(in);
    EXPECT_EQ(report["injuries"], 1);
    EXPECT_EQ(report["burr_visible_share"], 0.75);
    EXPECT_EQ(report["structures"][0]["injuries"], 1);
    EXPECT_GT(report["drilling_s"].get<double>(), 0.015);
}

TEST_F(DrillControllerTest, unseen_cycles_are_counted) {
    attach();
    burr(5e-3, true);
    TraceTopic c{};
    for (int i = 0; i < 20000; ++i) running_->region().trace.push(c);  // more than the ring holds
    frame({});
    const auto file = folder_ / "report.json";
    dashboard_.save(file.string(), std::nullopt);
    std::ifstream in(file);
    EXPECT_GT(nlohmann::json::parse(in)["unseen_cycles"].get<int>(), 3000);
}

}  // namespace
}  // namespace tact::gui_drill_controller_test
