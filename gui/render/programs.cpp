#include "gui/render/programs.hpp"

namespace tact {
namespace {

constexpr char kLitVertex[] = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 colour;
uniform mat4 u_eye;
uniform mat4 u_projection;
uniform vec2 u_haze;
uniform float u_glass;
out vec4 v_colour;
const vec3 fog = vec3(0.070, 0.090, 0.122);
void main() {
    vec4 p = u_eye * vec4(position, 1.0);
    vec3 n = normalize(mat3(u_eye) * normal);
    vec3 v = normalize(-p.xyz);
    float facing = dot(n, v);
    if (facing < 0.0) n = -n;  // both sides are lit
    vec3 key = normalize(vec3(0.35, 0.75, 0.55));
    float diffuse = max(dot(n, key), 0.0);
    float fill = 0.5 + 0.5 * n.y;
    float shine = max(dot(n, normalize(key + v)), 0.0);
    shine *= shine; shine *= shine; shine *= shine; shine *= shine; shine *= shine;  // to the 32nd, without a logarithm
    vec3 c = colour.rgb * (0.22 + 0.26 * fill + 0.62 * diffuse) + vec3(0.22 * shine);
    float h = smoothstep(u_haze.x, u_haze.y, -p.z);
    float rim = 1.0 - abs(facing);
    float a = colour.a;
    if (u_glass > 0.5) {
        a = mix(0.17, 0.78, rim * rim) + 0.45 * shine;
        if (facing < 0.0) a *= 0.55;
        a *= 1.0 - 0.55 * h;
    }
    v_colour = vec4(mix(c, fog, 0.62 * h), min(a, 1.0));
    gl_Position = u_projection * p;
}
)";
constexpr char kPlainFragment[] = R"(#version 330 core
in vec4 v_colour;
out vec4 colour;
void main() { colour = v_colour; }
)";
constexpr char kFlatVertex[] = R"(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 u_eye;
uniform mat4 u_projection;
uniform vec2 u_haze;
uniform vec4 u_colour;
out vec4 v_colour;
const vec3 fog = vec3(0.070, 0.090, 0.122);
void main() {
    vec4 p = u_eye * vec4(position, 1.0);
    float h = smoothstep(u_haze.x, u_haze.y, -p.z);
    v_colour = vec4(mix(u_colour.rgb, fog, 0.62 * h), u_colour.a);
    gl_Position = u_projection * p;
}
)";
constexpr char kBallVertex[] = R"(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 u_eye;
uniform mat4 u_projection;
uniform vec2 u_haze;
uniform vec4 u_colour;
uniform vec2 u_size;  // radius, pixels per ångström at distance 1
out vec4 v_colour;
const vec3 fog = vec3(0.070, 0.090, 0.122);
void main() {
    vec4 p = u_eye * vec4(position, 1.0);
    float h = smoothstep(u_haze.x, u_haze.y, -p.z);
    v_colour = vec4(mix(u_colour.rgb, fog, 0.62 * h), u_colour.a);
    gl_PointSize = clamp(2.0 * u_size.x * u_size.y / max(-p.z, 1e-3), 3.0, 64.0);
    gl_Position = u_projection * p;
}
)";
constexpr char kBallFragment[] = R"(#version 330 core
in vec4 v_colour;
out vec4 colour;
void main() {
    vec2 d = 2.0 * gl_PointCoord - 1.0;
    float r2 = dot(d, d);
    if (r2 > 1.0) discard;
    float z = sqrt(1.0 - r2);
    float light = 0.35 + 0.65 * max(dot(vec3(d.x, -d.y, z), vec3(0.35, 0.75, 0.56)), 0.0);
    colour = vec4(v_colour.rgb * light, v_colour.a);
}
)";
constexpr char kBackgroundVertex[] = R"(#version 330 core
out vec3 v_colour;
uniform vec3 u_top;
uniform vec3 u_bottom;
void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    v_colour = mix(u_bottom, u_top, 0.5 + 0.5 * corner.y);
    gl_Position = vec4(corner, 0.0, 1.0);
}
)";
constexpr char kBackgroundFragment[] = R"(#version 330 core
in vec3 v_colour;
out vec4 colour;
void main() { colour = vec4(v_colour, 1.0); }
)";

}  // namespace

Programs::Programs()
    : lit_("surface", kLitVertex, kPlainFragment),
      flat_("line", kFlatVertex, kPlainFragment),
      balls_("point", kBallVertex, kBallFragment),
      background_("background", kBackgroundVertex, kBackgroundFragment) {
    at_lit_ = {lit_.uniform("u_eye"), lit_.uniform("u_projection"), lit_.uniform("u_haze"),
               lit_.uniform("u_glass")};
    at_flat_ = {flat_.uniform("u_eye"), flat_.uniform("u_projection"), flat_.uniform("u_haze"),
                flat_.uniform("u_colour")};
    at_balls_ = {balls_.uniform("u_eye"), balls_.uniform("u_projection"), balls_.uniform("u_haze"),
                 balls_.uniform("u_colour"), balls_.uniform("u_size")};
    background_.use();
    glUniform3fv(background_.uniform("u_top"), 1, kBackgroundTop);
    glUniform3fv(background_.uniform("u_bottom"), 1, kBackgroundBottom);
}

void Programs::use_lit(const Eigen::Matrix4f& eye, const Eigen::Matrix4f& projection, const Haze& haze,
                       bool glass) {
    lit_.use();
    set_uniform(at_lit_.eye, eye);
    set_uniform(at_lit_.projection, projection);
    glUniform2f(at_lit_.haze, haze.begin_a, haze.end_a);
    glUniform1f(at_lit_.glass, glass ? 1.0F : 0.0F);
}

void Programs::use_flat(const Eigen::Matrix4f& eye, const Eigen::Matrix4f& projection, const Haze& haze,
                        const float rgba[4]) {
    flat_.use();
    set_uniform(at_flat_.eye, eye);
    set_uniform(at_flat_.projection, projection);
    glUniform2f(at_flat_.haze, haze.begin_a, haze.end_a);
    glUniform4fv(at_flat_.colour, 1, rgba);
}

void Programs::use_balls(const Eigen::Matrix4f& eye, const Eigen::Matrix4f& projection, const Haze& haze,
                         const float rgba[4], float radius_a, float view_height_px) {
    balls_.use();
    set_uniform(at_balls_.eye, eye);
    set_uniform(at_balls_.projection, projection);
    glUniform2f(at_balls_.haze, haze.begin_a, haze.end_a);
    glUniform4fv(at_balls_.colour, 1, rgba);
    glUniform2f(at_balls_.size, radius_a, 0.5F * view_height_px * projection(1, 1));
}

void Programs::draw_background() {
    glDisable(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    background_.use();
    glBindVertexArray(empty_.get());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthMask(GL_TRUE);
}

}  // namespace tact
