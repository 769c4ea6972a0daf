// What an operating microscope makes of a picture: sharp at the distance of its focus and blurred before and behind it, in
// a round field with a darker rim.
//
// Blur     from smaller copies of the picture (mipmaps), which costs the same at any radius. Colours of sharp things
//          spread a little over blurred ones beside them. Software rendering of 960 x 600 takes 18 ms for all
// Thread   frame thread, context current
#pragma once

#include <Eigen/Core>

#include "gui/render/gl.hpp"

namespace tact {

class Microscope {
public:
    static constexpr float kRadius = 0.495F;         // of the field, of the shorter side of the view
    static constexpr float kBlurMost = 0.012F;       // radius, of the view's height
    static constexpr float kBlurPerDistance = 9.0F;  // of that, per relative distance from the focus

    Microscope();
    struct View {
        int x_px = 0, y_px = 0, width_px = 1, height_px = 1;
        Eigen::Matrix4f projection = Eigen::Matrix4f::Identity();
        float focus_a = 0.0F;  // distance from the eye that is sharp; 0: all is
    };
    // Replaces what was drawn in the viewport, by its depths; leaves the depths, and the depth test on.
    void draw(const View& view);

private:
    void resize(int width_px, int height_px);

    GlProgram program_;
    GLint scale_, distance_, blur_;
    GlTexture colour_, depth_;
    int width_px_ = 0, height_px_ = 0;
    GlVertexArray array_;
    GlBuffer corners_;
};

}  // namespace tact
