// A scene switch from the window: requests, refusals, and what is kept from the run.
#include <fstream>
#include <sstream>

#include "deploy/tact/scene_switch.hpp"
#include "ipc/scene/bone/drilled_bone.hpp"
#include "ipc/scene/session/session_file.hpp"
#include "tests/unit/deploy_run_stand_ins.hpp"

namespace tact::launch {
namespace {

class OtherScene : public DeployRun {
protected:
    void SetUp() override {
        DeployRun::SetUp();
        options_.json.clear();
        options_.seconds = 0.0;
        other_ = scratch_.path() / "other.tact";
        sample::scene().write(other_);
        ask(other_);
        setenv("TOLD", (scratch_.path() / "told").c_str(), 1);
        setenv("CONTROLLERS", (scratch_.path() / "controllers").c_str(), 1);
        setenv("WINDOWS", (scratch_.path() / "windows").c_str(), 1);
    }
    static void ask(const std::filesystem::path& scene) { setenv("ASKS_FOR", scene.c_str(), 1); }
    [[nodiscard]] std::vector<std::string> lines(const char* name) const {
        std::istringstream in(read_small(scratch_.path() / name));
        std::vector<std::string> all;
        for (std::string line; std::getline(in, line);) all.push_back(line);
        return all;
    }
    std::filesystem::path other_;
};

TEST_F(OtherScene, the_launcher_switches_to_the_other_scene_unarmed_with_the_same_options) {
    options_.controller = {"--rate", "500"};
    options_.add_for_scene({"--start-offset-a", "15"});
    ASSERT_EQ(run(), 0) << said_;
    const auto controllers = lines("controllers");
    ASSERT_EQ(controllers.size(), 2U) << said_;
    EXPECT_EQ(controllers[0],
              scene_.string() + " --session default --arm-with-gui --rate 500 --start-offset-a 15 --mouse");
    EXPECT_EQ(controllers[1], other_.string() + " --session default --rate 500 --mouse");
    EXPECT_EQ(lines("told"), (std::vector<std::string>{scene_, other_}));
    EXPECT_NE(said_.find("another scene was requested"), std::string::npos) << said_;
}

TEST_F(OtherScene, the_next_window_keeps_the_state_of_the_last_one) {
    ASSERT_EQ(run(), 0) << said_;
    const auto windows = lines("windows");
    ASSERT_EQ(windows.size(), 2U) << said_;
    const auto window_state_of = [](const std::string& words) {
        const std::string option = "--window-state ";
        const auto at = words.find(option);
        if (at == std::string::npos) return std::string();
        const auto from = at + option.size();
        return words.substr(from, words.find(' ', from) - from);
    };
    EXPECT_NE(windows[0].find("--size 1280x800"), std::string::npos) << windows[0];
    EXPECT_EQ(windows[1].find("--size"), std::string::npos) << windows[1];
    ASSERT_FALSE(window_state_of(windows[0]).empty()) << windows[0];
    EXPECT_EQ(window_state_of(windows[0]), window_state_of(windows[1]));
    EXPECT_FALSE(std::filesystem::exists(window_state_of(windows[0]))) << "the run is over";
}

TEST_F(OtherScene, a_given_size_applies_to_the_first_window) {
    options_.size = "640x480";
    options_.size_given = true;
    options_.visual = {"--window-state", scratch_.path() / "mine.toml"};
    ASSERT_EQ(run(), 0) << said_;
    const auto windows = lines("windows");
    ASSERT_EQ(windows.size(), 2U) << said_;
    EXPECT_NE(windows[0].find("--size 640x480"), std::string::npos) << windows[0];
    EXPECT_EQ(windows[1].find("--size"), std::string::npos) << windows[1];
    for (const std::string& words : windows)
        EXPECT_EQ(words.find("--window-state"), words.rfind("--window-state")) << words;
    EXPECT_TRUE(std::filesystem::exists(scratch_.path() / "mine.toml"));
}

TEST_F(OtherScene, a_file_that_is_not_a_scene_is_refused_in_the_window_and_the_run_continues) {
    std::ofstream(other_) << "not a scene, but long enough for the header of one: sixty-four bytes and more";
    ASSERT_EQ(run(), 0) << said_;
    EXPECT_EQ(lines("controllers").size(), 1U);
    const auto told = lines("told");
    ASSERT_GE(told.size(), 3U);
    EXPECT_NE(told[1].find("so it is not a Tact scene"), std::string::npos) << told[1];
    EXPECT_NE(told[2].find("fix:"), std::string::npos) << told[2];
}

TEST_F(OtherScene, if_the_other_scene_fails_to_start_the_old_one_returns_with_the_reason) {
    misbehave("refuse-other");
    ASSERT_EQ(run(), 0) << said_;
    const auto controllers = lines("controllers");
    ASSERT_EQ(controllers.size(), 2U) << said_;
    EXPECT_TRUE(controllers[1].starts_with(scene_.string()));
    EXPECT_EQ(controllers[1].find("--arm"), std::string::npos) << "a force would come back by itself";
    const auto told = lines("told");
    ASSERT_GE(told.size(), 3U);
    EXPECT_EQ(told[told.size() - 3], scene_.string());
    EXPECT_NE(told[told.size() - 2].find("could not be started"), std::string::npos) << said_;
}

// The scene of the run with one more structure, and the session that continues in it.
class MoreStructures : public OtherScene {
protected:
    void SetUp() override {
        OtherScene::SetUp();
        const std::string file = "input: structure, 1 bytes, crc32 00000000, /";
        write(scene_, file + "a\nbake options: \n");
        write(other_, file + "a\n" + file + "b\nbake options: \n");
        session_ = scratch_.path() / "added.tact-session";
        Session session;
        session.scene = other_;
        session.scene_checksum = SceneFile::open(other_).checksum();
        session.bodies = R"([{"id":1}])";
        std::ofstream(session_) << session_text(session, session_);
        setenv("ASKS_AS", session_.c_str(), 1);
    }
    void TearDown() override {
        unsetenv("ASKS_AS");
        OtherScene::TearDown();
    }
    static void write(const std::filesystem::path& file, const std::string& note) {
        sample::scene(sample::meta(), sample::structure(), sample::codebook(), sample::grid(), note)
            .write(file);
    }
    std::filesystem::path session_;
};

TEST_F(MoreStructures, go_on_in_a_run_with_a_report_and_without_typed_start_poses) {
    options_.json = scratch_.path() / "run.json";
    options_.controller = {"--start-offset-a", "3", "--copies", "2"};
    ASSERT_EQ(run(), 0) << said_;
    const auto controllers = lines("controllers");
    ASSERT_EQ(controllers.size(), 2U) << said_;
    EXPECT_EQ(controllers[1], other_.string() + " --session default --mouse --poses " + session_.string());
    EXPECT_NE(lines("windows")[1].find("--open-session " + session_.string()), std::string::npos);
}

TEST_F(MoreStructures,
       of_another_scene_are_refused_in_a_run_with_a_report_and_so_is_any_in_one_with_a_recording) {
    options_.json = scratch_.path() / "run.json";
    write(scene_, "input: structure, 1 bytes, crc32 00000009, /a\nbake options: \n");
    ASSERT_EQ(run(), 0) << said_;
    EXPECT_EQ(lines("controllers").size(), 1U) << said_;
    EXPECT_NE(lines("told")[1].find("(--json)"), std::string::npos);
    EXPECT_EQ(bound_to_one_scene(options_, true), "");
    options_.record = "run.h5";
    EXPECT_EQ(bound_to_one_scene(options_, true), "--record");
}

TEST_F(MoreStructures, that_do_not_start_lead_back_to_the_bodies_as_they_were) {
    misbehave("refuse-other");
    const auto shown = scratch_.path() / "shown";
    char checksum[17];
    std::snprintf(checksum, sizeof checksum, "%016llx",
                  static_cast<unsigned long long>(SceneFile::open(scene_).checksum()));
    std::ofstream(shown) << R"({"tact_session":1,"bodies":[{"id":1}],"scene":{"path":")" << scene_.string()
                         << R"(","checksum":")" << checksum << "\"}}";
    setenv("GOES_BACK_TO", shown.c_str(), 1);
    ASSERT_EQ(run(), 0) << said_;
    unsetenv("GOES_BACK_TO");
    const auto controllers = lines("controllers");
    ASSERT_EQ(controllers.size(), 2U) << said_;
    EXPECT_TRUE(controllers[1].starts_with(scene_.string() + " --session default --mouse --poses "))
        << controllers[1];
    EXPECT_TRUE(controllers[1].ends_with(kShownSession)) << controllers[1];
}

class KeptBone : public OtherScene {
protected:
    [[nodiscard]] std::filesystem::path bone_of(std::uint64_t checksum) const {
        BoneBricks bricks;
        bricks.size = {8, 8, 8};
        bricks.voxel_m = 1e-3;
        const DrilledBoneHead head = drilled_bone_head(bricks, checksum);
        const auto path = scratch_.path() / "kept.bone";
        std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(&head), sizeof head);
        return path;
    }
};

