// The shader programs of triangles, lines, points and the background. Atoms: gui/docking/impostors.hpp.
//
// Light   by pixel, with interpolated normals; or by vertex, so that the cost of a frame in software rendering follows the number of vertices
//         (set by the governor) and not that of pixels: light_by_pixel(). Attributes: 0 position, 1 normal, 2 colour.
#pragma once

#include "gui/render/gl.hpp"
#include "gui/render/shading.hpp"

namespace tact {

// Colouring of triangles with normals.
struct Paint {
    bool glass = false;    // transparent where it faces the eye, dense at the rim
    bool closed = false;   // where a cut opens it, its back faces look like the face of the cut
    float opacity = 1.0F;  // multiplies the colour's own
    Eigen::Vector4f tint = Eigen::Vector4f::Zero();  // rgb replaces the vertex colour where a is 1
};

class Programs {
public:
    Programs();
    void use_lit(const Eigen::Matrix4f& eye_from_local, const Eigen::Matrix4f& projection, const Haze& haze,
                 const Paint& paint);
    // Of triangles, from the next use on.
    void light_by_pixel(bool on) { by_pixel_ = on; }
    // While on, of triangles only one layer is drawn, by pixel (SortedGlass): behind the depth in texture unit 2, in front of that in unit 1.
    void peel(bool on) { peels_ = on; }
    // Lines and boxes in one colour.
    void use_flat(const Eigen::Matrix4f& eye_from_local, const Eigen::Matrix4f& projection, const Haze& haze,
                  const float rgba[4]);
    // Points drawn as balls of radius_a, flat in depth.
    void use_balls(const Eigen::Matrix4f& eye_from_local, const Eigen::Matrix4f& projection, const Haze& haze,
                   const float rgba[4], float radius_a, float view_height_px);
    void draw_background();

private:
    struct LitProgram {
        GlProgram program;
        ViewUniforms view;
        GLint glass, opacity, tint, closed;
        LitProgram(const char* what, const char* vertex, const char* fragment);
    };
    LitProgram lit_, cut_, fine_, peel_;
    bool by_pixel_ = false, peels_ = false;
    GlProgram flat_, balls_, background_;
    GlVertexArray empty_;
    ViewUniforms flat_view_, balls_view_;
    GLint flat_colour_, balls_colour_, balls_size_;
};

}  // namespace tact
