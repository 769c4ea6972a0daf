// Shading of a view from its depth: places that little light of the surroundings reaches are darker, and outlines stand where the depth
// jumps.
//
// Source   McGuire, Mara, Luebke, "Scalable Ambient Obscurance", HPG 2012, equation 10; samples on a spiral, and a mean over 4 x 4 pixels that
//          lie as deep. Outlines: the second difference of the distance.
// Cost     about 40 reads of a pixel; 0.1 to 0.2 s for 1280 x 720 pixels in software rendering, so there only once a view rests
// Thread   frame thread, context current
#pragma once

#include "gui/render/gl.hpp"
#include "gui/render/shading.hpp"

namespace tact {

class RestShading {
public:
    RestShading();
    // Darkens what is in this part of the bound framebuffer, whose depth is that of opaque content alone. size_a: radius of the scene.
    void shade(const Eigen::Matrix4f& projection, const Haze& haze, float size_a, int x_px, int y_px,
               int width_px, int height_px);

private:
    struct Pass {
        GlProgram program;
        GLint distance, slope, reach, haze;
        Pass(const char* what, const char* fragment);
        void use(const Eigen::Matrix4f& projection, const Haze& haze, float size_a, int width_px,
                 int height_px) const;
    };
    Pass open_, apply_;
    GLint corner_;
    GlTexture depth_, openness_;
    GlFramebuffer frame_;
    GlVertexArray empty_;
    int width_px_ = 0, height_px_ = 0;
};

}  // namespace tact
