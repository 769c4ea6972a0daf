// Shared by all shaders: the lighting, the haze that fades distant content into the background (depth cue), and the plane that cuts off what
// is near.
#pragma once

#include <Eigen/Core>
#include <string>

#include "gui/render/gl.hpp"

namespace tact {

inline constexpr float kBackgroundTop[3] = {0.105F, 0.135F, 0.180F};
inline constexpr float kBackgroundBottom[3] = {0.035F, 0.045F, 0.065F};

struct Haze {
    float begin_a = 0.0F, end_a = 1.0F;  // distance from the eye
    float strength = 0.0F;               // at the end; 0: none, 1: opaque
    float cut_a = 0.0F;  // what is nearer, measured along the view axis, is not drawn; 0: all is
    // Background that distant content fades into.
    Eigen::Vector3f top{kBackgroundTop}, bottom{kBackgroundBottom};

    [[nodiscard]] Haze uncut() const {
        Haze whole = *this;
        whole.cut_a = 0.0F;
        return whole;
    }
    bool operator==(const Haze&) const = default;
};

struct ViewUniforms {
    GLint eye = -1, projection = -1, haze = -1, cut = -1, ground_top = -1, ground_bottom = -1;
    explicit ViewUniforms(const GlProgram& program);
    // For the program in use.
    void set(const Eigen::Matrix4f& eye_from_local, const Eigen::Matrix4f& projection,
             const Haze& haze) const;
};

// Prepends "#version", the uniforms above (u_cut: cut_a) and two functions to the text:
//   vec4 lit(vec3 colour, vec3 n, vec3 v)   n, v unit vectors in eye space, n towards the eye; a: the highlight
//   vec4 hazed(vec4 colour, float depth_a, float y)   y: position in clip space, -1 to 1
[[nodiscard]] std::string shader(const char* text);

}  // namespace tact
