// Stairs along edges made smooth in a finished picture, whatever drew it: triangles, rays or balls.
//
// How      where a pixel's lightness differs from its neighbours', the edge is followed both ways to its ends; its distance
//          from the nearer one says how much of the pixel lies beyond it, and that much of the neighbour is mixed in.
//          (T. Lottes, FXAA, NVIDIA 2009.) What is no edge stays the same to the bit.
// Cost     one pass over the pixels, mostly six reads of a texture each
// Thread   frame thread, context current.  Fails by StartupError: the driver refuses the program.
#pragma once

#include "gui/render/gl.hpp"

namespace tact {

class EdgeSmoothing {
public:
    EdgeSmoothing();
    // Of the bound frame buffer: the area of its viewport; y from below.
    void smooth(int x_px, int y_px, int width_px, int height_px);

private:
    GlProgram program_;
    GlTexture picture_;
    GlVertexArray empty_;
    GLint corner_place_;
    int width_px_ = 0, height_px_ = 0;
};

}  // namespace tact