TEST_F(KeptBone, of_the_scene_that_is_shown_starts_its_run_anew_with_it) {
    const auto bone = bone_of(SceneFile::open(scene_).checksum());
    ask(bone);
    options_.controller = {"--rate", "500", "--resume", "/elsewhere.bone"};
    ASSERT_EQ(run(), 0) << said_;
    const auto controllers = lines("controllers");
    ASSERT_EQ(controllers.size(), 2U) << said_;
    EXPECT_EQ(controllers[1],
              scene_.string() + " --session default --rate 500 --mouse --resume " + bone.string());
    EXPECT_NE(said_.find("drilled bone was requested: " + bone.string()), std::string::npos) << said_;
}

TEST_F(KeptBone, of_another_scene_and_what_is_none_are_refused_and_the_run_continues) {
    for (const bool of_another : {true, false}) {
        const auto bone = bone_of(7);
        if (!of_another) std::ofstream(bone) << "no bone";
        std::filesystem::remove(scratch_.path() / "told");
        std::filesystem::remove(scratch_.path() / "controllers");
        ask(bone);
        ASSERT_EQ(run(), 0) << said_;
        EXPECT_EQ(lines("controllers").size(), 1U);
        const auto told = lines("told");
        ASSERT_GE(told.size(), 3U);
        EXPECT_NE(told[1].find(of_another ? "of another scene" : "no file of drilled bone"),
                  std::string::npos)
            << told[1];
        EXPECT_NE(told[2].find("fix:"), std::string::npos) << told[2];
    }
}

