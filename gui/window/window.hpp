// The window and its OpenGL 3.3 core context, with ImGui on it.
//
// Thread   frame thread.  Fails by StartupError that distinguishes a missing display from missing OpenGL 3.3.
// Hidden   the contents of a hidden window are undefined, so frames go to an image of the same size.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gui/dashboard/theme.hpp"
#include "gui/render/target.hpp"
#include "gui/system/keys.hpp"

struct GLFWwindow;

namespace tact {

// Input since it was last taken.
struct WindowInput {
    std::vector<KeyStroke> keys;
    std::vector<int> pressed;  // GLFW keys, since the last frame
    std::vector<std::string> dropped;
    bool any = false;  // of any kind, mouse and keys included
};

class Window {
public:
    // ui_scale: of text and panels, on top of the scale from the display's size and density.
    Window(int width_px, int height_px, bool hidden, float ui_scale = 1.0F);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    struct Size {
        int width = 1, height = 1;        // in ImGui's units
        int width_px = 1, height_px = 1;  // of the framebuffer
    };
    [[nodiscard]] Size size() const;
    [[nodiscard]] bool close_wanted() const;
    void set_title(const std::string& title);
    // Processes input. True: there was some, a mouse button is held, or the size changed.
    bool take_input();
    // Adapts the fonts to the size and begins an ImGui frame.
    void begin_panels(Theme& theme);
    void bind();  // the framebuffer
    void show();  // swaps, or finishes the image if hidden
    [[nodiscard]] std::vector<KeyStroke> take_keys();
    [[nodiscard]] std::vector<std::string> take_dropped();  // paths of files
    [[nodiscard]] GLFWwindow* handle() const { return window_; }
    [[nodiscard]] GLuint frame_buffer() const { return target_ ? target_->name() : 0; }
    [[nodiscard]] Image picture();  // of the frame just drawn, before show()

    [[nodiscard]] const std::string& renderer() const { return renderer_; }
    [[nodiscard]] bool software() const { return software_; }
    // True if the display paces show(): waiting there is not work.
    [[nodiscard]] bool paced_by_display() const { return paced_; }
    [[nodiscard]] double display_period_s() const { return display_period_s_; }  // 0: unknown

private:
    void show_short_presses();
    void open(int width_px, int height_px, bool hidden);
    void start_imgui();
    [[nodiscard]] float density(const Size& size) const;

    GLFWwindow* window_ = nullptr;
    bool software_ = false, paced_ = false, imgui_ = false;
    float ui_scale_ = 1.0F;
    double display_period_s_ = 0.0;
    std::string renderer_;
    std::unique_ptr<OffscreenTarget> target_;
    WindowInput input_;
    std::vector<int> held_for_a_frame_;
    Size size_before_{0, 0, 0, 0};
};

}  // namespace tact
