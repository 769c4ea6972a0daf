// Anti-aliases edges in a finished frame, whatever drew it: triangles, rays or balls.
//
// How      FXAA (T. Lottes, NVIDIA 2009): where a pixel's lightness differs from that of adjacent pixels, the edge
//          is followed both ways to its ends. The distance to the nearer end gives the fraction of the pixel beyond
//          the edge, and that fraction of the adjacent pixel is blended in. Pixels without an edge stay identical to
//          the bit.
// Cost     one pass over the pixels, mostly six texture reads each
// Thread   frame thread, context current.  Fails by StartupError: the driver rejects the program.
#pragma once

#include "gui/render/gl.hpp"

namespace tact {

class EdgeSmoothing {
public:
    EdgeSmoothing();
    // Processes this rectangle of the bound framebuffer; y from below.
    void smooth(int x_px, int y_px, int width_px, int height_px);

private:
    GlProgram program_;
    GlTexture picture_;
    GlVertexArray empty_;
    GLint corner_place_;
    int width_px_ = 0, height_px_ = 0;
};

}  // namespace tact
