// Dropped files through the window's callback: messages, baking by `tact`, cancelling, refusals.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "gui/window/browser_controller.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/image/png.hpp"
#include "ipc/scene/bone/bone_labels.hpp"
#include "ipc/scene/bone/bone_volume.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/scene/file/scene_switch.hpp"
#include "tests/support/map_file.hpp"

namespace tact::gui_import_test {
namespace {

class Import : public testing::Test {
protected:
    void SetUp() override {
        char name[] = "/tmp/tact-import-test-XXXXXX";
        folder_ = mkdtemp(name);
        setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);
        setenv("XDG_STATE_HOME", (folder_ / "state").c_str(), 1);
        setenv("PATH", std::string(TACT_FOLDER).append(":").append(std::getenv("PATH")).c_str(), 1);
        std::ofstream(folder_ / "tetra.obj") << "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\n"
                                                "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
        std::ofstream(folder_ / "wrong.ply") << "no mesh";
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    void until_done(BrowserController& dashboard) {
        const Instant until = Monotonic::now() + std::chrono::minutes(2);
        do {
            dashboard.follow(state_);
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        } while (state_.importing && Monotonic::now() < until);
        EXPECT_FALSE(state_.importing);
    }
    static void write_map(const std::string& file) {
        DensityGrid grid;
        grid.size = {16, 16, 16};
        grid.spacing_m = Vec3::Constant(kAngstromM);
        for (int i = 0; i < 16 * 16 * 16; ++i) {
            const Vec3 at(i % 16 - 6.0, i / 16 % 16 - 6.0, i / 256 - 6.0);
            grid.values.push_back(static_cast<float>(std::exp(-at.squaredNorm() / 8.0)));
        }
        std::ofstream(file, std::ios::binary) << map_file_bytes(grid);
    }
    [[nodiscard]] std::size_t scenes() const {
        std::error_code none;
        std::size_t n = 0;
        for (const auto& each : std::filesystem::directory_iterator(folder_ / "cache" / "tact", none))
            n += each.is_regular_file() ? 1 : 0;
        return n;
    }
    std::filesystem::path folder_;
    BrowserState state_;
};

TEST_F(Import, a_mesh_is_baked_into_the_cache_and_its_scene_requested) {
    const auto scene_switch = folder_ / "scene_switch";
    std::filesystem::create_directory(scene_switch);
    BrowserController dashboard(scene_switch);
    dashboard.drop({folder_ / "tetra.obj"}, state_);
    until_done(dashboard);
    const auto asked = take_asked_scene(scene_switch);
    ASSERT_TRUE(asked) << state_.message;
    EXPECT_EQ(asked->parent_path(), folder_ / "cache" / "tact");
    EXPECT_TRUE(std::filesystem::exists(*asked));
    refuse_scene(scene_switch, "not now");
    dashboard.follow(state_);
    EXPECT_EQ(state_.message, "not now");
    EXPECT_EQ(state_.message_grade, Grade::bad);
}

TEST_F(Import, clicked_rows_are_marked_and_imported_together) {
    BrowserController dashboard({});
    state_.open = true;
    state_.folder = folder_;
    const auto row = [&](const char* name) -> SceneRow& {
        const auto found = std::find_if(state_.here.begin(), state_.here.end(),
                                        [&](const SceneRow& each) { return each.name == name; });
        EXPECT_NE(found, state_.here.end()) << name;
        return *found;
    };
    const auto press = [&](const std::string& file) {
        state_.mark_wanted = file;
        dashboard.follow(state_);
    };
    dashboard.follow(state_);
    while (state_.reading) dashboard.follow(state_);
    ASSERT_FALSE(state_.here.empty());
    EXPECT_TRUE(state_.marks_text.empty());
    press(folder_ / "tetra.obj");
    EXPECT_TRUE(row("tetra.obj").marked && state_.marks_import);
    EXPECT_EQ(state_.marks_text, "Touch tetra.obj.");
    press(folder_ / "wrong.ply");
    EXPECT_TRUE(row("wrong.ply").marked && !state_.marks_import);
    EXPECT_EQ(state_.marks_text, "2 marked. One mesh at a time.");
    state_.import_wanted = true;  // the button is disabled now
    dashboard.follow(state_);
    EXPECT_FALSE(state_.importing);
    press(folder_ / "wrong.ply");
    EXPECT_TRUE(!row("wrong.ply").marked && row("tetra.obj").marked);
    state_.import_wanted = true;
    dashboard.follow(state_);
    EXPECT_TRUE(state_.marks_text.empty() && !row("tetra.obj").marked);
    until_done(dashboard);
    EXPECT_EQ(scenes(), 1U) << state_.message;
    for (std::size_t i = 0; i < 3 * kDroppedMost; ++i)
        press(std::string("/a/").append(std::to_string(i)).append(".pdb"));
    EXPECT_EQ(state_.marks_text.substr(0, 3), "18 ") << state_.marks_text;
    state_.clear_wanted = true;
    dashboard.follow(state_);
    EXPECT_TRUE(state_.marks_text.empty());
}

TEST_F(Import, a_map_is_imported_only_after_its_resolution_is_typed) {
    const std::string map = (folder_ / "map.mrc").string(), model = (folder_ / "a.pdb").string();
    write_map(map);
    std::ofstream(model)
        << "ATOM      1  CA  ALA A   1       6.000   6.000   6.000  1.00  0.00           C\n"
           "ATOM      2  CA  ALA A   2       8.000   7.000   6.000  1.00  0.00           C\n";
    BrowserController dashboard({});
    const auto type = [&](const char* words) {
        std::snprintf(state_.form->numbers[0].typed.data(), state_.form->numbers[0].typed.size(), "%s",
                      words);
        state_.form->answered = true;
        dashboard.follow(state_);
    };
    dashboard.drop({map, model}, state_);
    EXPECT_FALSE(state_.form) << "the files are read first";
    until_done(dashboard);
    ASSERT_TRUE(state_.form) << state_.message;
    EXPECT_EQ(state_.form->title, "Dock a.pdb into map.mrc.");
    ASSERT_EQ(state_.form->numbers.size(), 2U);
    EXPECT_EQ(state_.form->numbers[0].label, "Resolution of the map");
    EXPECT_EQ(state_.form->numbers[1].label, "Contour");
    EXPECT_TRUE(state_.form->numbers[1].value());
    for (const char* const wrong : {"", "0", "-7", "1e9", "seven", "7 ", "nan", "inf"}) {
        type(wrong);
        ASSERT_TRUE(state_.form) << wrong;
        EXPECT_FALSE(state_.form->complete()) << wrong;
    }
    state_.form->cancelled = true;
    dashboard.follow(state_);
    EXPECT_FALSE(state_.form);
    dashboard.drop({map, model}, state_);
    until_done(dashboard);
    ASSERT_TRUE(state_.form);
    type("7.5");
    EXPECT_FALSE(state_.form);
    until_done(dashboard);
    EXPECT_EQ(scenes(), 1U) << state_.message;
}

TEST_F(Import, answers_are_proposed_again_for_the_same_file_and_wait_for_a_person) {
    const std::string map = (folder_ / "map.mrc").string(), other = (folder_ / "other.mrc").string(),
                      model = (folder_ / "a.pdb").string();
    write_map(map);
    write_map(other);
    std::ofstream(model)
        << "ATOM      1  CA  ALA A   1       6.000   6.000   6.000  1.00  0.00           C\n"
           "ATOM      2  CA  ALA A   2       8.000   7.000   6.000  1.00  0.00           C\n";
    const auto file = folder_ / "state" / "tact" / "import_answers.json";
    const auto ask = [&](BrowserController& dashboard, const std::string& of) -> ImportForm& {
        state_.form.reset();
        dashboard.drop({of, model}, state_);
        until_done(dashboard);
        EXPECT_TRUE(state_.form) << state_.message;
        return *state_.form;
    };
    {
        BrowserController dashboard({});
        ImportForm& form = ask(dashboard, map);
        EXPECT_EQ(form.numbers[0].typed[0], 0) << "nothing is known";
        std::snprintf(form.numbers[0].typed.data(), form.numbers[0].typed.size(), "7.25");
        form.answered = true;
        dashboard.follow(state_);
        until_done(dashboard);
    }  // waits for the file to be written
    ASSERT_EQ(read_answers(file).size(), 1U);
    const std::size_t baked = scenes();
    BrowserController dashboard({});
    {
        const ImportForm& form = ask(dashboard, map);
        EXPECT_STREQ(form.numbers[0].typed.data(), "7.25");
        EXPECT_EQ(form.numbers[0].recalled_from, "As answered for this file before.");
        EXPECT_TRUE(form.numbers[1].recalled.empty()) << "the contour was left as proposed";
        EXPECT_EQ(form.arguments(), (std::vector<std::string>{"--resolution-a", "7.25"}));
        for (int i = 0; i < 20; ++i) dashboard.follow(state_);
        EXPECT_TRUE(state_.form && !state_.importing && scenes() == baked) << "a person confirms it";
    }
    EXPECT_EQ(ask(dashboard, other).numbers[0].typed[0], 0) << "the resolution is of one map alone";
    write_map(map);
    EXPECT_EQ(ask(dashboard, map).numbers[0].typed[0], 0) << "it is another file now";
    std::ofstream(file) << "{\"imports\": 3}";
    EXPECT_EQ(ask(dashboard, map).numbers[0].typed[0], 0);
    EXPECT_NE(state_.message.find("answers of earlier imports"), std::string::npos) << state_.message;
    state_.form->numbers[0].set(8.0);
    state_.form->answered = true;
    dashboard.follow(state_);
    until_done(dashboard);
    for (int i = 0; i < 400 && !std::filesystem::exists(file.string() + ".damaged"); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_TRUE(std::filesystem::exists(file.string() + ".damaged")) << "what a person wrote is kept";
}

TEST_F(Import, a_structure_is_added_to_the_scene_that_is_shown_once_a_person_says_so) {
    const std::string map = (folder_ / "map.mrc").string(), model = (folder_ / "a.pdb").string(),
                      scene = (folder_ / "a.tact").string(), second = (folder_ / "b.pdb").string();
    write_map(map);
    for (const std::string& file : {model, second})
        std::ofstream(file)
            << "ATOM      1  CA  ALA A   1       6.000   6.000   6.000  1.00  0.00           C\n"
               "ATOM      2  CA  ALA A   2       8.000   7.000   6.000  1.00  0.00           C\n";
    ASSERT_EQ(std::system(("tact-prep dock " + map + " " + model + " --resolution-a 8 -o " + scene +
                           " >/dev/null 2>&1")
                              .c_str()),
              0);
    const auto scene_switch = folder_ / "scene_switch";
    std::filesystem::create_directory(scene_switch);
    const std::string note = read_note(SceneFile::open(scene));
    {
        BrowserController alone({});
        alone.used(scene, SceneKind::docking, note, state_);
        alone.drop({second}, state_);
        state_.import_wanted = true;
        alone.follow(state_);
        EXPECT_FALSE(state_.importing);
        EXPECT_NE(state_.message.find("run: tact dock " + scene + " " + second), std::string::npos)
            << state_.message;
    }
    BrowserController dashboard(scene_switch);
    dashboard.used(scene, SceneKind::docking, note, state_);
    dashboard.drop({second}, state_);
    EXPECT_TRUE(state_.open && state_.marks_add && !state_.marks_import);
    EXPECT_EQ(state_.marks_text, "Add b.pdb to this scene, whose bodies stay where they are.");
    dashboard.follow(state_);
    EXPECT_FALSE(state_.importing) << "nothing starts by itself";
    state_.import_wanted = true;
    dashboard.follow(state_);
    until_done(dashboard);
    ASSERT_FALSE(state_.added_scene.empty()) << state_.message;
    EXPECT_EQ(read_meta(SceneFile::open(state_.added_scene)).body_count, 2U);
    EXPECT_FALSE(take_asked_scene(scene_switch)) << "the session of the window asks for it";
    state_.added_scene.clear();
    std::ofstream(map, std::ios::app) << "changed";
    dashboard.drop({second}, state_);
    state_.import_wanted = true;
    dashboard.follow(state_);
    until_done(dashboard);
    EXPECT_TRUE(state_.added_scene.empty());
    EXPECT_NE(state_.message.find("has changed since the scene was baked"), std::string::npos)
        << state_.message;
    EXPECT_EQ(state_.message_grade, Grade::bad);
}

TEST_F(Import, the_folder_of_a_baked_scene_is_that_of_its_files) {
    const std::string note = "input: map, 5 bytes, crc32 00000000, /data/maps/emd.mrc\nbake options: \n";
    BrowserController dashboard({});
    dashboard.used(folder_ / "cache/tact/emd-1.tact", SceneKind::docking, note, state_);
    EXPECT_EQ(state_.folder, "/data/maps");
    state_.folder.clear();
    dashboard.used("/elsewhere/emd.tact", SceneKind::docking, note, state_);
    EXPECT_EQ(state_.folder, "/elsewhere");
}

TEST_F(Import, files_that_cannot_be_read_are_refused_before_anything_is_asked) {
    const std::string map = (folder_ / "map.mrc").string(), model = (folder_ / "a.pdb").string();
    std::ofstream(map) << "no map";
    std::ofstream(model) << "no structure";
    BrowserController dashboard({});
    dashboard.drop({map, model}, state_);
    until_done(dashboard);
    EXPECT_FALSE(state_.form);
    EXPECT_EQ(state_.message_grade, Grade::bad);
    EXPECT_NE(state_.message.find("map.mrc"), std::string::npos) << state_.message;
}

TEST_F(Import, a_scan_shows_its_histogram_and_is_imported_with_the_values_that_were_chosen) {
    const std::string scan = (folder_ / "head.nrrd").string();
    std::string bytes =
        "NRRD0004\ndimension: 3\ntype: uint8\nsizes: 24 24 24\nspacings: 1 1 1\nencoding: raw\n\n";
    for (int i = 0; i < 24 * 24 * 24; ++i)
        bytes += static_cast<char>(i % 20 < 9 ? 3 : i % 20 < 17 ? 90 + i % 7 : 200 + i % 5);
    std::ofstream(scan, std::ios::binary) << bytes;
    const auto scene_switch = folder_ / "scene_switch";
    std::filesystem::create_directory(scene_switch);
    BrowserController dashboard(scene_switch);
    dashboard.drop({scan}, state_);
    until_done(dashboard);
    ASSERT_TRUE(state_.form) << state_.message;
    ImportForm& form = *state_.form;
    ASSERT_EQ(form.numbers.size(), 2U);
    EXPECT_EQ(form.low, 3.0);
    EXPECT_GT(form.bins.size(), 100U);
    EXPECT_GT(form.numbers[0].value().value_or(0.0), 96.0);
    EXPECT_LT(form.numbers[0].value().value_or(0.0), 200.0);
    EXPECT_TRUE(form.arguments().empty()) << "what is proposed is no answer of a person";
    form.numbers[0].set(80.0);
    form.answered = true;
    dashboard.follow(state_);
    until_done(dashboard);
    const auto asked = take_asked_scene(scene_switch);
    ASSERT_TRUE(asked) << state_.message;
    EXPECT_NE(read_note(SceneFile::open(*asked)).find("values above 80"), std::string::npos);
}

TEST_F(Import, names_of_structures_are_written_beside_the_images_and_the_table_before_is_kept) {
    const auto ear = folder_ / "ear";
    std::filesystem::create_directory(ear);
    for (int k = 0; k < 12; ++k) {
        std::vector<std::uint8_t> rgb;
        for (int i = 0; i < 12 * 12; ++i) {
            const std::array<std::uint8_t, 3> c = i % 12 < 8 ? std::array<std::uint8_t, 3>{255, 249, 219}
                                                             : std::array<std::uint8_t, 3>{10, 20, 30};
            rgb.insert(rgb.end(), c.begin(), c.end());
        }
        write_png(ear / ("plane" + std::to_string(k) + ".png"), 12, 12, rgb);
    }
    const std::string before = "# mine\n[[structure]]\ncolour = \"#0A141E\"\nname = \"window\"\n";
    std::ofstream(ear / "structures.toml") << before;
    const auto scene_switch = folder_ / "scene_switch";
    std::filesystem::create_directory(scene_switch);
    BrowserController dashboard(scene_switch);
    dashboard.drop({ear}, state_);
    until_done(dashboard);
    ASSERT_TRUE(state_.form) << state_.message;
    ImportForm& form = *state_.form;
    ASSERT_EQ(form.structures.size(), 1U);
    EXPECT_STREQ(form.structures[0].name.data(), "window");
    std::snprintf(form.structures[0].name.data(), form.structures[0].name.size(), "round window");
    form.numbers.at(0).set(0.5);
    form.answered = true;
    dashboard.follow(state_);
    until_done(dashboard);
    const auto asked = take_asked_scene(scene_switch);
    ASSERT_TRUE(asked) << state_.message;
    EXPECT_TRUE(asked->filename().string().starts_with("ear-")) << "named after its folder";
    const SceneFile scene = SceneFile::open(*asked);
    const BoneLabelsView labels = read_bone_labels(scene, read_bone_volume(scene).bricks);
    ASSERT_EQ(labels.structure.size(), 1U);
    EXPECT_EQ(labels.structure[0].name, "round window");
    std::ifstream kept(ear / "structures.toml.before");
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(kept), {}), before);
}

TEST_F(Import, an_examination_can_be_cancelled) {
    const std::string scan = (folder_ / "head.nrrd").string();
    std::ofstream(scan, std::ios::binary)
        << "NRRD0004\ndimension: 3\ntype: uint8\nsizes: 4 4 4\nspacings: 1 1 1\nencoding: raw\n\n"
        << std::string(64, '\7');
    BrowserController dashboard({});
    dashboard.drop({scan}, state_);
    dashboard.follow(state_);
    state_.cancel_wanted = true;
    until_done(dashboard);
    EXPECT_FALSE(state_.form);
    EXPECT_EQ(scenes(), 0U);
}

TEST_F(Import, an_unknown_file_type_is_answered_with_the_known_ones) {
    BrowserController dashboard({});
    dashboard.drop({"/a/notes.txt"}, state_);
    EXPECT_TRUE(state_.open);
    EXPECT_NE(state_.message.find("'notes.txt' has an ending that Tact does not read"), std::string::npos)
        << state_.message;
    EXPECT_NE(state_.message.find("Files to drop: a scene"), std::string::npos) << state_.message;
}

TEST_F(Import, the_error_of_tact_prep_is_shown_unchanged) {
    BrowserController dashboard({});
    dashboard.drop({folder_ / "wrong.ply"}, state_);
    until_done(dashboard);
    EXPECT_TRUE(state_.message.starts_with("tact-prep: ")) << state_.message;
    EXPECT_NE(state_.message.find("fix:"), std::string::npos);
    EXPECT_EQ(scenes(), 0U);
}

TEST_F(Import, a_cancelled_import_leaves_nothing) {
    BrowserController dashboard({});
    dashboard.drop({folder_ / "tetra.obj"}, state_);
    state_.cancel_wanted = true;
    until_done(dashboard);
    EXPECT_NE(state_.message.find("cancelled"), std::string::npos) << state_.message;
    EXPECT_EQ(scenes(), 0U);
}

TEST_F(Import, an_unreadable_list_of_scenes_is_kept_aside) {
    setenv("XDG_STATE_HOME", (folder_ / "state").c_str(), 1);
    const auto list = folder_ / "state" / "tact" / "recent.json";
    std::filesystem::create_directories(list.parent_path());
    std::ofstream(list) << "by hand, and wrong";
    {
        BrowserController dashboard(folder_);
        dashboard.used("/a/b.tact", SceneKind::docking, {}, state_);
    }  // waits for the file to be written
    EXPECT_EQ(read_recents(list).at(0).path, "/a/b.tact");
    std::ifstream aside(list.string() + ".damaged");
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(aside), {}), "by hand, and wrong");
}

TEST_F(Import, without_a_launcher_the_window_explains_how_to_open_a_scene) {
    BrowserController dashboard({});
    dashboard.drop({"/a/b.tact"}, state_);
    EXPECT_TRUE(state_.open);
    EXPECT_NE(state_.message.find("tact run /a/b.tact"), std::string::npos) << state_.message;
}

}  // namespace
}  // namespace tact::gui_import_test
