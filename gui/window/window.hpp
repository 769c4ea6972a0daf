// The window and its OpenGL 3.3 core context, with ImGui on it.
//
// Thread   frame thread.  Fails by StartupError that tells no display from no OpenGL 3.3.
// Hidden   a window that is not shown holds nothing defined, so pictures go to an image of the same size.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gui/dashboard/theme.hpp"
#include "gui/render/target.hpp"
#include "gui/system/keys.hpp"

struct GLFWwindow;

namespace tact {

// What came in since it was last taken.
struct WindowInput {
    std::vector<KeyStroke> keys;
    std::vector<std::string> dropped;
};

class Window {
public:
    // ui_scale: of letters and panels, times what size and density of the display ask for.
    Window(int width_px, int height_px, bool hidden, float ui_scale = 1.0F);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    struct Size {
        int width = 1, height = 1;        // as ImGui counts
        int width_px = 1, height_px = 1;  // of the frame buffer
    };
    [[nodiscard]] Size size() const;
    [[nodiscard]] bool close_wanted() const;
    void set_title(const std::string& title);
    // Handles input, adapts the fonts to the size, begins an ImGui frame and binds the frame buffer.
    void begin_frame(Theme& theme);
    void draw_panels();  // what ImGui was told in this frame
    void show();         // swaps, or finishes the image where hidden
    [[nodiscard]] std::vector<KeyStroke> take_keys();
    [[nodiscard]] std::vector<std::string> take_dropped();  // paths of files
    [[nodiscard]] GLFWwindow* handle() const { return window_; }
    [[nodiscard]] GLuint frame_buffer() const { return target_ ? target_->name() : 0; }
    [[nodiscard]] Image picture();  // of the frame just drawn, before show()

    [[nodiscard]] const std::string& renderer() const { return renderer_; }
    [[nodiscard]] bool software() const { return software_; }
    // The display sets the pace of show(): waiting there is not work.
    [[nodiscard]] bool paced_by_display() const { return paced_; }
    [[nodiscard]] double display_period_s() const { return display_period_s_; }  // 0: not known

private:
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
};

}  // namespace tact
