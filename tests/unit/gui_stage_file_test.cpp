// The file of a stage: written whole or not at all, and read back unchanged.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "gui/stereo/calibration.hpp"
#include "ipc/base/error.hpp"

namespace tact::gui_stage_file_test {
namespace {

class StageFileWritten : public testing::Test {
protected:
    void SetUp() override {
        char name[] = "/tmp/tact-stage-XXXXXX";
        folder_ = mkdtemp(name);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    [[nodiscard]] std::ptrdiff_t files() const {
        return std::distance(std::filesystem::directory_iterator(folder_), {});
    }
    std::filesystem::path folder_;
};

void same(const StageSettings& a, const StageSettings& b) {
    EXPECT_EQ(a.mode, b.mode);
    EXPECT_EQ(a.monitors, b.monitors);
    EXPECT_EQ(a.width_px, b.width_px);
    EXPECT_EQ(a.height_px, b.height_px);
    EXPECT_EQ(a.in_workspace, b.in_workspace);
    EXPECT_NEAR(a.latency_s, b.latency_s, 1e-9);
    EXPECT_EQ(a.screen_measured, b.screen_measured);
    const auto close = [](const Vec3& x, const Vec3& y) { EXPECT_LT((x - y).norm(), 2e-9); };
    close(a.screen.lower_left_m, b.screen.lower_left_m);
    close(a.screen.lower_right_m, b.screen.lower_right_m);
    close(a.screen.upper_left_m, b.screen.upper_left_m);
    EXPECT_NEAR(a.eyes.apart_m, b.eyes.apart_m, 1e-9);
    EXPECT_EQ(a.eyes.swapped, b.eyes.swapped);
    close(a.eyes.middle_head_m, b.eyes.middle_head_m);
    close(a.rest_screen_m, b.rest_screen_m);
    close(a.T_screen_world.p_m, b.T_screen_world.p_m);
    EXPECT_LT(rotation_vector_rad(a.T_screen_world.q * b.T_screen_world.q.conjugate()).norm(), 1e-8);
    close(a.wand_tip_sensor_m, b.wand_tip_sensor_m);
}

TEST_F(StageFileWritten, reads_back_unchanged_and_keeps_the_old_file) {
    StageSettings s;
    s.wand_tip_sensor_m = {0.01, -0.02, 0.11};
    s.mode = StereoMode::two_windows;
    s.monitors = {1, 2};
    s.in_workspace = true;
    s.screen = {Vec3(-0.3, -0.3, -0.4), Vec3(0.5, -0.28, -0.45), Vec3(-0.31, 0.13, -0.3)};
    s.screen_measured = true;
    s.eyes = {.apart_m = 0.0613, .middle_head_m = Vec3(0.001, -0.042, -0.03), .swapped = true};
    s.T_screen_world = {Vec3(0.05, -0.2, 0.15), quat_from_rotation_vector(Vec3(0.1, 1.2, -0.2))};
    const auto path = folder_ / "lab.toml";
    std::ofstream(path) << "# by hand\nmode = \"anaglyph\"\n";
    const std::vector<std::string> remarks{"screen: green\nmode = \"off\"", std::string(500, 'x')};
    const auto old = write_stage_file(path, s, remarks);
    same(s, read_stage_file(path));
    ASSERT_TRUE(std::filesystem::exists(old));
    std::ifstream in(old);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), "# by hand\nmode = \"anaglyph\"\n");
    // A second write at once keeps both old files.
    const auto second = write_stage_file(path, StageSettings{});
    EXPECT_NE(second, old);
    same(StageSettings{}, read_stage_file(path));
    same(s, read_stage_file(second));
    EXPECT_TRUE(write_stage_file(folder_ / "new.toml", s).empty());
    EXPECT_EQ(files(), 4);  // and no partial file
}

TEST_F(StageFileWritten, unreadable_settings_are_not_written_and_a_missing_folder_is_reported) {
    StageSettings s;
    const auto path = folder_ / "lab.toml";
    std::ofstream(path) << "mode = \"anaglyph\"\n";
    s.eyes.apart_m = NAN;
    EXPECT_THROW(write_stage_file(path, s), StartupError);
    EXPECT_EQ(read_stage_file(path).mode, StereoMode::anaglyph);
    EXPECT_THROW(write_stage_file(folder_ / "none" / "lab.toml", StageSettings{}), StartupError);
    EXPECT_EQ(files(), 1);
}

TEST_F(StageFileWritten, without_disk_space_the_folder_is_unchanged) {
    const auto path = folder_ / "lab.toml";
    std::ofstream(path) << "mode = \"anaglyph\"\n";
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{64, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    std::string why;
    try {
        write_stage_file(path, StageSettings{});
    } catch (const StartupError& e) {
        why = e.what();
    }
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
    std::signal(SIGXFSZ, handler);
    EXPECT_NE(why.find("fix:"), std::string::npos) << why;
    EXPECT_EQ(files(), 1);
    EXPECT_EQ(read_stage_file(path).mode, StereoMode::anaglyph);
}

}  // namespace
}  // namespace tact::gui_stage_file_test
