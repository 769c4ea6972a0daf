#include "gui/stereo/stage_windows.hpp"

#include <epoxy/gl.h>
//
#include <GLFW/glfw3.h>

#include <string>

#include "ipc/base/error.hpp"

namespace tact {

StageWindows::StageWindows(GLFWwindow* dashboard, const StageSettings& settings, bool hidden,
                           bool paced_by_display)
    : dashboard_(dashboard), mode_(settings.mode) {
    int monitors = 0;
    GLFWmonitor** const monitor = glfwGetMonitors(&monitors);
    const std::size_t count = mode_ == StereoMode::two_windows ? 2 : 1;
    try {
        for (std::size_t i = 0; i < count; ++i) {
            GLFWmonitor* on = nullptr;
            int width = settings.width_px, height = settings.height_px;
            if (i < settings.monitors.size() && !hidden) {
                const int wanted = settings.monitors[i];
                if (wanted >= monitors)
                    throw StartupError("opening a window for the stereo display",
                                       "no monitor " + std::to_string(wanted) + "; the range is 0 to " +
                                           std::to_string(monitors - 1),
                                       "choose another one in 'monitors' of the stage file");
                on = monitor[wanted];
                const GLFWvidmode* const video = glfwGetVideoMode(on);
                width = video->width;
                height = video->height;
                glfwWindowHint(GLFW_REFRESH_RATE, video->refreshRate);
            }
            glfwWindowHint(GLFW_VISIBLE, hidden ? GLFW_FALSE : GLFW_TRUE);
            glfwWindowHint(GLFW_STEREO, mode_ == StereoMode::quad_buffer ? GLFW_TRUE : GLFW_FALSE);
            glfwWindowHint(GLFW_FOCUS_ON_SHOW, GLFW_FALSE);
            GLFWwindow* const window =
                glfwCreateWindow(width, height, i == 0 ? "Tact: stereo" : "Tact: right eye", on, dashboard);
            glfwWindowHint(GLFW_STEREO, GLFW_FALSE);
            if (window == nullptr)
                throw StereoRefused(
                    mode_ == StereoMode::quad_buffer ? "the driver offers no quad-buffered stereo"
                                                     : "the driver rejects its window",
                    mode_ == StereoMode::quad_buffer
                        ? "enable stereo in the settings of the graphics driver, or use another "
                          "mode: side-by-side, top-bottom, two-windows or anaglyph"
                        : "use another mode: side-by-side, top-bottom or anaglyph");
            outputs_.push_back({window, 0});
            glfwMakeContextCurrent(window);
            glfwSwapInterval(paced_by_display && i == 0 ? 1 : 0);
            glGenFramebuffers(1, &outputs_.back().frame);
        }
    } catch (...) {
        close();
        throw;
    }
    glfwMakeContextCurrent(dashboard_);
}

StageWindows::~StageWindows() { close(); }

void StageWindows::close() noexcept {
    for (const Output& output : outputs_) {
        glfwMakeContextCurrent(output.window);
        if (output.frame != 0) glDeleteFramebuffers(1, &output.frame);
        glfwDestroyWindow(output.window);
    }
    outputs_.clear();
    glfwMakeContextCurrent(dashboard_);
}

int StageWindows::width_px() const {
    int width = 1, height = 1;
    glfwGetFramebufferSize(outputs_[0].window, &width, &height);
    return width > 0 ? width : 1;
}

int StageWindows::height_px() const {
    int width = 1, height = 1;
    glfwGetFramebufferSize(outputs_[0].window, &width, &height);
    return height > 0 ? height : 1;
}

bool StageWindows::close_wanted() const {
    for (const Output& output : outputs_)
        if (glfwWindowShouldClose(output.window) == GLFW_TRUE) return true;
    return false;
}

void StageWindows::copy(Output& output, GLuint texture, GLenum buffer, int width_px, int height_px) {
    int width = 1, height = 1;
    glfwGetFramebufferSize(output.window, &width, &height);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, output.frame);
    glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glDrawBuffer(buffer);
    glBlitFramebuffer(0, 0, width_px, height_px, 0, 0, width, height, GL_COLOR_BUFFER_BIT,
                      width == width_px && height == height_px ? GL_NEAREST : GL_LINEAR);
}

void StageWindows::show(GLuint left_or_all, GLuint right, int width_px, int height_px) {
    const GLsync drawn = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glFlush();
    for (std::size_t i = 0; i < outputs_.size(); ++i) {
        glfwMakeContextCurrent(outputs_[i].window);
        glWaitSync(drawn, 0, GL_TIMEOUT_IGNORED);
        if (mode_ == StereoMode::quad_buffer) {
            copy(outputs_[i], left_or_all, GL_BACK_LEFT, width_px, height_px);
            copy(outputs_[i], right, GL_BACK_RIGHT, width_px, height_px);
        } else {
            copy(outputs_[i], i == 0 ? left_or_all : right, GL_BACK, width_px, height_px);
        }
        glfwSwapBuffers(outputs_[i].window);
    }
    glfwMakeContextCurrent(dashboard_);
    glDeleteSync(drawn);
}

}  // namespace tact
