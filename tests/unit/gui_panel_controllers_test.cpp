// The recent scenes, the contents of a folder, dropped files and the progress of an import.
#include <gtest/gtest.h>

#include <sys/stat.h>
#include <chrono>
#include <ctime>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "gui/window/dropped_files.hpp"
#include "gui/window/import_progress.hpp"
#include "gui/window/scene_list.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/state_folder.hpp"
#include "ipc/scene/bone/drilled_bone.hpp"
#include "ipc/scene/file/scene_peek.hpp"
#include "ipc/scene/session/recent_scenes.hpp"
#include "tests/unit/scene_samples.hpp"

namespace tact::gui_panel_controllers_test {
namespace {

namespace fs = std::filesystem;
using sample::error_of;

class TestDashboard : public testing::Test {
protected:
    void SetUp() override {
        char name[] = "/tmp/tact-dashboard-test-XXXXXX";
        folder_ = mkdtemp(name);
    }
    void TearDown() override { fs::remove_all(folder_); }
    fs::path folder_;
};

TEST_F(TestDashboard, recent_scenes_are_kept_once_newest_first_up_to_a_limit) {
    std::vector<RecentScene> scenes;
    for (std::int64_t i = 0; i < 40; ++i)
        scenes = with_recent(scenes, {std::string("/s/").append(std::to_string(i)), i});
    scenes = with_recent(scenes, {"/s/30", 99});
    ASSERT_EQ(scenes.size(), kRecentsMost);
    EXPECT_EQ(scenes[0], (RecentScene{"/s/30", 99}));
    EXPECT_EQ(scenes[1], (RecentScene{"/s/39", 39}));
    EXPECT_EQ(read_recents_text(recents_text(scenes), "file"), scenes);
    EXPECT_TRUE(read_recents(folder_ / "none.json").empty());
}

TEST_F(TestDashboard, invalid_recent_lists_are_refused_with_a_fix) {
    for (const char* const bad :
         {"", "[", "{}", "{\"scenes\": 3}", "{\"scenes\": [3]}", "{\"scenes\": [{\"path\": \"/a\"}]}",
          "{\"scenes\": [{\"path\": \"a\", \"used_unix_s\": 1}]}",
          "{\"scenes\": [{\"path\": \"/a\\u0000b\", \"used_unix_s\": 1}]}",
          "{\"scenes\": [{\"path\": \"/a\\u007f\", \"used_unix_s\": 1}]}",
          "{\"scenes\": [{\"path\": \"/a\", \"used_unix_s\": -1}]}",
          "{\"scenes\": [{\"path\": \"/a\", \"used_unix_s\": 1e300}]}"})
        EXPECT_NE(error_of([&] { (void)read_recents_text(bad, "recent.json"); }).find("fix:"),
                  std::string::npos)
            << bad;
    std::ofstream(folder_ / "huge.json") << std::string(kRecentsBytesMost + 1, ' ');
    EXPECT_NE(error_of([&] { (void)read_recents(folder_ / "huge.json"); }).find("too large"),
              std::string::npos);
    EXPECT_NE(error_of([&] { (void)read_recents(folder_); }).find("not a regular file"), std::string::npos);
    EXPECT_THROW((void)recents_text({{"/a\xff", 1}}), StartupError);
}

TEST_F(TestDashboard, the_latest_file_set_aside_replaces_the_former) {
    const fs::path file = folder_ / "recent.json";
    for (const char* const content : {"first", "second"}) {
        std::ofstream(file) << content;
        const fs::path aside = set_aside(file);
        EXPECT_FALSE(fs::exists(file));
        std::string kept;
        std::ifstream(aside) >> kept;
        EXPECT_EQ(kept, content);
    }
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
    EXPECT_NE(error_of([&] { (void)set_aside(file); }).find("fix:"), std::string::npos);
}

TEST_F(TestDashboard, the_state_folder_is_below_xdg_state_home_or_home) {
    setenv("XDG_STATE_HOME", "/x/state", 1);
    EXPECT_EQ(state_folder(), "/x/state/tact");
    setenv("XDG_STATE_HOME", "relative", 1);
    setenv("HOME", "/home/someone", 1);
    EXPECT_EQ(state_folder(), "/home/someone/.local/state/tact");
}

TEST_F(TestDashboard, a_row_shows_the_kind_of_a_scene_and_its_faults) {
    const fs::path good = folder_ / "good.tact", broken = folder_ / "broken.tact";
    sample::scene().write(good);
    const auto bytes = sample::scene().to_bytes();
    std::ofstream(broken, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size() / 2));
    const auto rows = recent_rows({{good, 1000}, {broken, 900}, {folder_ / "gone.tact", 800}}, 1300);
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_EQ(rows[0].kind, "docking");
    EXPECT_EQ(rows[0].name, peek_scene(good).title) << "a cached file's name is a number";
    EXPECT_EQ(rows[0].place, good);
    EXPECT_EQ(rows[0].when, "5 min ago");
    EXPECT_TRUE(rows[0].trouble.empty()) << rows[0].trouble;
    EXPECT_EQ(rows[1].trouble, "the file is incomplete");
    EXPECT_TRUE(rows[2].trouble.starts_with("missing: ")) << rows[2].trouble;
}

TEST_F(TestDashboard, a_peek_gives_the_same_metadata_as_a_full_read_and_refuses_a_changed_header) {
    const fs::path file = folder_ / "scene.tact";
    const auto bytes = sample::scene().to_bytes();
    sample::scene().write(file);
    const SceneMeta all = read_meta(SceneFile::open(file)), peeked = peek_scene(file);
    EXPECT_EQ(std::memcmp(&all, &peeked, sizeof all), 0);
    int refused = 0;
    for (std::size_t i = 0; i < 28; ++i) {  // each byte of the header's fields
        auto changed = bytes;
        changed[i] ^= std::byte{0x40};
        std::ofstream(file, std::ios::binary)
            .write(reinterpret_cast<const char*>(changed.data()),
                   static_cast<std::streamsize>(changed.size()));
        refused += error_of([&] { (void)peek_scene(file); }).empty() ? 0 : 1;
    }
    EXPECT_EQ(refused, 28);
}

TEST_F(TestDashboard, a_folder_lists_its_parent_its_folders_and_its_scenes) {
    sample::scene().write(folder_ / "b.tact");
    std::ofstream(folder_ / "notes.txt") << "not a scene";
    std::ofstream(folder_ / "a.tact") << "also not a scene";
    fs::create_directory(folder_ / "more");
    fs::create_directory(folder_ / ".hidden");
    const FolderRows got = folder_rows(folder_, 0);
    ASSERT_EQ(got.rows.size(), 4U);
    EXPECT_EQ(got.rows[0].name, "..");
    EXPECT_EQ(got.rows[0].path, folder_.parent_path());
    EXPECT_TRUE(got.rows[1].folder && got.rows[1].name == "more");
    EXPECT_FALSE(got.rows[2].trouble.empty());
    EXPECT_EQ(got.rows[3].kind, "docking");
    EXPECT_NE(folder_rows(folder_ / "none", 0).trouble.find("cannot be read"), std::string::npos);
    for (std::size_t i = 0; i < kFolderRowsMost + 10; ++i) fs::create_directory(folder_ / std::to_string(i));
    const FolderRows many = folder_rows(folder_, 0);
    EXPECT_LE(many.rows.size(), kFolderRowsMost + 1);
    EXPECT_EQ(many.rows.back().kind, "docking") << "folders displaced the scene";
    EXPECT_FALSE(many.trouble.empty());
}

TEST_F(TestDashboard, dropped_files_are_a_scene_an_import_or_refused_with_a_reason) {
    using Words = std::vector<std::string>;
    EXPECT_EQ(meaning_of({"/a/x.tact"}).scene, "/a/x.tact");
    EXPECT_EQ(meaning_of({"/a/x.PLY.gz"}).import, (Words{"touch", "/a/x.PLY.gz"}));
    EXPECT_EQ(meaning_of({"/a/ear.nii.gz"}).import, (Words{"drill", "/a/ear.nii.gz"}));
    EXPECT_EQ(meaning_of({folder_}).import, (Words{"drill", folder_}));
    EXPECT_EQ(meaning_of({"/a/1.pdb", "/a/m.mrc", "/a/2.cif"}).import,
              (Words{"dock", "/a/m.mrc", "/a/1.pdb", "/a/2.cif"}));
    for (const Words& bad :
         {Words{}, Words{""}, Words{"--help.ply"}, Words{"/a/notes.txt"}, Words{"/a/m.mrc"},
          Words{"/a/1.pdb"}, Words{"/a/m.mrc", "/a/n.map", "/a/1.pdb"}, Words{"/a/x.ply", "/a/y.ply"},
          Words{"/a/x.tact", "/a/m.mrc", "/a/1.pdb"}, Words(kDroppedMost + 1, "/a/1.pdb")}) {
        const Dropped got = meaning_of(bad);
        EXPECT_TRUE(got.scene.empty() && got.import.empty());
        EXPECT_FALSE(got.trouble.empty());
        EXPECT_EQ(meaning_text(got), got.trouble);
    }
}

TEST_F(TestDashboard, structures_alone_are_added_to_a_docking_scene_that_is_shown) {
    using Words = std::vector<std::string>;
    const ShownScene docking{"/s/a.tact", SceneKind::docking};
    const Dropped got = meaning_of({"/a/1.pdb", "/a/2.cif.gz"}, docking);
    EXPECT_EQ(got.add, (Words{"dock", "/s/a.tact", "/a/1.pdb", "/a/2.cif.gz"}));
    EXPECT_TRUE(got.import.empty() && got.scene.empty());
    EXPECT_EQ(meaning_text(got), "Add 1.pdb and 1 more to this scene, whose bodies stay where they are.");
    EXPECT_EQ(meaning_of({"/a/1.pdb", "/a/m.mrc"}, docking).import, (Words{"dock", "/a/m.mrc", "/a/1.pdb"}))
        << "with a map they are a scene of their own";
    for (const ShownScene& other : {ShownScene{}, ShownScene{"/s/a.tact", SceneKind::surface},
                                    ShownScene{"relative.tact", SceneKind::docking}})
        EXPECT_TRUE(meaning_of({"/a/1.pdb"}, other).add.empty());
    for (const Words& bad : {Words{"/a/m.mrc"}, Words{"/a/x.ply", "/a/1.pdb"}, Words(17, "/a/1.pdb")})
        EXPECT_TRUE(meaning_of(bad, docking).add.empty());
}

TEST_F(TestDashboard, the_import_of_dropped_files_is_described_in_one_line) {
    const auto words = [](const std::vector<std::string>& files) { return meaning_text(meaning_of(files)); };
    EXPECT_EQ(words({"/a/1abc.pdb", "/a/emd.mrc"}), "Dock 1abc.pdb into emd.mrc.");
    EXPECT_EQ(words({"/a/1.pdb", "/a/m.mrc", "/a/2.cif", "/a/3.cif"}), "Dock 1.pdb and 2 more into m.mrc.");
    EXPECT_EQ(words({"/a/x.PLY.gz"}), "Touch x.PLY.gz.");
    EXPECT_EQ(words({"/a/ear.nii.gz"}), "Drill ear.nii.gz.");
    EXPECT_EQ(words({"/a/x.tact"}), "Open x.tact.");
    EXPECT_EQ(words({"/a/two\nlines.stl"}), "Touch two?lines.stl.");
    std::string name;
    for (int i = 0; i < 30; ++i)
        name += "\xc3\xa4";  // two bytes each; the shortened name must cut neither in half
    EXPECT_EQ(words({"/a/b" + name + ".stl"}),
              "Touch b" + name.substr(0, 22) + "..." + name.substr(0, 8) + ".stl.");
}

TEST_F(TestDashboard, a_folder_lists_readable_raw_data_by_extension) {
    sample::scene().write(folder_ / "z.tact");
    for (const char* const name :
         {"emd.MRC", "1abc.pdb.gz", "bunny.ply", "ear.nii.gz", "notes.txt", ".hidden.pdb"})
        std::ofstream(folder_ / name) << "anything";
    fs::create_directory(folder_ / "folder.ply");
    ASSERT_EQ(mkfifo((folder_ / "pipe.obj").c_str(), 0600), 0);
    const FolderRows got = folder_rows(folder_, 0);
    std::vector<std::pair<std::string, std::string>> seen;
    for (const SceneRow& row : got.rows) {
        seen.emplace_back(row.name, row.folder ? "folder" : row.kind);
        EXPECT_EQ(row.raw, !row.folder && row.name != "z.tact") << row.name;
    }
    EXPECT_EQ(seen, (std::vector<std::pair<std::string, std::string>>{{"..", "folder"},
                                                                      {"folder.ply", "folder"},
                                                                      {"z.tact", "docking"},
                                                                      {"1abc.pdb.gz", "structure"},
                                                                      {"bunny.ply", "mesh"},
                                                                      {"ear.nii.gz", "scan"},
                                                                      {"emd.MRC", "map"}}));
    EXPECT_EQ(got.rows.back().size, "8 B");
    std::ofstream(folder_ / "IM000001") << std::string(128, '\0') << "DICM";
    const SceneRow whole = folder_rows(folder_, 0).rows.at(1);
    EXPECT_TRUE(whole.raw && whole.kind == "scan");
    EXPECT_EQ(meaning_of({whole.path}).import, (std::vector<std::string>{"drill", folder_}));
}

TEST_F(TestDashboard, a_folder_of_images_can_be_imported_as_a_whole) {
    std::ofstream(folder_ / "plane0.png") << "one image is a picture";
    EXPECT_EQ(folder_rows(folder_, 0).rows.size(), 1U);
    std::ofstream(folder_ / "plane1.png") << "two are a stack";
    const FolderRows got = folder_rows(folder_, 0);
    ASSERT_EQ(got.rows.size(), 2U);
    EXPECT_TRUE(got.rows[1].raw);
    EXPECT_EQ(got.rows[1].name, "This folder (2 images)");
    EXPECT_EQ(meaning_of({got.rows[1].path}).import, (std::vector<std::string>{"drill", folder_}));
}

TEST_F(TestDashboard, drilled_bone_is_listed_for_its_own_scene_newest_first) {
    BoneBricks bricks;
    bricks.size = {8, 8, 8};
    bricks.voxel_m = 1e-3;
    const auto keep = [&](const char* name, std::uint64_t scene, int age_s) {
        const DrilledBoneHead head = drilled_bone_head(bricks, scene);
        std::ofstream(folder_ / name, std::ios::binary)
            .write(reinterpret_cast<const char*>(&head), sizeof head);
        fs::last_write_time(folder_ / name, fs::file_time_type::clock::now() - std::chrono::seconds(age_s));
    };
    keep("old.bone", 7, 4000);
    keep("new.bone", 7, 10);
    keep("other.bone", 8, 5);
    std::ofstream(folder_ / "none.bone") << "no bone";
    const auto rows = drilled_rows(folder_, 7, std::time(nullptr));
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0].name, "new.bone");
    EXPECT_EQ(rows[0].when, "just now");
    EXPECT_EQ(rows[1].name, "old.bone");
    EXPECT_EQ(meaning_of({rows[0].path}).scene, rows[0].path);
    EXPECT_TRUE(drilled_rows(folder_ / "none", 7, 0).empty());
}

