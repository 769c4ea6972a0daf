// Draws flat figures of picture_pen.hpp: later ones cover earlier ones, by order and not by depth.
//
// Thread   frame thread, context current. Draws into the bound framebuffer and its viewport.
#pragma once

#include <span>

#include "gui/render/eye_view.hpp"
#include "gui/render/gl.hpp"
#include "gui/stereo/picture_pen.hpp"

namespace tact {

class PicturePainter {
public:
    PicturePainter();
    // eye: for a scene in millimetres on the glass.
    void draw(const EyeView& eye, std::span<const PictureVertex> vertices);

private:
    GlProgram program_;
    GLint clip_from_glass_;
    GlVertexArray array_;
    GlBuffer vertices_;
};

}  // namespace tact
