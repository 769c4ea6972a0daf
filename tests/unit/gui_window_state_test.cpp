// The operator's settings of the window, in a file.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "gui/render/camera.hpp"
#include "gui/window/window_state.hpp"
#include "ipc/base/error.hpp"

namespace tact::gui_window_state_test {
namespace {

WindowState one_of_all() {
    WindowState s;
    s.width_px = 1920;
    s.height_px = 1080;
    s.traces = true;
    s.span_choice = 3;
    s.lateness_choice = 1;
    s.toggles = {.surface = false,
                 .codebook = false,
                 .box = true,
                 .style = 2,
                 .depth_cue = false,
                 .frame_times = true,
                 .sound = false,
                 .microscope = true,
                 .molecule = 3,
                 .colouring = 2};
    s.input[0] = {.role = static_cast<int>(InputRole::hand), .speed = 1.25, .dead_zone = 0.05, .curve = 3.0};
    s.input[1].role = static_cast<int>(InputRole::off);
    s.scene = 0xfedcba9876543210ULL;
    s.origin_model_a = Vec3(7.0, -1.0 / 7.0, 4e3);
    s.target_a = Vec3(1.0 / 3.0, -2e3, 0.25);
    s.q_eye_scene = quat_from_rotation_vector(Vec3(0.3, -0.2, 1.1));
    s.distance_a = 210.1;
    return s;
}

TEST(WindowStateFile, a_written_state_reads_back_unchanged) {
    const WindowState s = one_of_all(), again = read_window_state_text(window_state_text(s), "written");
    EXPECT_EQ(again.width_px, 1920);
    EXPECT_EQ(again.height_px, 1080);
    EXPECT_TRUE(again.traces);
    EXPECT_EQ(again.span_choice, 3);
    EXPECT_EQ(again.lateness_choice, 1);
    EXPECT_FALSE(again.toggles.surface);
    EXPECT_TRUE(again.toggles.backbone);
    EXPECT_FALSE(again.toggles.sound);
    EXPECT_TRUE(again.toggles.microscope);
    EXPECT_FALSE(again.toggles.codebook);
    EXPECT_TRUE(again.toggles.box);
    EXPECT_FALSE(again.toggles.depth_cue);
    EXPECT_TRUE(again.toggles.frame_times);
    EXPECT_EQ(again.toggles.style, 2);
    EXPECT_EQ(again.toggles.molecule, 3);
    EXPECT_EQ(again.toggles.colouring, 2);
    EXPECT_EQ(again.input, s.input);
    EXPECT_EQ(again.scene, s.scene);
    EXPECT_EQ(again.origin_model_a, s.origin_model_a);
    EXPECT_EQ(again.target_a, s.target_a);
    EXPECT_LT(again.q_eye_scene.angularDistance(s.q_eye_scene), 1e-9);
    EXPECT_EQ(again.distance_a, s.distance_a);
}

TEST(WindowStateFile, every_key_is_optional) {
    const WindowState s = read_window_state_text("", "empty");
    EXPECT_EQ(s.width_px, 1280);
    EXPECT_TRUE(s.toggles.force);
    EXPECT_EQ(s.scene, 0U);
    EXPECT_EQ(window_state_text(s).find("[scene]"), std::string::npos);
}

TEST(WindowStateFile, faults_are_reported_with_their_key_or_line) {
    const auto refused = [](const std::string& text) {
        try {
            static_cast<void>(read_window_state_text(text, "window.toml"));
        } catch (const StartupError& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    const auto says = [&](const std::string& text, const std::string& words) {
        EXPECT_NE(refused(text).find(words), std::string::npos) << refused(text);
    };
    says("size_px = [1, 2]", "size_px: must be a number from 240");
    says("size_px = [640.0, nan]", "size_px");
    says("span = \"a week\"", "'a week' is none of 1 min, 10 min, 1 h, 6 h, 24 h");
    says("traces = 1", "true or false");
    says("armed = true", "armed: there is no such key");
    says("[show]\nforces = true", "show.forces: there is no such key");
    says("[scene]\nchecksum = \"12\"", "16 hexadecimal digits");
    says("[scene]\nquat_eye_scene_xyzw = [0, 0, 0, 0]", "its norm must be 1");
    says("[scene]\ndistance_a = -1", "scene.distance_a");
    says("[scene]\ntarget_a = [0, 0]", "a list of 3 numbers");
    says("= 3", "line 1");
    says("\n\ntraces = [", "line 3");
}

TEST(WindowStateFile, a_missing_file_gives_the_defaults_and_a_broken_one_is_kept) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("tact-dashboard-test-" + std::to_string(getpid()));
    std::filesystem::create_directory(folder);
    const std::filesystem::path file = folder / "window.toml";
    EXPECT_EQ(read_window_state_file(file).scene, 0U);
    write_window_state_file(file, one_of_all());
    EXPECT_EQ(read_window_state_file(file).scene, one_of_all().scene);
    WindowState impossible = one_of_all();
    impossible.distance_a = std::nan("");
    EXPECT_THROW(write_window_state_file(file, impossible), StartupError);
    EXPECT_EQ(read_window_state_file(file).distance_a, 210.1);
    std::ofstream(file) << "nonsense";
    EXPECT_THROW(static_cast<void>(read_window_state_file(file)), StartupError);
    EXPECT_EQ(std::filesystem::file_size(file), 8U);
    std::filesystem::remove_all(folder);
}

TEST(WindowStateFile, a_camera_is_restored_and_impossible_places_are_ignored) {
    Camera camera, other;
    camera.frame(100.0F);
    other.frame(100.0F);
    camera.rotate(40.0F, -25.0F, 400.0F);
    camera.pan(10.0F, 4.0F, 400.0F);
    camera.zoom(3.0F);
    other.place(camera.target_a(), camera.orientation(), camera.distance_a());
    EXPECT_LT((other.view() - camera.view()).norm(), 1e-4F);
    const Eigen::Matrix4f before = other.view();
    other.place(Eigen::Vector3f::Constant(1e9F), camera.orientation(), 10.0F);
    other.place(camera.target_a(), Eigen::Quaternionf(0.0F, 0.0F, 0.0F, 0.0F), 10.0F);
    other.place(camera.target_a(), camera.orientation(), std::nanf(""));
    EXPECT_EQ(other.view(), before);
    other.place(camera.target_a(), camera.orientation(), 1e12F);
    EXPECT_LE(other.distance_a(), 3000.0F);
}

}  // namespace
}  // namespace tact::gui_window_state_test