TEST_F(OtherScene, a_run_with_a_report_of_its_scene_keeps_the_scene) {
    options_.json = scratch_.path() / "run.json";
    ASSERT_EQ(run(), 0) << said_;
    EXPECT_EQ(lines("controllers").size(), 1U);
    EXPECT_NE(lines("told")[1].find("(--json)"), std::string::npos);
}

TEST_F(OtherScene, a_requested_demo_is_one_word_and_is_removed_when_read) {
    const auto folder = scratch_.path();
    EXPECT_EQ(take_asked_demo(folder), std::nullopt);
    ask_for_demo(folder, "drill");
    EXPECT_EQ(take_asked_demo(folder), "drill");
    EXPECT_EQ(take_asked_demo(folder), std::nullopt);
    for (const std::string& bad : {std::string(), std::string("\n"), std::string("dock"),
                                   std::string("--help\n"), std::string("dock --save /\n"),
                                   std::string("a\nb\n"), std::string(kDemoNameMost + 1, 'a') + "\n"}) {
        std::ofstream(folder / "demo", std::ios::binary) << bad;
        EXPECT_THROW((void)take_asked_demo(folder), StartupError) << bad;
        EXPECT_FALSE(std::filesystem::exists(folder / "demo"));
    }
}

TEST_F(OtherScene, a_session_starts_its_scene_with_its_bodies_and_the_window_with_the_rest) {
    const std::filesystem::path file = scratch_.path() / "a.tact-session";
    Session session;
    session.scene = other_;
    session.scene_checksum = SceneFile::open(other_).checksum();
    session.bodies = R"([{"id":1}])";
    write_whole(file, session_text(session, file));
    options_.controller = {"--rate", "500"};
    unsetenv("ASKS_FOR");
    options_.seconds = 0.3;
    scene_ = file;
    ASSERT_EQ(run(), 0) << said_;
    EXPECT_EQ(lines("controllers"),
              (std::vector<std::string>{other_.string() +
                                        " --session default --arm-with-gui --rate 500 --mouse --poses " +
                                        file.string()}));
    ASSERT_EQ(lines("windows").size(), 1U);
    EXPECT_NE(lines("windows")[0].find("--open-session " + file.string()), std::string::npos);
}

