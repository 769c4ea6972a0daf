// Where fluids are gathered before they are laid over the picture: sums by pixel, and the depth of the scene that may
// hide them. Coarser than the picture by a whole factor.
//
// Thread   frame thread, context current.
// Fails by StartupError where the driver refuses such an image.
#pragma once

#include "gui/render/gl.hpp"

namespace tact {

class FluidTarget {
public:
    // coarser: pixels of the picture along an edge of one here.
    FluidTarget(int picture_width_px, int picture_height_px, int coarser);
    ~FluidTarget();
    FluidTarget(const FluidTarget&) = delete;
    FluidTarget& operator=(const FluidTarget&) = delete;

    // The depth of the bound frame buffer, whose lower left corner of the picture is given.
    void take_depth(int x_px, int y_px) const;
    void bind() const { glBindFramebuffer(GL_FRAMEBUFFER, frame_); }  // to draw sums into
    void bind_sums(GLenum unit) const;                                // to read from
    void bind_depth(GLenum unit) const;
    [[nodiscard]] bool fits(int picture_width_px, int picture_height_px, int coarser) const {
        return picture_width_px == width_px_ && picture_height_px == height_px_ && coarser == coarser_;
    }
    [[nodiscard]] int width_px() const { return (width_px_ + coarser_ - 1) / coarser_; }
    [[nodiscard]] int height_px() const { return (height_px_ + coarser_ - 1) / coarser_; }
    [[nodiscard]] int coarser() const { return coarser_; }

private:
    int width_px_, height_px_, coarser_;  // of the picture
    GLuint frame_ = 0, sums_ = 0, depth_ = 0;
};

}  // namespace tact
