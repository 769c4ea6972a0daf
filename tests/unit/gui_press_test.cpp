// A key that goes down and up between two frames is seen by the fields of a window.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "deploy/tact/child.hpp"
#include "deploy/tact/files.hpp"
#include "deploy/tact/x_server.hpp"
#include "gui/window/window.hpp"

// Graphics drivers and X libraries deliberately keep memory until exit.
extern "C" const char* __asan_default_options() { return "detect_leaks=0"; }

namespace tact::gui_press_test {
namespace {

bool backspace_is_down() {
#if IMGUI_VERSION_NUM < 18700
    return ImGui::GetIO().KeysDown[GLFW_KEY_BACKSPACE];
#else
    return ImGui::IsKeyDown(ImGuiKey_Backspace);
#endif
}

TEST(Window, a_press_shorter_than_a_frame_is_seen_for_one_frame) {
    if (launch::find_in_path("Xvfb").empty()) GTEST_SKIP() << "Xvfb is not installed";
    const launch::ScratchFolder scratch;
    const launch::XServer screen(scratch.path(), 640, 480);
    for (const auto& [key, value] : screen.environment())
        value.empty() ? unsetenv(key.c_str()) : setenv(key.c_str(), value.c_str(), 1);
    Window window(640, 480, true);
    Theme theme;
    const auto frame = [&] {
        window.begin_panels(theme);
        const bool down = backspace_is_down();
        ImGui::Render();
        return down;
    };
    const GLFWkeyfun press = glfwSetKeyCallback(window.handle(), nullptr);
    ASSERT_NE(press, nullptr);
    glfwSetKeyCallback(window.handle(), press);
    EXPECT_FALSE(frame());
    for (int times = 0; times < 3; ++times) {
        press(window.handle(), GLFW_KEY_BACKSPACE, 0, GLFW_PRESS, 0);
        press(window.handle(), GLFW_KEY_BACKSPACE, 0, GLFW_RELEASE, 0);
        EXPECT_TRUE(frame());
        EXPECT_FALSE(frame());
        EXPECT_FALSE(frame());
    }
}

}  // namespace
}  // namespace tact::gui_press_test
