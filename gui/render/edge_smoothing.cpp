#include "gui/render/edge_smoothing.hpp"

namespace tact {
namespace {

constexpr char kVertex[] = R"(#version 330 core
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";
// Contrast below the larger limit is no edge: shading noise, or invisible beside something bright. An end beyond the
// last step has no effect: less than a twentieth of the pixel lies beyond the edge.
constexpr char kFragment[] = R"(#version 330 core
const float kContrastLeast = 0.04, kContrastShare = 0.12, kFineMost = 0.5;
const int kSteps = 8;
const float kStride[kSteps] = float[](1.0, 1.0, 1.0, 1.0, 1.5, 2.0, 2.0, 2.0);
uniform sampler2D u_picture;
uniform ivec2 u_corner;
out vec4 colour;

float lightness(vec4 c) { return dot(c.rgb, vec3(0.299, 0.587, 0.114)); }

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy) - u_corner, last = textureSize(u_picture, 0) - 1;
    ivec2 below = max(at - 1, ivec2(0)), above = min(at + 1, last);
    float m = lightness(texelFetch(u_picture, at, 0));
    float n = lightness(texelFetch(u_picture, ivec2(at.x, above.y), 0));
    float s = lightness(texelFetch(u_picture, ivec2(at.x, below.y), 0));
    float e = lightness(texelFetch(u_picture, ivec2(above.x, at.y), 0));
    float w = lightness(texelFetch(u_picture, ivec2(below.x, at.y), 0));
    float high = max(max(max(n, s), max(e, w)), m), low = min(min(min(n, s), min(e, w)), m);
    float contrast = high - low;
    if (contrast < max(kContrastLeast, kContrastShare * high)) discard;
    float ne = lightness(texelFetch(u_picture, above, 0));
    float sw = lightness(texelFetch(u_picture, below, 0));
    float nw = lightness(texelFetch(u_picture, ivec2(below.x, above.y), 0));
    float se = lightness(texelFetch(u_picture, ivec2(above.x, below.y), 0));

    // Across the edge: the larger second difference.
    float upright = abs(nw + sw - 2.0 * w) + 2.0 * abs(n + s - 2.0 * m) + abs(ne + se - 2.0 * e);
    float level = abs(nw + ne - 2.0 * n) + 2.0 * abs(w + e - 2.0 * m) + abs(sw + se - 2.0 * s);
    bool lies = upright >= level;
    vec2 across = lies ? vec2(0.0, 1.0) : vec2(1.0, 0.0), along = across.yx;
    float beyond = lies ? n : e, other = lies ? s : w;
    if (abs(other - m) > abs(beyond - m)) {
        across = -across;
        beyond = other;
    }
    // Follow the line between both pixel rows, where a read returns their mean.
    vec2 pixel = 1.0 / vec2(last + 1);
    vec2 from = (vec2(at) + 0.5 + 0.5 * across) * pixel;
    float mean = 0.5 * (m + beyond), ended = 0.25 * abs(beyond - m);
    float run[2], change[2];
    for (int side = 0; side < 2; ++side) {
        vec2 way = (side == 0 ? along : -along) * pixel;
        float run_px = 0.0, changed = 0.0;
        for (int i = 0; i < kSteps && abs(changed) < ended; ++i) {
            run_px += kStride[i];
            changed = lightness(textureLod(u_picture, from + run_px * way, 0.0)) - mean;
        }
        run[side] = run_px;
        change[side] = changed;
    }
    int nearer = run[0] < run[1] ? 0 : 1;
    // The edge cuts this pixel only if, at the nearer end, it leaves this row and not the adjacent one.
    float share = 0.0;
    if (abs(change[nearer]) >= ended && (change[nearer] < 0.0) != (m < mean))
        share = 0.5 - run[nearer] / (run[0] + run[1]);
    // Single bright or dark pixels and thin lines have no edge to follow.
    float around = (2.0 * (n + s + e + w) + ne + nw + se + sw) / 12.0;
    float fine = smoothstep(0.0, 1.0, clamp(abs(around - m) / contrast, 0.0, 1.0));
    share = max(share, kFineMost * fine * fine);
    colour = textureLod(u_picture, (vec2(at) + 0.5 + share * across) * pixel, 0.0);
}
)";

}  // namespace

EdgeSmoothing::EdgeSmoothing()
    : program_("smooth edges", kVertex, kFragment), corner_place_(program_.uniform("u_corner")) {
    program_.use();
    glUniform1i(program_.uniform("u_picture"), 0);
    glUseProgram(0);
}

void EdgeSmoothing::smooth(int x_px, int y_px, int width_px, int height_px) {
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, picture_.get());
    if (width_px != width_px_ || height_px != height_px_) {
        for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
            glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
        for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
            glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, width_px, height_px, 0, GL_RGB, GL_UNSIGNED_BYTE, nullptr);
        width_px_ = width_px;
        height_px_ = height_px;
    }
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, x_px, y_px, width_px, height_px);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    program_.use();
    glUniform2i(corner_place_, x_px, y_px);
    glBindVertexArray(empty_.get());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
    glUseProgram(0);
    glBindTexture(GL_TEXTURE_2D, 0);
}

}  // namespace tact
