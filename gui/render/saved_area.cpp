// llvmpipe copies memory (0.3 ms for 1920x1080) only between images of one format and one order of rows; other copies are drawn pixel by pixel
// (9 ms). Mesa stores the window's framebuffer from the top as BGRA, and others from the bottom as RGBA. So rows of the window are saved
// upside down, in the only texture that Mesa makes BGRA: one without a sized format, for data of this order.
#include "gui/render/saved_area.hpp"

namespace tact {
namespace {

GLuint bound_frame() {
    GLint bound = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
    return static_cast<GLuint>(bound);
}

}  // namespace

bool SavedArea::fits(int width_px, int height_px) const {
    return width_px_ > 0 && width_px == width_px_ && height_px == height_px_ &&
           of_window_ == (bound_frame() == 0);
}

void SavedArea::save(int x_px, int y_px, int width_px, int height_px) {
    const GLuint from = bound_frame();
    const bool of_window = from == 0;
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, frame_.get());
    if (width_px != allocated_width_px_ || height_px != allocated_height_px_ || of_window != of_window_) {
        glBindTexture(GL_TEXTURE_2D, colour_.get());
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        if (of_window)
            glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, width_px, height_px, 0, GL_BGRA, GL_UNSIGNED_BYTE,
                         nullptr);
        else
            glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width_px, height_px, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                         nullptr);
        glBindTexture(GL_TEXTURE_2D, 0);
        glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_.get(), 0);
        allocated_width_px_ = width_px;
        allocated_height_px_ = height_px;
        of_window_ = of_window;
    }
    width_px_ = width_px;
    height_px_ = height_px;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, from);
    glDisable(GL_SCISSOR_TEST);
    glBlitFramebuffer(x_px, y_px, x_px + width_px, y_px + height_px, 0, of_window ? height_px : 0, width_px,
                      of_window ? 0 : height_px, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, from);
}

void SavedArea::restore(int x_px, int y_px) {
    const GLuint to = bound_frame();
    glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_.get());
    glDisable(GL_SCISSOR_TEST);
    glBlitFramebuffer(0, of_window_ ? height_px_ : 0, width_px_, of_window_ ? 0 : height_px_, x_px, y_px,
                      x_px + width_px_, y_px + height_px_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, to);
}

}  // namespace tact
