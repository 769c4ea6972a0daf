// A 3D view with fewer pixels than its place in the window, and its enlargement. Its share of the pixels is the level "gui.resolution".
//
// How       the view is drawn into the lower left part of an image, sharpened there, and enlarged by bilinear interpolation. Sharpening before
//           instead of after costs as many times less as there are fewer pixels; together they are close to a bicubic kernel. It
//           stays between the least and the greatest of the pixel and its four neighbours, so edges get no halo.
// Thread    frame thread, context current.  Fails by StartupError: the driver rejects the image or a program.
#pragma once

#include "gui/render/gl.hpp"

namespace tact {

// Size of a view that is drawn with this share of its pixels; at least one by one.
struct ViewSize {
    int width_px = 1, height_px = 1;
    [[nodiscard]] static ViewSize of_share(int width_px, int height_px, double share);
    [[nodiscard]] std::uint32_t pixels() const {
        return static_cast<std::uint32_t>(width_px) * static_cast<std::uint32_t>(height_px);
    }
};

class ViewTarget {
public:
    ViewTarget();
    // Binds the image for a view of this size, whose place in the window has the size `most`. Clears its depth; colour is undefined.
    void begin(const ViewSize& size, const ViewSize& most);
    // Shows it in a rectangle of this framebuffer, which it binds; y from below.
    void show(GLuint frame_buffer, int x_px, int y_px, int width_px, int height_px);

private:
    GlProgram sharpen_, enlarge_;
    GLint last_place_, part_place_, edge_place_;
    GlTexture drawn_, sharp_;
    GlRenderbuffer depth_;
    GlFramebuffer drawn_frame_, sharp_frame_;
    GlVertexArray empty_;
    ViewSize size_, allocated_{0, 0};
};

}  // namespace tact
