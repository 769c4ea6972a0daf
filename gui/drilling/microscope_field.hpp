// The round field of an operating microscope: everything outside is black, and the rim a little darker.
//
// Thread   frame thread, context current
#pragma once

#include "gui/render/gl.hpp"

namespace tact {

class MicroscopeField {
public:
    // Radius of the field, of the shorter side of the view.
    static constexpr float kRadius = 0.495F;

    MicroscopeField();
    // Over what was drawn in the viewport of this size. Leaves blending and the depth test on.
    void draw(int width_px, int height_px);

private:
    GlProgram program_;
    GLint scale_;
    GlVertexArray array_;
    GlBuffer corners_;
};

}  // namespace tact
