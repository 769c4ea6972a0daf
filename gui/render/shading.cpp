#include "gui/render/shading.hpp"

namespace tact {
namespace {

// The specular exponent is 32, by squaring and without a logarithm, because a CPU may have to render this.
constexpr char kHead[] = R"(#version 330 core
uniform mat4 u_eye;
uniform mat4 u_projection;
uniform vec3 u_haze;  // begin, end, strength
uniform float u_cut;
uniform vec3 u_ground_top;
uniform vec3 u_ground_bottom;
vec4 lit(vec3 colour, vec3 n, vec3 v) {
    vec3 key = vec3(0.352, 0.754, 0.553);
    float diffuse = max(dot(n, key), 0.0);
    float fill = 0.5 + 0.5 * n.y;
    float shine = max(dot(n, normalize(key + v)), 0.0);
    shine *= shine; shine *= shine; shine *= shine; shine *= shine; shine *= shine;
    return vec4(colour * (0.22 + 0.26 * fill + 0.62 * diffuse) + vec3(0.22 * shine), shine);
}
float haze_at(float depth_a) { return u_haze.z * smoothstep(u_haze.x, u_haze.y, depth_a); }
vec4 hazed(vec4 colour, float depth_a, float y) {
    vec3 ground = mix(u_ground_bottom, u_ground_top, 0.5 + 0.5 * y);
    return vec4(mix(colour.rgb, ground, haze_at(depth_a)), colour.a);
}
)";

}  // namespace

ViewUniforms::ViewUniforms(const GlProgram& program)
    : eye(program.uniform("u_eye")),
      projection(program.uniform("u_projection")),
      haze(program.uniform("u_haze")),
      cut(program.uniform("u_cut")),
      ground_top(program.uniform("u_ground_top")),
      ground_bottom(program.uniform("u_ground_bottom")) {}

void ViewUniforms::set(const Eigen::Matrix4f& eye_from_local, const Eigen::Matrix4f& p, const Haze& h) const {
    set_uniform(eye, eye_from_local);
    set_uniform(projection, p);
    glUniform3f(haze, h.begin_a, h.end_a, h.strength);
    glUniform1f(cut, h.cut_a);
    glUniform3fv(ground_top, 1, h.top.data());
    glUniform3fv(ground_bottom, 1, h.bottom.data());
}

std::string shader(const char* text) { return std::string(kHead) + text; }

}  // namespace tact
