// An offscreen image to draw into, and reading back of pixels.
#pragma once

#include <cstdint>
#include <vector>

#include "gui/render/gl.hpp"

namespace tact {

// Colour and depth of a fixed size, for hidden windows: the contents of a hidden window are undefined.
class OffscreenTarget {
public:
    OffscreenTarget(int width_px, int height_px);
    ~OffscreenTarget();
    OffscreenTarget(const OffscreenTarget&) = delete;
    OffscreenTarget& operator=(const OffscreenTarget&) = delete;
    void bind() const { glBindFramebuffer(GL_FRAMEBUFFER, frame_); }
    [[nodiscard]] GLuint name() const { return frame_; }
    [[nodiscard]] int width_px() const { return width_px_; }
    [[nodiscard]] int height_px() const { return height_px_; }

private:
    int width_px_, height_px_;
    GLuint frame_ = 0, colour_ = 0, depth_ = 0;
};

struct Image {
    std::uint32_t width_px = 0, height_px = 0;
    std::vector<std::uint8_t> rgb;  // rows from the top
};
// Reads the bound framebuffer.
Image read_pixels(int width_px, int height_px);

}  // namespace tact
