#include "gui/drilling/microscope_field.hpp"

#include <algorithm>
#include <array>

#include "gui/render/triangle_buffers.hpp"

namespace tact {
namespace {

constexpr char kFieldVertex[] = R"(#version 330 core
layout(location = 0) in vec2 corner;
uniform vec3 u_scale;  // xy: half of the view over the radius of the field; z: a pixel over it
out vec2 v_off;
void main() {
    v_off = corner * u_scale.xy;
    gl_Position = vec4(corner, 0.0, 1.0);
}
)";
constexpr char kFieldFragment[] = R"(#version 330 core
uniform vec3 u_scale;
in vec2 v_off;
out vec4 colour;
void main() {
    float r = length(v_off);
    float rim = 0.45 * smoothstep(0.55, 1.0, r);
    colour = vec4(0.0, 0.0, 0.0, mix(rim, 1.0, smoothstep(1.0 - 2.0 * u_scale.z, 1.0, r)));
}
)";

}  // namespace

MicroscopeField::MicroscopeField()
    : program_("microscope", kFieldVertex, kFieldFragment), scale_(program_.uniform("u_scale")) {
    constexpr std::array<float, 8> kCorners{-1.0F, -1.0F, 1.0F, -1.0F, -1.0F, 1.0F, 1.0F, 1.0F};
    glBindVertexArray(array_.get());
    glBindBuffer(GL_ARRAY_BUFFER, corners_.get());
    glBufferData(GL_ARRAY_BUFFER, sizeof kCorners, kCorners.data(), GL_STATIC_DRAW);
    attribute(0, 2, GL_FLOAT, GL_FALSE, 8, 0);
    glBindVertexArray(0);
}

void MicroscopeField::draw(int width_px, int height_px) {
    const auto w = static_cast<float>(std::max(width_px, 1)), h = static_cast<float>(std::max(height_px, 1));
    const float radius_px = kRadius * std::min(w, h);
    program_.use();
    glUniform3f(scale_, 0.5F * w / radius_px, 0.5F * h / radius_px, 1.0F / radius_px);
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glBindVertexArray(array_.get());
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glBindVertexArray(0);
    glEnable(GL_DEPTH_TEST);
}

}  // namespace tact
