// The folder for what a person saves, and the recording that a window starts.
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "gui/base/output_folder.hpp"
#include "gui/window/run_recorder.hpp"
#include "ipc/base/error.hpp"

namespace tact::gui_output_test {
namespace {

namespace fs = std::filesystem;

class Output : public ::testing::Test {
protected:
    Output() {
        char name[] = "/tmp/tact-output-XXXXXX";
        folder_ = mkdtemp(name);
        setenv("TACT_OUTPUT", (folder_ / "mine").c_str(), 1);
    }
    ~Output() override {
        unsetenv("TACT_OUTPUT");
        fs::remove_all(folder_);
    }
    // A program in the place of tact-record: writes its arguments, and then what `script` does.
    std::string program(const std::string& script) {
        const fs::path path = folder_ / "recorder";
        std::ofstream(path) << "#!/bin/sh\necho \"$@\" >" << (folder_ / "said").string() << "\n"
                            << script << "\n";
        fs::permissions(path, fs::perms::owner_all);
        return path.string();
    }
    std::optional<StatusText> ended(RunRecorder& recorder) {
        for (int i = 0; i < 500; ++i) {
            if (auto said = recorder.poll()) return said;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return std::nullopt;
    }
    fs::path folder_;
};

TEST_F(Output, is_one_folder_with_names_by_time_that_never_repeat) {
    EXPECT_EQ(output_folder(), folder_ / "mine");
    const fs::path first = new_output("picture", ".png");
    std::ofstream(first) << "x";
    const fs::path second = new_output("picture", ".png");
    EXPECT_EQ(first.parent_path(), folder_ / "mine");
    EXPECT_NE(first, second);
    constexpr std::size_t kStamp = 17;  // 2026-11-28_085312
    if (first.filename().string().substr(0, kStamp) == second.filename().string().substr(0, kStamp)) {
        EXPECT_EQ(second.stem(), first.stem().string() + "-2");
    }
    EXPECT_EQ(second.extension(), ".png");
    setenv("TACT_OUTPUT", "not/absolute", 1);
    setenv("HOME", folder_.c_str(), 1);
    EXPECT_EQ(output_folder(), folder_ / "Tact");
    setenv("TACT_OUTPUT", "/proc/none", 1);
    EXPECT_THROW((void)new_output("picture", ".png"), StartupError);
}

TEST_F(Output, a_recording_runs_until_it_is_ended_and_its_file_is_named) {
    RunRecorder recorder("session1",
                         program("trap 'touch \"$1\"; exit 0' TERM; while :; do sleep 0.05; done"));
    const StatusText begun = recorder.toggle();
    EXPECT_EQ(begun.grade, Grade::good);
    EXPECT_TRUE(recorder.running());
    for (int i = 0; i < 200 && !fs::exists(folder_ / "said"); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    EXPECT_FALSE(recorder.poll());
    EXPECT_EQ(recorder.toggle().grade, Grade::unknown);
    const auto said = ended(recorder);
    ASSERT_TRUE(said);
    EXPECT_EQ(said->grade, Grade::good) << said->text;
    EXPECT_EQ("recording to " + said->text.substr(std::string("recorded ").size()), begun.text);
    std::string words;
    std::ifstream in(folder_ / "said");
    std::getline(in, words);
    EXPECT_NE(words.find("--session session1"), std::string::npos) << words;
    EXPECT_FALSE(recorder.running());
}

TEST_F(Output, a_recorder_that_fails_is_told_with_its_message) {
    RunRecorder recorder("s", program("echo 'tact-record: the disk is full' >&2; exit 1"));
    EXPECT_EQ(recorder.toggle().grade, Grade::good);
    const auto said = ended(recorder);
    ASSERT_TRUE(said);
    EXPECT_EQ(said->grade, Grade::bad);
    EXPECT_NE(said->text.find("the disk is full"), std::string::npos) << said->text;
    RunRecorder absent("s", (folder_ / "none").string());
    EXPECT_EQ(absent.toggle().grade, Grade::bad);
    EXPECT_FALSE(absent.running());
}

}  // namespace
}  // namespace tact::gui_output_test
