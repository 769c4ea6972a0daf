// Where a replay looks for the scene of a recording.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "ipc/scene/session/recent_scenes.hpp"
#include "rt/replay/recorded_scene.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/says.hpp"
#include "tests/support/small_scene.hpp"

namespace tact {
namespace {

namespace fs = std::filesystem;

class RecordedScene : public testing::Test {
protected:
    RecordedScene() {
        fs::remove_all(folder_);
        for (const char* const sub : {"records", "far", "state/tact", "cache/tact"})
            fs::create_directories(folder_ / sub);
        setenv("XDG_STATE_HOME", (folder_ / "state").c_str(), 1);
        setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);
        about_.scene_path = "small.tact";
        small_scene().write(folder_ / "far" / "small.tact");
        about_.scene_checksum = SceneFile::open(folder_ / "far" / "small.tact").checksum();
    }
    ~RecordedScene() override { fs::remove_all(folder_); }

    void list(const std::vector<fs::path>& scenes) {
        std::vector<RecentScene> recents;
        for (const fs::path& scene : scenes) recents.push_back({scene.string(), 1793000000});
        std::ofstream(recents_file()) << recents_text(recents);
    }
    [[nodiscard]] std::string refusal() {
        return sample::error_of([&] { static_cast<void>(open_recorded_scene(about_, recording_, {})); });
    }

    fs::path folder_ = fs::temp_directory_path() / ("tact-recorded-scene-" + std::to_string(getpid()));
    fs::path recording_ = folder_ / "records" / "run.h5";
    RecordingReader::About about_;
};

TEST_F(RecordedScene, it_is_found_in_the_list_of_recent_scenes_also_under_another_name) {
    EXPECT_NE(refusal(), "");
    list({folder_ / "gone.tact", folder_ / "far" / "small.tact"});
    EXPECT_EQ(open_recorded_scene(about_, recording_, {}).checksum(), about_.scene_checksum);
    fs::rename(folder_ / "far" / "small.tact", folder_ / "far" / "renamed.tact");
    list({folder_ / "far" / "small.tact", folder_ / "far" / "renamed.tact"});
    EXPECT_EQ(open_recorded_scene(about_, recording_, {}).checksum(), about_.scene_checksum);
}

TEST_F(RecordedScene, a_refusal_lists_every_place_and_what_was_there) {
    std::ofstream(folder_ / "records" / "small.tact") << "no scene";
    list({folder_ / "elsewhere" / "small.tact"});
    const std::string text = refusal();
    EXPECT_TRUE(says(text, {"finding the recorded scene 'small.tact'", "fix:", "--scene"})) << text;
    for (const std::string& place :
         {(folder_ / "records" / "small.tact").string() + " (a different scene)",
          (fs::current_path() / "small.tact").string(), (folder_ / "cache" / "tact" / "small.tact").string(),
          (folder_ / "elsewhere" / "small.tact").string()})
        EXPECT_TRUE(says(text, {("\n    " + place).c_str()})) << place << " in " << text;
    std::ofstream(recents_file()) << "damaged";
    EXPECT_TRUE(says(refusal(), {"recent scenes could not be read", "recent.json", "not JSON"})) << refusal();
    std::ofstream(folder_ / "cache" / "tact" / "small.tact")
        << std::ifstream(folder_ / "far" / "small.tact").rdbuf();
    EXPECT_EQ(open_recorded_scene(about_, recording_, {}).checksum(), about_.scene_checksum)
        << "a damaged list is no obstacle";
}

}  // namespace
}  // namespace tact
