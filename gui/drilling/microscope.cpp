#include "gui/drilling/microscope.hpp"

#include <algorithm>
#include <array>

namespace tact {
namespace {

constexpr char kMicroscopeVertex[] = R"(#version 330 core
layout(location = 0) in vec2 corner;
uniform vec3 u_scale;  // xy: half of the view over the radius of the field; z: a pixel over it
out vec2 v_off;
out vec2 v_at;
void main() {
    v_off = corner * u_scale.xy;
    v_at = 0.5 + 0.5 * corner;
    gl_Position = vec4(corner, 0.0, 1.0);
}
)";
constexpr char kMicroscopeFragment[] = R"(#version 330 core
uniform sampler2D u_colour;
uniform sampler2D u_depth;
uniform vec3 u_scale;
uniform vec2 u_distance;  // eye distance of a depth d: x / (2 d - 1 + y)
uniform vec3 u_blur;      // distance in focus; pixels per relative distance from it; most pixels
in vec2 v_off;
in vec2 v_at;
out vec4 colour;
void main() {
    float r = length(v_off);
    if (r >= 1.0) {
        colour = vec4(0.0, 0.0, 0.0, 1.0);
        return;
    }
    float depth = textureLod(u_depth, v_at, 0.0).r;
    float away = u_distance.x / (2.0 * depth - 1.0 + u_distance.y);
    float blur = depth < 1.0 ? min(u_blur.y * abs(away - u_blur.x) / away, u_blur.z) : 0.0;
    vec3 seen = textureLod(u_colour, v_at, blur < 0.7 ? 0.0 : max(log2(blur) - 0.3, 0.0)).rgb;
    float light = 1.0 - 0.45 * smoothstep(0.55, 1.0, r);
    colour = vec4(seen * light * (1.0 - smoothstep(1.0 - 2.0 * u_scale.z, 1.0, r)), 1.0);
}
)";

void picture_texture(GLuint name, GLint inside, GLenum format, GLenum type, GLint small, int width_px,
                     int height_px) {
    glBindTexture(GL_TEXTURE_2D, name);
    glTexImage2D(GL_TEXTURE_2D, 0, inside, width_px, height_px, 0, format, type, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, small);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, small == GL_NEAREST ? GL_NEAREST : GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

}  // namespace

Microscope::Microscope()
    : program_("microscope", kMicroscopeVertex, kMicroscopeFragment),
      scale_(program_.uniform("u_scale")),
      distance_(program_.uniform("u_distance")),
      blur_(program_.uniform("u_blur")) {
    program_.use();
    glUniform1i(program_.uniform("u_colour"), 0);
    glUniform1i(program_.uniform("u_depth"), 1);
    constexpr std::array<float, 8> kCorners{-1.0F, -1.0F, 1.0F, -1.0F, -1.0F, 1.0F, 1.0F, 1.0F};
    glBindVertexArray(array_.get());
    glBindBuffer(GL_ARRAY_BUFFER, corners_.get());
    glBufferData(GL_ARRAY_BUFFER, sizeof kCorners, kCorners.data(), GL_STATIC_DRAW);
    attribute(0, 2, GL_FLOAT, GL_FALSE, 8, 0);
    glBindVertexArray(0);
}

void Microscope::resize(int width_px, int height_px) {
    if (width_px == width_px_ && height_px == height_px_) return;
    picture_texture(colour_.get(), GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, GL_LINEAR_MIPMAP_LINEAR, width_px,
                    height_px);
    constexpr GLint kLevels = 3;  // copies of an eighth of the size are blurred enough
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, kLevels);
    picture_texture(depth_.get(), GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, GL_NEAREST,
                    width_px, height_px);
    width_px_ = width_px;
    height_px_ = height_px;
}

void Microscope::draw(const View& view) {
    const int width_px = std::max(view.width_px, 1), height_px = std::max(view.height_px, 1);
    resize(width_px, height_px);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D, depth_.get());
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, view.x_px, view.y_px, width_px, height_px);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, colour_.get());
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, view.x_px, view.y_px, width_px, height_px);
    glGenerateMipmap(GL_TEXTURE_2D);
    const auto w = static_cast<float>(width_px), h = static_cast<float>(height_px);
    const float radius_px = kRadius * std::min(w, h), most_px = kBlurMost * h;
    program_.use();
    glUniform3f(scale_, 0.5F * w / radius_px, 0.5F * h / radius_px, 1.0F / radius_px);
    glUniform2f(distance_, view.projection(2, 3), view.projection(2, 2));
    glUniform3f(blur_, view.focus_a, view.focus_a > 0.0F ? kBlurPerDistance * most_px : 0.0F, most_px);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glBindVertexArray(array_.get());
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glBindVertexArray(0);
    glEnable(GL_DEPTH_TEST);
}

}  // namespace tact