TEST_F(OtherScene, a_run_in_a_window_has_a_flight_recorder_unless_it_is_refused) {
    setenv("XDG_STATE_HOME", scratch_.path().c_str(), 1);
    RunOptions in_window, alone, headless, refused, chosen;
    alone.gui = false;
    headless.headless = true;
    refused.no_flight = true;
    chosen.flight = "/data/flights";
    for (RunOptions* const o : {&in_window, &alone, &headless, &refused, &chosen}) o->settle();
    EXPECT_EQ(in_window.flight, scratch_.path() / "tact/flight");
    EXPECT_TRUE(alone.flight.empty() && headless.flight.empty() && refused.flight.empty());
    EXPECT_EQ(chosen.flight, "/data/flights");
    EXPECT_TRUE(chosen.flight_typed && !in_window.flight_typed);
    unsetenv("XDG_STATE_HOME");
}

TEST_F(OtherScene, a_flight_recorder_that_fails_is_a_failure_only_if_it_was_asked_for) {
    setenv("XDG_STATE_HOME", scratch_.path().c_str(), 1);
    std::filesystem::create_symlink("/bin/false", scratch_.path() / "tact-record");
    unsetenv("ASKS_FOR");
    options_.seconds = 0.3;
    options_.no_flight = false;
    EXPECT_EQ(run(), 0) << said_;
    EXPECT_NE(said_.find("no past to look back to"), std::string::npos) << said_;
    options_.flight = scratch_.path() / "flights";
    EXPECT_EQ(run(), 1) << said_;
    unsetenv("XDG_STATE_HOME");
}

TEST_F(OtherScene, a_moment_to_look_back_to_is_a_time_that_passed) {
    const auto folder = scratch_.path();
    EXPECT_EQ(take_asked_past(folder), std::nullopt);
    ask_for_past(folder, 12.5);
    EXPECT_EQ(take_asked_past(folder), 12.5);
    EXPECT_EQ(take_asked_past(folder), std::nullopt);
    for (const std::string& bad :
         {std::string(), std::string("\n"), std::string("-1\n"), std::string("nan\n"), std::string("inf\n"),
          std::string("601\n"), std::string("1"), std::string("1 \n"), std::string(40, '1') + "\n"}) {
        std::ofstream(folder / "past", std::ios::binary) << bad;
        EXPECT_THROW((void)take_asked_past(folder), StartupError) << bad;
        EXPECT_FALSE(std::filesystem::exists(folder / "past"));
    }
}

TEST_F(OtherScene, a_request_is_one_absolute_path_and_is_removed_when_read) {
    const auto folder = scratch_.path();
    const auto taken = [&](const std::string& text) {
        std::ofstream(folder / "open", std::ios::binary) << text;
        std::optional<std::filesystem::path> path;
        const std::string error = sample::error_of([&] { path = take_asked_scene(folder); });
        EXPECT_FALSE(std::filesystem::exists(folder / "open"));
        EXPECT_EQ(path.has_value(), error.empty());
        return path ? path->string() : error;
    };
    EXPECT_EQ(taken("/a/b c.tact\n"), "/a/b c.tact");
    for (const std::string& bad : {std::string(), std::string("\n"), std::string("relative.tact\n"),
                                   std::string("/a\n/b\n"), std::string("/without-end"),
                                   std::string("/a\0b\n", 5), "/" + std::string(kAskedPathMost, 'x') + "\n"})
        EXPECT_NE(taken(bad).find("fix:"), std::string::npos) << bad.substr(0, 40);
    std::filesystem::create_directory(folder / "open");
    EXPECT_THROW((void)take_asked_scene(folder), StartupError);
    std::filesystem::create_symlink(scene_, folder / "open");
    EXPECT_THROW((void)take_asked_scene(folder), StartupError);
    EXPECT_TRUE(std::filesystem::exists(scene_)) << "the link went, not what it led to";
    EXPECT_EQ(take_asked_scene(folder), std::nullopt);
    refuse_scene(folder, "why\x1b[31m\n" + std::string(2 * kRefusalMost, 'y'));
    const auto refusal = take_refusal(folder);
    ASSERT_TRUE(refusal);
    EXPECT_TRUE(refusal->starts_with("why?[31m\ny"));
    EXPECT_EQ(refusal->size(), kRefusalMost);
    EXPECT_EQ(take_refusal(folder), std::nullopt);
}

}  // namespace
}  // namespace tact::launch

int main(int argc, char** argv) { return tact::launch::play(argc, argv); }
