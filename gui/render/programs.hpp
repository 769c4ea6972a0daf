// The shader programs, shared by everything that is drawn.
//
// Light is computed per vertex, so that the cost of a frame follows the vertices drawn (the governor's knob)
// and drawing on the processor alone stays usable. Attributes: 0 position, 1 normal, 2 colour.
#pragma once

#include "gui/render/gl.hpp"

namespace tact {

struct Haze {  // what lies far behind fades into the background
    float begin_a = 0.0F, end_a = 1.0F;
};

inline constexpr float kBackgroundTop[3] = {0.105F, 0.135F, 0.180F};
inline constexpr float kBackgroundBottom[3] = {0.035F, 0.045F, 0.065F};

class Programs {
public:
    Programs();
    // Triangles with normals. glass: seen through where it faces the eye, dense at the rim.
    void use_lit(const Eigen::Matrix4f& eye_from_local, const Eigen::Matrix4f& projection, const Haze& haze,
                 bool glass);
    // Lines and box, one colour.
    void use_flat(const Eigen::Matrix4f& eye_from_local, const Eigen::Matrix4f& projection, const Haze& haze,
                  const float rgba[4]);
    // Points drawn as balls of radius_a; px_per_a at distance 1.
    void use_balls(const Eigen::Matrix4f& eye_from_local, const Eigen::Matrix4f& projection, const Haze& haze,
                   const float rgba[4], float radius_a, float view_height_px);
    void draw_background();

private:
    GlProgram lit_, flat_, balls_, background_;
    GlVertexArray empty_;
    struct {
        GLint eye, projection, haze, glass;
    } at_lit_{};
    struct {
        GLint eye, projection, haze, colour;
    } at_flat_{};
    struct {
        GLint eye, projection, haze, colour, size;
    } at_balls_{};
};

}  // namespace tact
