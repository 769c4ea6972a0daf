// Session files: what is written is read, wherever both move; what is wrong is named.
#include <gtest/gtest.h>

#include <fstream>

#include "ipc/base/error.hpp"
#include "ipc/scene/session/session_file.hpp"
#include "tests/support/error_of.hpp"
#include "tests/unit/scene_samples.hpp"

namespace tact::scene_session_test {
namespace {

namespace fs = std::filesystem;

Session example(const fs::path& folder) {
    Session s;
    s.scene = folder / "maps/ring.tact";
    s.scene_checksum = 0x00ea02f2bcde7a45ULL;
    s.bodies = R"([{"id":1,"structure":0}])";
    s.contours = {"0.75:ffc259:0.5:solid", "1.5"};
    s.places = {{"before \"all\"", {{7, {Vec3(1e-9, -2.5e-9, 0.0), Quat(0.6, 0.0, 0.8, 0.0)}}}}};
    s.window = "traces = true\n";
    s.bone = folder / "out/a.bone";
    return s;
}

TEST(Session, what_is_written_is_read_also_after_all_moved_together) {
    const std::string text = session_text(example("/data"), "/data/out/a.tact-session");
    const Session read = read_session_text(text, "/elsewhere/out/a.tact-session"),
                  was = example("/elsewhere");
    EXPECT_EQ(read.scene, was.scene);
    EXPECT_EQ(read.bone, was.bone);
    EXPECT_EQ(read.scene_checksum, was.scene_checksum);
    EXPECT_EQ(read.bodies, was.bodies);
    EXPECT_EQ(read.contours, was.contours);
    EXPECT_EQ(read.window, was.window);
    ASSERT_EQ(read.places.size(), 1U);
    EXPECT_EQ(read.places[0].name, was.places[0].name);
    ASSERT_EQ(read.places[0].bodies.size(), 1U);
    EXPECT_EQ(read.places[0].bodies[0].id, 7U);
    EXPECT_LT((read.places[0].bodies[0].T_model_body.p_m - Vec3(1e-9, -2.5e-9, 0.0)).norm(), 1e-20);
    EXPECT_LT(read.places[0].bodies[0].T_model_body.q.angularDistance(Quat(0.6, 0.0, 0.8, 0.0)), 1e-12);
}

TEST(Session, the_scene_alone_is_a_session) {
    const Session s = read_session_text(
        R"({"tact_session": 1, "scene": {"path": "/a/b.tact", "checksum": "0000000000000001"}})",
        "x.tact-session");
    EXPECT_EQ(s.scene, "/a/b.tact");
    EXPECT_TRUE(s.bodies.empty() && s.contours.empty() && s.places.empty() && s.bone.empty());
}

TEST(Session, what_is_wrong_is_named) {
    const auto error_of = [](std::string change, const std::string& by) {
        std::string text = session_text(example("/data"), "/data/out/a.tact-session");
        const auto at = text.find(change);
        EXPECT_NE(at, std::string::npos) << change;
        if (at != std::string::npos) text.replace(at, change.size(), by);
        return sample::error_of([&] { (void)read_session_text(text, "/data/out/a.tact-session"); });
    };
    EXPECT_EQ(error_of("1", "1"), "");
    for (const auto& [change, by, named] :
         {std::array{"\"tact_session\": 1", "\"tact_session\": 2", "tact_session"},
          {"{", "[", "JSON"},
          {"../maps/ring.tact", "", "path"},
          {"00ea02f2bcde7a45", "0ea02f2bcde7a45", "checksum"},
          {"00ea02f2bcde7a45", "00ea02f2bcde7a4x", "checksum"},
          {"\"scene\"", "\"scenes\"", "scene"},
          {"10.0", "1e9", "pos_model_a"},
          {"0.6", "0.9", "norm"},
          {"\"id\": 7", "\"id\": -7", "id"},
          {"\"traces = true\\n\"", "3", "window"},
          {"\"1.5\"", "1.5", "contour"}}) {
        const std::string error = error_of(change, by);
        EXPECT_NE(error.find(named), std::string::npos) << change << ": " << error;
        EXPECT_NE(error.find("fix:"), std::string::npos) << change << ": " << error;
    }
    Session wrong = example("/data");
    wrong.bodies = "{}";
    EXPECT_THROW((void)session_text(wrong, "/data/a.tact-session"), StartupError);
}

TEST(Session, its_scene_is_found_where_it_is_or_among_the_baked_ones_by_its_checksum) {
    const fs::path folder = fs::temp_directory_path() / ("tact-session-" + std::to_string(getpid()));
    const fs::path cache = folder / "cache/tact";
    fs::create_directories(cache);
    setenv("XDG_CACHE_HOME", (folder / "cache").c_str(), 1);
    const fs::path scene = folder / "a.tact";
    sample::scene().write(scene);
    Session s;
    s.scene = scene;
    s.scene_checksum = SceneFile::open(scene).checksum();
    EXPECT_EQ(find_session_scene(s), scene);
    fs::rename(scene, cache / "other.tact");
    std::ofstream(cache / "broken.tact") << "no scene";
    EXPECT_EQ(find_session_scene(s), cache / "other.tact");
    std::ofstream(scene) << "another file";
    EXPECT_EQ(find_session_scene(s), cache / "other.tact");
    ++s.scene_checksum;
    EXPECT_NE(sample::error_of([&] { (void)find_session_scene(s); }).find("another scene"),
              std::string::npos);
    unsetenv("XDG_CACHE_HOME");
    fs::remove_all(folder);
}

}  // namespace
}  // namespace tact::scene_session_test
