// Accumulation buffers for fluids: sums per pixel, and the depth of the scene that may hide them. Coarser than the
// frame by a whole factor.
//
// Thread   frame thread, context current.
// Fails by StartupError: the driver rejects such an image.
#pragma once

#include "gui/render/gl.hpp"

namespace tact {

class FluidTarget {
public:
    // coarser: edge of one pixel here, in pixels of the frame.
    FluidTarget(int frame_width_px, int frame_height_px, int coarser);
    ~FluidTarget();
    FluidTarget(const FluidTarget&) = delete;
    FluidTarget& operator=(const FluidTarget&) = delete;

    // Copies the depth of the bound framebuffer, from this lower left corner of the view.
    void take_depth(int x_px, int y_px) const;
    void bind() const { glBindFramebuffer(GL_FRAMEBUFFER, frame_); }  // to draw sums into
    void bind_sums(GLenum unit) const;                                // to read from
    void bind_depth(GLenum unit) const;
    [[nodiscard]] bool fits(int frame_width_px, int frame_height_px, int coarser) const {
        return frame_width_px == width_px_ && frame_height_px == height_px_ && coarser == coarser_;
    }
    [[nodiscard]] int width_px() const { return (width_px_ + coarser_ - 1) / coarser_; }
    [[nodiscard]] int height_px() const { return (height_px_ + coarser_ - 1) / coarser_; }
    [[nodiscard]] int coarser() const { return coarser_; }

private:
    int width_px_, height_px_, coarser_;  // of the frame
    GLuint frame_ = 0, sums_ = 0, depth_ = 0;
};

}  // namespace tact
