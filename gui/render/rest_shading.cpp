#include "gui/render/rest_shading.hpp"

#include <string>

namespace tact {
namespace {

constexpr float kReach = 0.09F;  // of occluders, in radii of the scene
constexpr char kShadingVertex[] = R"(#version 330 core
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";
constexpr char kShadingHead[] = R"(#version 330 core
uniform sampler2D u_depth;
uniform vec2 u_distance;  // of a depth: y / (2 depth - 1 + x)
uniform vec4 u_slope;     // xy: of a pixel, z: of the corner in x, w: in y, as x / distance
uniform vec2 u_reach;     // of occluders, in Å; pixels of 1 Å at distance 1
uniform vec3 u_haze;
float distance_of(float depth) { return u_distance.y / (2.0 * depth - 1.0 + u_distance.x); }
float distance_at(ivec2 at) {
    return distance_of(texelFetch(u_depth, clamp(at, ivec2(0), textureSize(u_depth, 0) - 1), 0).r);
}
vec3 place(ivec2 at, float d) { return vec3((u_slope.zw + (vec2(at) + 0.5) * u_slope.xy) * d, -d); }
vec3 place_at(ivec2 at) { return place(at, distance_at(at)); }
)";
constexpr char kOpenFragment[] = R"(
out vec4 colour;
const int kSamples = 16;
vec3 shorter(vec3 a, vec3 b) { return abs(a.z) < abs(b.z) ? a : b; }
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    if (texelFetch(u_depth, at, 0).r >= 1.0) { colour = vec4(1.0); return; }
    vec3 p = place_at(at);
    vec3 right = shorter(place_at(at + ivec2(1, 0)) - p, p - place_at(at - ivec2(1, 0)));
    vec3 up = shorter(place_at(at + ivec2(0, 1)) - p, p - place_at(at - ivec2(0, 1)));
    vec3 n = normalize(cross(right, up));
    float disc_px = clamp(u_reach.x * u_reach.y / -p.z, 4.0, 220.0), reach2 = u_reach.x * u_reach.x, sum = 0.0;
    // Sixteen turns of the spiral, one for each pixel of four by four, which the mean removes.
    float turn = 6.2832 * (float((at.x & 3) * 4 + (at.y & 3)) + 0.5) / 16.0;
    for (int i = 0; i < kSamples; ++i) {
        float part = (float(i) + 0.5) / float(kSamples), angle = turn + 6.2832 * 7.0 * part;
        ivec2 to = at + ivec2(round(disc_px * part * vec2(cos(angle), sin(angle))));
        vec3 v = place_at(to) - p;
        float vv = dot(v, v), f = max(reach2 - vv, 0.0) / reach2;
        sum += f * f * f * max((dot(v, n) + 0.002 * p.z) / (vv + 0.01 * reach2), 0.0);
    }
    colour = vec4(vec3(clamp(1.0 - 2.4 * u_reach.x * sum / float(kSamples), 0.0, 1.0)), 1.0);
}
)";
constexpr char kApplyFragment[] = R"(
uniform sampler2D u_open;
uniform ivec2 u_corner;
out vec4 colour;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy) - u_corner;
    if (texelFetch(u_depth, at, 0).r >= 1.0) discard;
    float d = distance_at(at), open = 0.0, weight = 0.0;
    ivec2 last = textureSize(u_depth, 0) - 1;
    for (int y = -2; y < 2; ++y)
        for (int x = -2; x < 2; ++x) {
            ivec2 to = clamp(at + ivec2(x, y), ivec2(0), last);
            float w = max(1.0 - 4.0 * abs(distance_at(to) - d) / u_reach.x, 0.001);
            open += w * texelFetch(u_open, to, 0).r;
            weight += w;
        }
    open = mix(0.25, 1.0, open / weight);
    // The nearer side of a jump.
    float across = distance_at(at + ivec2(1, 0)) + distance_at(at - ivec2(1, 0)) - 2.0 * d;
    float along = distance_at(at + ivec2(0, 1)) + distance_at(at - ivec2(0, 1)) - 2.0 * d;
    float outline = smoothstep(0.25 * u_reach.x, 0.8 * u_reach.x, max(across, along));
    float far = u_haze.z * smoothstep(u_haze.x, u_haze.y, d);
    colour = vec4(vec3(mix(open * (1.0 - 0.6 * outline), 1.0, far)), 1.0);
}
)";

}  // namespace

RestShading::Pass::Pass(const char* what, const char* fragment)
    : program(what, kShadingVertex, (std::string(kShadingHead) + fragment).c_str()),
      distance(program.uniform("u_distance")),
      slope(program.uniform("u_slope")),
      reach(program.uniform("u_reach")),
      haze(program.uniform("u_haze")) {
    program.use();
    glUniform1i(program.uniform("u_depth"), 0);
}

void RestShading::Pass::use(const Eigen::Matrix4f& p, const Haze& h, float size_a, int width_px,
                            int height_px) const {
    program.use();
    const float sx = 2.0F / (static_cast<float>(width_px) * p(0, 0)),
                sy = 2.0F / (static_cast<float>(height_px) * p(1, 1));
    glUniform2f(distance, p(2, 2), p(2, 3));
    glUniform4f(slope, sx, sy, (p(0, 2) - 1.0F) / p(0, 0), (p(1, 2) - 1.0F) / p(1, 1));
    glUniform2f(reach, kReach * size_a, 1.0F / sy);
    glUniform3f(haze, h.begin_a, h.end_a, h.strength);
}

RestShading::RestShading()
    : open_("openness", kOpenFragment),
      apply_("shading at rest", kApplyFragment),
      corner_(apply_.program.uniform("u_corner")) {
    glUniform1i(apply_.program.uniform("u_open"), 1);
    glUseProgram(0);
}

void RestShading::shade(const Eigen::Matrix4f& projection, const Haze& haze, float size_a, int x_px, int y_px,
                        int width_px, int height_px) {
    GLint bound = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, depth_.get());
    if (width_px != width_px_ || height_px != height_px_) {
        width_px_ = width_px;
        height_px_ = height_px;
        const auto describe_image = [&](GLint format, GLenum channels, GLenum type) {
            for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
                glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
            glTexImage2D(GL_TEXTURE_2D, 0, format, width_px, height_px, 0, channels, type, nullptr);
        };
        describe_image(GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT);
        glBindTexture(GL_TEXTURE_2D, openness_.get());
        describe_image(GL_R8, GL_RED, GL_UNSIGNED_BYTE);
        glBindFramebuffer(GL_FRAMEBUFFER, frame_.get());
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, openness_.get(), 0);
        glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(bound));
        glBindTexture(GL_TEXTURE_2D, depth_.get());
    }
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, x_px, y_px, width_px, height_px);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glBindVertexArray(empty_.get());
    glBindFramebuffer(GL_FRAMEBUFFER, frame_.get());
    glViewport(0, 0, width_px, height_px);
    open_.use(projection, haze, size_a, width_px, height_px);
    glDrawArrays(GL_TRIANGLES, 0, 3);

    glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(bound));
    glViewport(x_px, y_px, width_px, height_px);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D, openness_.get());
    glEnable(GL_BLEND);
    glBlendFunc(GL_ZERO, GL_SRC_COLOR);
    apply_.use(projection, haze, size_a, width_px, height_px);
    glUniform2i(corner_, x_px, y_px);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindTexture(GL_TEXTURE_2D, 0);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, 0);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    glBindVertexArray(0);
    glUseProgram(0);
}

}  // namespace tact
