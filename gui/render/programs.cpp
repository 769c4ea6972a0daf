#include "gui/render/programs.hpp"

namespace tact {
namespace {

constexpr char kLitVertex[] = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 colour;
uniform float u_glass;
uniform float u_opacity;
uniform vec4 u_tint;
out vec4 v_colour;
out vec4 v_inside;
void main() {
    vec4 p = u_eye * vec4(position, 1.0);
    gl_ClipDistance[0] = -p.z - u_cut;
    vec3 n = normalize(mat3(u_eye) * normal);
    vec3 v = normalize(-p.xyz);
    float facing = dot(n, v);
    if (facing < 0.0) n = -n;  // both sides are lit
    vec4 c = lit(mix(colour.rgb, u_tint.rgb, u_tint.a), n, v);
    float a = colour.a;
    if (u_glass > 0.5) {
        float rim = 1.0 - abs(facing);
        a *= mix(0.17, 0.78, rim * rim) + 0.45 * c.a;
        if (facing < 0.0) a *= 0.55;
        a *= 1.0 - 0.8 * haze_at(-p.z);
    }
    gl_Position = u_projection * p;
    float y = gl_Position.y / gl_Position.w;
    v_colour = hazed(vec4(c.rgb, min(a * u_opacity, 1.0)), -p.z, y);
    v_inside = hazed(vec4(0.72 * mix(colour.rgb, u_tint.rgb, u_tint.a), 1.0), -p.z, y);
}
)";
constexpr char kFineVertex[] = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 colour;
uniform vec4 u_tint;
out vec3 v_place;
out vec3 v_normal;
out vec4 v_base;
noperspective out float v_y;
void main() {
    vec4 p = u_eye * vec4(position, 1.0);
    gl_ClipDistance[0] = -p.z - u_cut;
    v_place = p.xyz;
    v_normal = normalize(mat3(u_eye) * normal);
    v_base = vec4(mix(colour.rgb, u_tint.rgb, u_tint.a), colour.a);
    gl_Position = u_projection * p;
    v_y = gl_Position.y / gl_Position.w;
}
)";
// The side that is seen is lit: by the triangle, because an interpolated normal may turn away from the eye at an outline.
constexpr char kFineFragment[] = R"(
in vec3 v_place;
in vec3 v_normal;
in vec4 v_base;
noperspective in float v_y;
uniform float u_glass;
uniform float u_opacity;
uniform float u_closed;
out vec4 colour;
void peel();
void main() {
    peel();
    float depth = -v_place.z;
    if (u_closed > 0.5 && !gl_FrontFacing) {
        colour = hazed(vec4(0.72 * v_base.rgb, 1.0), depth, v_y);
        return;
    }
    vec3 n = normalize(gl_FrontFacing ? v_normal : -v_normal), v = normalize(-v_place);
    vec4 c = lit(v_base.rgb, n, v);
    float a = v_base.a;
    if (u_glass > 0.5) {
        float rim = 1.0 - max(dot(n, v), 0.0);
        a *= mix(0.17, 0.78, rim * rim) + 0.45 * c.a;
        if (!gl_FrontFacing) a *= 0.55;
        a *= 1.0 - 0.8 * haze_at(depth);
    }
    colour = hazed(vec4(c.rgb, min(a * u_opacity, 1.0)), depth, v_y);
}
)";
constexpr char kNoPeel[] = "void peel() {}\n";
// Only what lies behind the layer before and in front of what is solid.
constexpr char kPeel[] = R"(
uniform sampler2D u_solid;
uniform sampler2D u_before;
void peel() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    if (gl_FragCoord.z >= texelFetch(u_solid, at, 0).r || gl_FragCoord.z <= texelFetch(u_before, at, 0).r) discard;
}
)";
// Of a closed body that is cut: its inner walls look like the face of the cut.
constexpr char kCutFragment[] = R"(#version 330 core
in vec4 v_colour;
in vec4 v_inside;
out vec4 colour;
void main() { colour = gl_FrontFacing ? v_colour : v_inside; }
)";
constexpr char kPlainFragment[] = R"(#version 330 core
in vec4 v_colour;
out vec4 colour;
void main() { colour = v_colour; }
)";
constexpr char kFlatVertex[] = R"(
layout(location = 0) in vec3 position;
uniform vec4 u_colour;
out vec4 v_colour;
void main() {
    vec4 p = u_eye * vec4(position, 1.0);
    gl_ClipDistance[0] = -p.z - u_cut;
    gl_Position = u_projection * p;
    v_colour = hazed(u_colour, -p.z, gl_Position.y / gl_Position.w);
}
)";
constexpr char kBallVertex[] = R"(
layout(location = 0) in vec3 position;
uniform vec4 u_colour;
uniform vec2 u_size;  // radius, pixels per ångström at distance 1
out vec4 v_colour;
void main() {
    vec4 p = u_eye * vec4(position, 1.0);
    gl_ClipDistance[0] = -p.z - u_cut;
    gl_PointSize = clamp(2.0 * u_size.x * u_size.y / max(-p.z, 1e-3), 3.0, 64.0);
    gl_Position = u_projection * p;
    v_colour = hazed(u_colour, -p.z, gl_Position.y / gl_Position.w);
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

Programs::LitProgram::LitProgram(const char* what, const char* vertex, const char* fragment)
    : program(what, vertex, fragment),
      view(program),
      glass(program.uniform("u_glass")),
      opacity(program.uniform("u_opacity")),
      tint(program.uniform("u_tint")),
      closed(program.uniform("u_closed")) {}

Programs::Programs()
    : lit_("surface", shader(kLitVertex).c_str(), kPlainFragment),
      cut_("cut surface", shader(kLitVertex).c_str(), kCutFragment),
      fine_("surface lit by pixels", shader(kFineVertex).c_str(), (shader(kFineFragment) + kNoPeel).c_str()),
      peel_("layer of glass", shader(kFineVertex).c_str(), (shader(kFineFragment) + kPeel).c_str()),
      flat_("line", shader(kFlatVertex).c_str(), kPlainFragment),
      balls_("point", shader(kBallVertex).c_str(), kBallFragment),
      background_("background", kBackgroundVertex, kBackgroundFragment),
      flat_view_(flat_),
      balls_view_(balls_),
      flat_colour_(flat_.uniform("u_colour")),
      balls_colour_(balls_.uniform("u_colour")),
      balls_size_(balls_.uniform("u_size")) {
    peel_.program.use();
    glUniform1i(peel_.program.uniform("u_solid"), 1);
    glUniform1i(peel_.program.uniform("u_before"), 2);
    background_.use();
    glUniform3fv(background_.uniform("u_top"), 1, kBackgroundTop);
    glUniform3fv(background_.uniform("u_bottom"), 1, kBackgroundBottom);
}

void Programs::use_lit(const Eigen::Matrix4f& eye, const Eigen::Matrix4f& projection, const Haze& haze,
                       const Paint& paint) {
    const bool closes = paint.closed && haze.cut_a > 0.0F;
    const LitProgram& lit = peels_ ? peel_ : by_pixel_ ? fine_ : closes ? cut_ : lit_;
    lit.program.use();
    lit.view.set(eye, projection, haze);
    glUniform1f(lit.glass, paint.glass ? 1.0F : 0.0F);
    glUniform1f(lit.opacity, paint.opacity);
    glUniform4fv(lit.tint, 1, paint.tint.data());
    if (by_pixel_ || peels_) glUniform1f(lit.closed, closes ? 1.0F : 0.0F);
}

void Programs::use_flat(const Eigen::Matrix4f& eye, const Eigen::Matrix4f& projection, const Haze& haze,
                        const float rgba[4]) {
    flat_.use();
    flat_view_.set(eye, projection, haze);
    glUniform4fv(flat_colour_, 1, rgba);
}

void Programs::use_balls(const Eigen::Matrix4f& eye, const Eigen::Matrix4f& projection, const Haze& haze,
                         const float rgba[4], float radius_a, float view_height_px) {
    balls_.use();
    balls_view_.set(eye, projection, haze);
    glUniform4fv(balls_colour_, 1, rgba);
    glUniform2f(balls_size_, radius_a, 0.5F * view_height_px * projection(1, 1));
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
