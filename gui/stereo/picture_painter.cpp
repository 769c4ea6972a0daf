#include "gui/stereo/picture_painter.hpp"

#include <cstddef>

namespace tact {
namespace {

constexpr char kVertex[] = R"(#version 330 core
layout(location = 0) in vec3 at;
layout(location = 1) in vec4 ink;
uniform mat4 u_clip_from_glass;
out vec4 v_ink;
void main() {
    gl_Position = u_clip_from_glass * vec4(at, 1.0);
    v_ink = ink;
}
)";
constexpr char kFragment[] = R"(#version 330 core
in vec4 v_ink;
out vec4 colour;
void main() { colour = v_ink; }
)";

}  // namespace

PicturePainter::PicturePainter()
    : program_("calibration picture", kVertex, kFragment),
      clip_from_glass_(program_.uniform("u_clip_from_glass")) {}

void PicturePainter::draw(const EyeView& eye, std::span<const PictureVertex> vertices) {
    if (vertices.empty()) return;
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glBindVertexArray(array_.get());
    glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size_bytes()), vertices.data(),
                 GL_STREAM_DRAW);
    attribute(0, 3, GL_FLOAT, GL_FALSE, sizeof(PictureVertex), offsetof(PictureVertex, x_mm));
    attribute(1, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(PictureVertex), offsetof(PictureVertex, ink));
    program_.use();
    set_uniform(clip_from_glass_, Eigen::Matrix4f(eye.projection * eye.eye_from_scene));
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices.size()));
    glUseProgram(0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glBindVertexArray(0);
    glDisable(GL_BLEND);
}

}  // namespace tact
