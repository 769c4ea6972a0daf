// Dropped files, by the way that the window's callback takes: told in words, baked by `tact`, cancelled, refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "gui/app/browser_desk.hpp"
#include "ipc/assets/scene_hand_over.hpp"
#include "ipc/base/clock.hpp"

namespace tact {
namespace {

class Import : public testing::Test {
protected:
    void SetUp() override {
        char name[] = "/tmp/tact-import-test-XXXXXX";
        folder_ = mkdtemp(name);
        setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);
        setenv("PATH", std::string(TACT_FOLDER).append(":").append(std::getenv("PATH")).c_str(), 1);
        std::ofstream(folder_ / "tetra.obj") << "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\n"
                                                "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
        std::ofstream(folder_ / "wrong.ply") << "no mesh";
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    void until_done(BrowserDesk& desk) {
        const Instant until = Monotonic::now() + std::chrono::minutes(2);
        do {
            desk.follow(facts_);
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        } while (facts_.importing && Monotonic::now() < until);
        EXPECT_FALSE(facts_.importing);
    }
    [[nodiscard]] std::size_t scenes() const {
        std::error_code none;
        std::size_t n = 0;
        for (const auto& each : std::filesystem::directory_iterator(folder_ / "cache" / "tact", none))
            n += each.is_regular_file() ? 1 : 0;
        return n;
    }
    std::filesystem::path folder_;
    BrowserFacts facts_;
};

TEST_F(Import, AMeshIsBakedIntoTheCacheAndItsSceneAskedFor) {
    const auto hand_over = folder_ / "hand-over";
    std::filesystem::create_directory(hand_over);
    BrowserDesk desk(hand_over);
    desk.drop({folder_ / "tetra.obj"}, facts_);
    until_done(desk);
    const auto asked = take_asked_scene(hand_over);
    ASSERT_TRUE(asked) << facts_.said;
    EXPECT_EQ(asked->parent_path(), folder_ / "cache" / "tact");
    EXPECT_TRUE(std::filesystem::exists(*asked));
    refuse_scene(hand_over, "not now");
    desk.follow(facts_);
    EXPECT_EQ(facts_.said, "not now");
    EXPECT_EQ(facts_.said_grade, Grade::bad);
}

TEST_F(Import, RowsThatArePressedAreMarkedAndImportedTogether) {
    BrowserDesk desk({});
    facts_.open = true;
    facts_.folder = folder_;
    const auto row = [&](const char* name) -> SceneRow& {
        const auto found = std::find_if(facts_.here.begin(), facts_.here.end(),
                                        [&](const SceneRow& each) { return each.name == name; });
        EXPECT_NE(found, facts_.here.end()) << name;
        return *found;
    };
    const auto press = [&](const std::string& file) {
        facts_.mark_wanted = file;
        desk.follow(facts_);
    };
    desk.follow(facts_);
    while (facts_.reading) desk.follow(facts_);
    ASSERT_FALSE(facts_.here.empty());
    EXPECT_TRUE(facts_.marks_say.empty());
    press(folder_ / "tetra.obj");
    EXPECT_TRUE(row("tetra.obj").marked && facts_.marks_import);
    EXPECT_EQ(facts_.marks_say, "Touch tetra.obj.");
    press(folder_ / "wrong.ply");
    EXPECT_TRUE(row("wrong.ply").marked && !facts_.marks_import);
    EXPECT_EQ(facts_.marks_say, "2 marked. One scene, mesh or scan at a time.");
    facts_.import_wanted = true;  // the button is not to be pressed now
    desk.follow(facts_);
    EXPECT_FALSE(facts_.importing);
    press(folder_ / "wrong.ply");
    EXPECT_TRUE(!row("wrong.ply").marked && row("tetra.obj").marked);
    facts_.import_wanted = true;
    desk.follow(facts_);
    EXPECT_TRUE(facts_.marks_say.empty() && !row("tetra.obj").marked);
    until_done(desk);
    EXPECT_EQ(scenes(), 1U) << facts_.said;
    for (std::size_t i = 0; i < 3 * kDroppedMost; ++i)
        press(std::string("/a/").append(std::to_string(i)).append(".pdb"));
    EXPECT_EQ(facts_.marks_say.substr(0, 3), "18 ") << facts_.marks_say;
    facts_.clear_wanted = true;
    desk.follow(facts_);
    EXPECT_TRUE(facts_.marks_say.empty());
}

TEST_F(Import, WhatCanBeDroppedIsSaidOfWhatCannot) {
    BrowserDesk desk({});
    desk.drop({"/a/notes.txt"}, facts_);
    EXPECT_TRUE(facts_.open);
    EXPECT_NE(facts_.said.find("'notes.txt' is of no kind that Tact reads"), std::string::npos)
        << facts_.said;
    EXPECT_NE(facts_.said.find("What can be dropped: a scene"), std::string::npos) << facts_.said;
}

TEST_F(Import, WhatTactPrepSaysOfAWrongFileIsShownAsItIs) {
    BrowserDesk desk({});
    desk.drop({folder_ / "wrong.ply"}, facts_);
    until_done(desk);
    EXPECT_TRUE(facts_.said.starts_with("tact-prep: ")) << facts_.said;
    EXPECT_NE(facts_.said.find("mend:"), std::string::npos);
    EXPECT_EQ(scenes(), 0U);
}

TEST_F(Import, ACancelledImportLeavesNothing) {
    BrowserDesk desk({});
    desk.drop({folder_ / "tetra.obj"}, facts_);
    facts_.cancel_wanted = true;
    until_done(desk);
    EXPECT_NE(facts_.said.find("cancelled"), std::string::npos) << facts_.said;
    EXPECT_EQ(scenes(), 0U);
}

TEST_F(Import, AListOfScenesThatCannotBeReadIsKeptAside) {
    setenv("XDG_STATE_HOME", (folder_ / "state").c_str(), 1);
    const auto list = folder_ / "state" / "tact" / "recent.json";
    std::filesystem::create_directories(list.parent_path());
    std::ofstream(list) << "by hand, and wrong";
    {
        BrowserDesk desk(folder_);
        desk.used("/a/b.tact", facts_);
    }  // waits for the disk
    EXPECT_EQ(read_recents(list).at(0).path, "/a/b.tact");
    std::ifstream aside(list.string() + ".damaged");
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(aside), {}), "by hand, and wrong");
}

TEST_F(Import, WithoutALauncherTheWindowSaysHowToOpenAScene) {
    BrowserDesk desk({});
    desk.drop({"/a/b.tact"}, facts_);
    EXPECT_TRUE(facts_.open);
    EXPECT_NE(facts_.said.find("tact run /a/b.tact"), std::string::npos) << facts_.said;
}

}  // namespace
}  // namespace tact
