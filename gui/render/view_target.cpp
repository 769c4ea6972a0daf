#include "gui/render/view_target.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "ipc/base/error.hpp"

namespace tact {
namespace {

constexpr char kVertex[] = R"(#version 330 core
out vec2 v_at;  // 0 to 1
void main() {
    v_at = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = vec4(2.0 * v_at - 1.0, 0.0, 1.0);
}
)";
// A quarter of the second difference, which bilinear interpolation takes away from waves of four pixels.
constexpr char kSharpenFragment[] = R"(#version 330 core
uniform sampler2D u_picture;
uniform ivec2 u_last;
out vec4 colour;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 m = texelFetch(u_picture, at, 0).rgb;
    vec3 n = texelFetch(u_picture, ivec2(at.x, min(at.y + 1, u_last.y)), 0).rgb;
    vec3 s = texelFetch(u_picture, ivec2(at.x, max(at.y - 1, 0)), 0).rgb;
    vec3 e = texelFetch(u_picture, ivec2(min(at.x + 1, u_last.x), at.y), 0).rgb;
    vec3 w = texelFetch(u_picture, ivec2(max(at.x - 1, 0), at.y), 0).rgb;
    vec3 low = min(m, min(min(n, s), min(e, w))), high = max(m, max(max(n, s), max(e, w)));
    colour = vec4(clamp(m + 0.25 * (4.0 * m - n - s - e - w), low, high), 1.0);
}
)";
constexpr char kEnlargeFragment[] = R"(#version 330 core
uniform sampler2D u_picture;
uniform vec2 u_part;  // of the image that is in use
uniform vec2 u_edge;  // centre of its last pixel
in vec2 v_at;
out vec4 colour;
void main() { colour = texture(u_picture, min(v_at * u_part, u_edge)); }
)";

}  // namespace

ViewSize ViewSize::of_share(int width_px, int height_px, double share) {
    const double axis = std::sqrt(std::clamp(share, 0.0, 1.0));
    const auto part = [axis](int px) {
        return std::clamp(static_cast<int>(std::lround(axis * px)), 1, std::max(px, 1));
    };
    return {part(width_px), part(height_px)};
}

ViewTarget::ViewTarget()
    : sharpen_("sharpen", kVertex, kSharpenFragment),
      enlarge_("enlarge", kVertex, kEnlargeFragment),
      last_place_(sharpen_.uniform("u_last")),
      part_place_(enlarge_.uniform("u_part")),
      edge_place_(enlarge_.uniform("u_edge")) {
    for (const GlProgram* const program : {&sharpen_, &enlarge_}) {
        program->use();
        glUniform1i(program->uniform("u_picture"), 0);
    }
    glUseProgram(0);
}

void ViewTarget::begin(const ViewSize& size, const ViewSize& most) {
    size_ = size;
    if (most.width_px != allocated_.width_px || most.height_px != allocated_.height_px) {
        allocated_ = most;
        glBindRenderbuffer(GL_RENDERBUFFER, depth_.get());
        glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, most.width_px, most.height_px);
        for (const auto& [texture, frame] : {std::pair{&drawn_, &drawn_frame_}, {&sharp_, &sharp_frame_}}) {
            glBindTexture(GL_TEXTURE_2D, texture->get());
            for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
                glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
            for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
                glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
            glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, most.width_px, most.height_px, 0, GL_RGBA,
                         GL_UNSIGNED_BYTE, nullptr);
            glBindFramebuffer(GL_FRAMEBUFFER, frame->get());
            glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture->get(), 0);
            if (texture == &drawn_)
                glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER,
                                          depth_.get());
            if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
                throw StartupError("creating an image of " + std::to_string(most.width_px) + "x" +
                                       std::to_string(most.height_px) + " pixels for the 3D view",
                                   "the graphics driver rejects it", "use a smaller --size");
        }
        glBindTexture(GL_TEXTURE_2D, 0);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, drawn_frame_.get());
    glDisable(GL_SCISSOR_TEST);
    glViewport(0, 0, size.width_px, size.height_px);
    glClear(GL_DEPTH_BUFFER_BIT);
}

void ViewTarget::show(GLuint frame_buffer, int x_px, int y_px, int width_px, int height_px) {
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    glActiveTexture(GL_TEXTURE0);
    glBindVertexArray(empty_.get());
    glBindFramebuffer(GL_FRAMEBUFFER, sharp_frame_.get());
    glViewport(0, 0, size_.width_px, size_.height_px);
    sharpen_.use();
    glUniform2i(last_place_, size_.width_px - 1, size_.height_px - 1);
    glBindTexture(GL_TEXTURE_2D, drawn_.get());
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);

    glBindFramebuffer(GL_FRAMEBUFFER, frame_buffer);
    glViewport(x_px, y_px, width_px, height_px);
    enlarge_.use();
    const auto w = static_cast<float>(allocated_.width_px), h = static_cast<float>(allocated_.height_px);
    const auto used_w = static_cast<float>(size_.width_px), used_h = static_cast<float>(size_.height_px);
    glUniform2f(part_place_, used_w / w, used_h / h);
    glUniform2f(edge_place_, (used_w - 0.5F) / w, (used_h - 0.5F) / h);
    glBindTexture(GL_TEXTURE_2D, sharp_.get());
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glBindTexture(GL_TEXTURE_2D, 0);
    glBindVertexArray(0);
    glUseProgram(0);
}

}  // namespace tact
