// Windows of a stereo display besides the dashboard's: one, or one for each eye (two projectors).
//
// Images    are drawn in the dashboard's context and copied into these windows, whose contexts share its textures.
// Thread    frame thread; the dashboard's context is current before and after each call.
// Fails by  StartupError: a missing monitor; StereoRefused: the driver offers no such window, so one image must do.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "gui/render/gl.hpp"
#include "gui/render/target.hpp"
#include "gui/stereo/stage_file.hpp"
#include "ipc/base/error.hpp"

struct GLFWwindow;

namespace tact {

class StereoRefused : public StartupError {
public:
    StereoRefused(std::string why, const std::string& fix)
        : StartupError("opening a window for the stereo display", why, fix),
          why_(std::move(why)),
          fix_(fix) {}
    [[nodiscard]] const std::string& why() const { return why_; }
    [[nodiscard]] const std::string& fix() const { return fix_; }

private:
    std::string why_, fix_;
};

class StageWindows {
public:
    // hidden: for images in files.
    StageWindows(GLFWwindow* dashboard, const StageSettings& settings, bool hidden, bool paced_by_display);
    ~StageWindows();
    StageWindows(const StageWindows&) = delete;
    StageWindows& operator=(const StageWindows&) = delete;

    // Size of the first window, for which the output must be drawn.
    [[nodiscard]] int width_px() const;
    [[nodiscard]] int height_px() const;
    [[nodiscard]] bool close_wanted() const;
    // One image in one window; or each eye's image in its window, or its buffer.
    void show(GLuint left_or_all, GLuint right, int width_px, int height_px);

private:
    struct Output {
        GLFWwindow* window = nullptr;
        GLuint frame = 0;  // in that window's context
    };
    void copy(Output& output, GLuint texture, GLenum buffer, int width_px, int height_px);
    void close() noexcept;

    GLFWwindow* dashboard_;
    StereoMode mode_;
    std::vector<Output> outputs_;
};

}  // namespace tact
