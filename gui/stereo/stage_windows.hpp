// Windows of a stereo display besides the dashboard's: one, or one for each eye (two projectors).
//
// Images    are drawn in the dashboard's context and copied into these windows, whose contexts share its textures.
// Thread    frame thread; the dashboard's context is current before and after each call.
// Fails by  StartupError: a missing monitor, a driver without quad-buffered stereo.
#pragma once

#include <vector>

#include "gui/render/gl.hpp"
#include "gui/render/target.hpp"
#include "gui/stereo/stage_file.hpp"

struct GLFWwindow;

namespace tact {

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
