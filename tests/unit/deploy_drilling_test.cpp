// The drilling part of a run's report, and the files of a scan.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "deploy/tact/drilling/drilling.hpp"
#include "deploy/tact/drilling/kept_bone.hpp"
#include "deploy/tact/drilling/report_drilling.hpp"
#include "deploy/tact/files.hpp"
#include "deploy/tact/run_options.hpp"
#include "deploy/tact/scene_cache.hpp"
#include "ipc/base/error.hpp"

namespace tact::launch::deploy_drilling_test {
namespace {

DrillTopic two_tools() {
    DrillTopic t{};
    t.removed_levels = 2'550'000;
    t.level_m3 = 1e-9 / 2550.0;
    t.burr_rad_s_most = 6283.1853F;
    t.irrigation_m3_s_most = static_cast<float>(20e-6 / 60.0);
    t.suction_m3_s_most = static_cast<float>(20e-3 / 60.0);
    t.hand[0].kind = DrillKind::burr;
    t.hand[0].shape = DrillShape::cone;
    t.hand[0].radius_m = 3e-3F;
    t.hand[0].length_m = 8e-3F;
    t.hand[0].shaft_radius_m = 1.2e-3F;
    t.hand[1].kind = DrillKind::suction_tube;
    t.hand[1].radius_m = 1e-3F;
    return t;
}

TEST(DrillingReport, has_tools_in_common_units_and_the_removed_volume) {
    const auto region = std::make_unique<RtRegion>();
    EXPECT_TRUE(drilling_report(*region, {}).is_null());
    region->drill.publish(two_tools());
    const auto j = drilling_report(*region, {});
    EXPECT_NEAR(j["removed_mm3"].get<double>(), 1000.0, 1e-6);
    EXPECT_EQ(j["burr"]["shape"], "cone");
    EXPECT_NEAR(j["burr"]["diameter_mm"].get<double>(), 6.0, 1e-5);
    EXPECT_NEAR(j["burr"]["shaft_diameter_mm"].get<double>(), 2.4, 1e-5);
    EXPECT_NEAR(j["burr"]["rpm"].get<double>(), 60000.0, 0.1);
    EXPECT_NEAR(j["burr"]["irrigation_ml_min"].get<double>(), 20.0, 1e-4);
    EXPECT_NEAR(j["suction_tube"]["diameter_mm"].get<double>(), 2.0, 1e-5);
    EXPECT_NEAR(j["suction_tube"]["suction_l_min"].get<double>(), 20.0, 1e-4);
    EXPECT_TRUE(j["trainee"].is_null());
    EXPECT_EQ(drilling_summary(j), "bone removed: 1000.0 mm3\n");
    EXPECT_EQ(drilling_summary(nullptr), "");
}

TEST(DrillingReport, a_trainees_metrics_are_copied_and_printed) {
    const ScratchFolder scratch;
    const auto file = scratch.path() / "trainee.json";
    const nlohmann::json trainee = {
        {"drilling_s", 40.0},
        {"cutting_s", 35.0},
        {"force", {{"mean_cutting_n", 0.5}, {"max_n", 2.5}, {"excess_above_n", 2.0}, {"excess_s", 1.5}}},
        {"strokes", {{"count", 71}, {"mean_length_mm", 6.2}, {"mean_speed_mm_s", 12.0}}},
        {"burr_visible_share", 0.7},
        {"near_critical",
         {{"drilling_within_1_mm_s", 1.0},
          {"drilling_within_2_mm_s", 3.0},
          {"removed_within_1_mm_mm3", 2.0},
          {"removed_within_2_mm_mm3", 5.0}}},
        {"injuries", 1},
        {"structures",
         {{{"name", "facial nerve"},
           {"critical", true},
           {"nearest_mm", 9.0},
           {"removed_mm3", 0.0},
           {"injuries", 0}},
          {{"name", "sinus"},
           {"critical", true},
           {"nearest_mm", -0.4},
           {"removed_mm3", 0.3},
           {"injuries", 1}}}}};
    std::ofstream(file) << trainee;
    const auto region = std::make_unique<RtRegion>();
    region->drill.publish(two_tools());
    const auto j = drilling_report(*region, file);
    EXPECT_EQ(j["trainee"], trainee);
    const std::string said = drilling_summary(j);
    for (const char* const words : {"drilling 40.0 s, of which cutting 35.0 s", "above 2.0 N for 1.5 s",
                                    "strokes: 71, mean length 6.2 mm, mean speed 12.0 mm/s",
                                    "visible for 70 %", "within 1 mm 1.0 s and 2.00 mm3; injuries 1",
                                    "sinus: burr inside by 0.4 mm, removed 0.30 mm3, injuries 1"})
        EXPECT_NE(said.find(words), std::string::npos) << words << "\n" << said;
    EXPECT_EQ(said.find("facial nerve"), std::string::npos);  // never near
}

TEST(DrillingReport, impossible_values_are_left_out) {
    const ScratchFolder scratch;
    const auto file = scratch.path() / "trainee.json";
    const auto region = std::make_unique<RtRegion>();
    DrillTopic t = two_tools();
    t.level_m3 = std::nan("");
    t.hand[0].shape = static_cast<DrillShape>(77);
    region->drill.publish(t);
    for (const char* const text :
         {"", "[1, 2", "7", R"({"force": 3, "structures": [4, {"nearest_mm": "near"}]})"}) {
        std::ofstream(file) << text;
        const auto j = drilling_report(*region, file);
        EXPECT_TRUE(j["burr"]["shape"].is_null());
        EXPECT_FALSE(drilling_summary(j).empty());
    }
}

TEST(ScanFiles, are_a_file_a_folder_or_a_header_with_its_data_file) {
    const ScratchFolder scratch;
    const auto touch = [&](const char* name) {
        std::ofstream(scratch.path() / name) << name;
        return scratch.path() / name;
    };
    const auto nrrd = touch("ear.nrrd"), header = touch("ear.mhd"), raw = touch("ear.raw");
    touch("ears.raw");
    std::filesystem::create_directory(scratch.path() / "series");
    const auto first = touch("series/1.dcm"), second = touch("series/2.dcm");
    std::filesystem::create_directory(scratch.path() / "series" / "more");
    EXPECT_EQ(scan_files(nrrd), std::vector{nrrd});
    EXPECT_EQ(scan_files(header), (std::vector{header, nrrd, raw}));
    EXPECT_EQ(scan_files(scratch.path() / "series"), (std::vector{first, second}));
}

TEST(LetTheHandsDrill, unless_another_hand_or_device_is_requested) {
    RunOptions o;
    let_the_hands_drill(o);
    EXPECT_EQ(o.controller, (std::vector<std::string>{"--hand", "surgeon", "--hand2", "suction-tube"}));
    for (const char* const asked : {"--hand", "--config"}) {
        RunOptions other;
        other.controller = {asked, "x"};
        let_the_hands_drill(other);
        EXPECT_EQ(other.controller.size(), 2U);
    }
    RunOptions one;
    one.controller = {"--hand2", "passive"};
    let_the_hands_drill(one);
    EXPECT_EQ(one.controller.size(), 4U);
}

// A person at the window without a device; a choice of a hand, or of a configuration, is a choice against it.
TEST(MouseMayLead, in_a_window_where_no_hand_and_no_device_is_chosen) {
    RunOptions o;
    EXPECT_TRUE(mouse_may_lead(o));
    let_the_hands_drill(o);  // a motion that a system chose, not the person
    EXPECT_TRUE(mouse_may_lead(o));
    o.settle();
    EXPECT_EQ(std::count(o.controller.begin(), o.controller.end(), "--mouse"), 1);
    EXPECT_FALSE(mouse_may_lead(o)) << "once";
    o.forget_scene();
    EXPECT_TRUE(o.has_controller_option("--mouse")) << "also in the next scene";
    for (const char* const asked : {"--hand", "--hand2", "--config"}) {
        RunOptions other;
        other.controller = {asked, "x"};
        EXPECT_FALSE(mouse_may_lead(other)) << asked;
    }
    RunOptions no_person;
    no_person.headless = true;
    EXPECT_FALSE(mouse_may_lead(no_person));
    no_person.headless = no_person.gui = false;
    EXPECT_FALSE(mouse_may_lead(no_person));
}

// The oldest files of drilled bone make room for the next one, but never the one that a run starts with.
TEST(KeptBone, the_newest_files_stay_and_so_does_the_resumed_one) {
    namespace fs = std::filesystem;
    const fs::path state = fs::temp_directory_path() / ("tact-kept-" + std::to_string(getpid()));
    fs::remove_all(state);
    const char* const before = std::getenv("XDG_STATE_HOME");
    const std::string was = before != nullptr ? before : "";
    setenv("XDG_STATE_HOME", state.c_str(), 1);
    const fs::path folder = state / "tact" / "drilled";
    fs::create_directories(folder);
    const auto now = fs::file_time_type::clock::now();
    constexpr int kFiles = 25;
    for (int i = 0; i < kFiles; ++i) {
        const fs::path file = folder / (std::to_string(i) + ".bone");
        std::ofstream(file) << "bone";
        fs::last_write_time(file, now - std::chrono::minutes(kFiles - i));
    }
    std::ofstream(folder / "notes.txt") << "of a person";
    const fs::path next = new_bone_file("/scenes/left ear.tact", folder / "0.bone");
    EXPECT_EQ(next.parent_path(), folder);
    EXPECT_EQ(next.filename().string().rfind("left ear-", 0), 0U);
    EXPECT_FALSE(fs::exists(next));
    for (int i = 0; i < kFiles; ++i)
        EXPECT_EQ(fs::exists(folder / (std::to_string(i) + ".bone")),
                  i == 0 || i > kFiles - static_cast<int>(kBoneFilesKept))
            << i;
    EXPECT_TRUE(fs::exists(folder / "notes.txt"));
    std::ofstream(next) << "bone";
    EXPECT_NE(new_bone_file("/scenes/left ear.tact", {}), next);  // in the same second, too
    EXPECT_THROW(static_cast<void>(last_bone_file(7)), StartupError);
    if (before != nullptr)
        setenv("XDG_STATE_HOME", was.c_str(), 1);
    else
        unsetenv("XDG_STATE_HOME");
    fs::remove_all(state);
}

}  // namespace
}  // namespace tact::launch::deploy_drilling_test