TEST_F(TestDashboard, raw_data_and_folders_share_the_rows_left_by_the_scenes) {
    sample::scene().write(folder_ / "z.tact");
    const auto fill = [&](const char* ending, bool folders) {
        for (std::size_t i = 0; i < kFolderRowsMost; ++i) {
            const fs::path path = folder_ / std::to_string(i).append(ending);
            if (folders)
                fs::create_directory(path);
            else
                std::ofstream(path) << i;
        }
    };
    fill(".pdb", false);
    const auto count = [&](auto&& wanted) {
        const FolderRows got = folder_rows(folder_, 0);
        EXPECT_EQ(got.rows.size(), kFolderRowsMost + 1);  // plus the row for the parent folder
        EXPECT_FALSE(got.trouble.empty());
        return static_cast<std::size_t>(std::count_if(got.rows.begin(), got.rows.end(), wanted));
    };
    const auto raw = [](const SceneRow& row) { return row.raw; };
    EXPECT_EQ(count(raw), kFolderRowsMost - 1);
    fill("", true);
    EXPECT_EQ(count(raw), (kFolderRowsMost - 1) / 2);
    EXPECT_EQ(count([](const SceneRow& row) { return row.kind == "docking"; }), 1U);
}

TEST_F(TestDashboard, the_progress_is_read_from_the_output_of_an_import) {
    EXPECT_EQ(share_done(""), std::nullopt);
    EXPECT_EQ(share_done("reading\n[no share]\n[ 12 % of it\n"), std::nullopt);
    EXPECT_EQ(share_done("[ 45 %] simplify\nwarning: a [99 %] b\n"), 0.45);
    EXPECT_EQ(share_done("[  5 %] reading\n[100 %] writing the scene"), 1.0);
    EXPECT_EQ(share_done("[101 %] x\n[-1 %] x\n"), std::nullopt);
    EXPECT_EQ(last_line("one\n[ 45 %] two\n\n"), "[ 45 %] two");
    EXPECT_EQ(last_line("\n"), "");
    EXPECT_EQ(error_text("[  0 %] reading\ntact-prep: no\n  fix: x\n"), "tact-prep: no\n  fix: x");
}

TEST_F(TestDashboard, sizes_and_times_have_readable_units) {
    EXPECT_EQ(size_text(12), "12 B");
    EXPECT_EQ(size_text(820'000), "820 kB");
    EXPECT_EQ(size_text(12'345'678), "12.3 MB");
    EXPECT_EQ(size_text(3'200'000'000), "3.2 GB");
    EXPECT_EQ(ago_text(1000, 1010), "just now");
    EXPECT_EQ(ago_text(1000, 1000 + 7300), "2 h ago");
    EXPECT_EQ(ago_text(1'793'000'000, 1'893'000'000).substr(0, 4), "2026");
}

}  // namespace
}  // namespace tact::gui_panel_controllers_test
