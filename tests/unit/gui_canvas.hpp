// A hidden window on an X server of its own, and an image to draw into: one for all cases of a suite.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>

#include "deploy/tact/child.hpp"
#include "deploy/tact/x_server.hpp"
#include "gui/render/target.hpp"
#include "gui/window/window.hpp"

// Graphics drivers and X libraries deliberately keep memory until exit.
extern "C" const char* __asan_default_options() { return "detect_leaks=0"; }

namespace tact {

template <int width_px, int height_px>
class Canvas : public testing::Test {
protected:
    static void SetUpTestSuite() {
        if (launch::find_in_path("Xvfb").empty()) return;
        char name[] = "/tmp/tact-canvas-XXXXXX";
        folder_ = mkdtemp(name);
        setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
        server_ = std::make_unique<launch::XServer>(folder_, 800, 600);
        for (const auto& [key, value] : server_->environment())
            value.empty() ? unsetenv(key.c_str()) : setenv(key.c_str(), value.c_str(), 1);
        window_ = std::make_unique<Window>(width_px, height_px, true);
        target_ = std::make_unique<OffscreenTarget>(width_px, height_px);
    }
    static void TearDownTestSuite() {
        target_.reset();
        window_.reset();
        server_.reset();
        if (!folder_.empty()) std::filesystem::remove_all(folder_);
    }
    // Skips the case if there is no X server to draw on; otherwise binds the image.
    void SetUp() override {
        if (!server_) GTEST_SKIP() << "Xvfb is not installed: there is no display to draw on";
        target_->bind();
    }

    inline static std::string folder_;
    inline static std::unique_ptr<launch::XServer> server_;
    inline static std::unique_ptr<Window> window_;
    inline static std::unique_ptr<OffscreenTarget> target_;
};

}  // namespace tact
