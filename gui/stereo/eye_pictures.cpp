#include "gui/stereo/eye_pictures.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/error.hpp"

namespace tact {
namespace {

constexpr char kWholeVertex[] = R"(#version 330 core
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";
// Half-colour: pure red would cause rivalry between the eyes, so the left eye gets lightness.
constexpr char kAnaglyphFragment[] = R"(#version 330 core
uniform sampler2D u_left;
uniform sampler2D u_right;
uniform vec2 u_corner;
out vec4 colour;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy - u_corner);
    vec3 left = texelFetch(u_left, at, 0).rgb, right = texelFetch(u_right, at, 0).rgb;
    colour = vec4(dot(left, vec3(0.299, 0.587, 0.114)), right.g, right.b, 1.0);
}
)";

}  // namespace

PixelArea area_of_eye(StereoMode mode, std::size_t eye, int width_px, int height_px) {
    PixelArea area{0, 0, width_px, height_px};
    if (mode == StereoMode::side_by_side) {
        area.width_px = std::max(width_px / 2, 1);
        area.x_px = eye == 0 ? 0 : width_px - area.width_px;
    } else if (mode == StereoMode::top_bottom) {
        area.height_px = std::max(height_px / 2, 1);
        area.y_px = eye == 0 ? height_px - area.height_px : 0;
    }
    return area;
}

EyePictures::EyePictures() : anaglyph_("anaglyph", kWholeVertex, kAnaglyphFragment) {
    anaglyph_.use();
    glUniform1i(anaglyph_.uniform("u_left"), 0);
    glUniform1i(anaglyph_.uniform("u_right"), 1);
    glUseProgram(0);
}

void EyePictures::resize(StereoMode mode, int width_px, int height_px) {
    if (mode == mode_ && width_px == output_width_px_ && height_px == output_height_px_) return;
    const PixelArea area = area_of_eye(mode, 0, width_px, height_px);
    for (Eye& eye : eye_) {
        const auto image = [&](GLuint name, GLint inner, GLenum format, GLenum type) {
            glBindTexture(GL_TEXTURE_2D, name);
            for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
                glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
            glTexImage2D(GL_TEXTURE_2D, 0, inner, area.width_px, area.height_px, 0, format, type, nullptr);
        };
        image(eye.colour.get(), GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE);
        // Formats of the window: parts of the scene are copied between both.
        image(eye.depth.get(), GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8);
        glBindTexture(GL_TEXTURE_2D, 0);
        glBindFramebuffer(GL_FRAMEBUFFER, eye.frame.get());
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, eye.colour.get(), 0);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_TEXTURE_2D, eye.depth.get(),
                               0);
        if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
            throw StartupError("creating the images of two eyes of " + std::to_string(area.width_px) + "x" +
                                   std::to_string(area.height_px) + " pixels",
                               "the graphics driver rejects it", "use a smaller size_px or --size");
    }
    mode_ = mode;
    output_width_px_ = width_px;
    output_height_px_ = height_px;
    width_px_ = area.width_px;
    height_px_ = area.height_px;
}

GLuint EyePictures::composed() {
    glBindTexture(GL_TEXTURE_2D, whole_.get());
    GLint width = 0, height = 0;
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &width);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_HEIGHT, &height);
    if (width != output_width_px_ || height != output_height_px_) {
        for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
            glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, output_width_px_, output_height_px_, 0, GL_RGBA,
                     GL_UNSIGNED_BYTE, nullptr);
    }
    glBindTexture(GL_TEXTURE_2D, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, whole_frame_.get());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, whole_.get(), 0);
    compose(whole_frame_.get(), 0, 0);
    return whole_.get();
}

std::vector<Image> EyePictures::read(bool each_eye) {
    GLint before = 0;
    glGetIntegerv(GL_FRAMEBUFFER_BINDING, &before);
    std::vector<Image> images;
    if (each_eye) {
        for (Eye& eye : eye_) {
            glBindFramebuffer(GL_FRAMEBUFFER, eye.frame.get());
            images.push_back(read_pixels(width_px_, height_px_));
        }
    } else {
        static_cast<void>(composed());
        images.push_back(read_pixels(output_width_px_, output_height_px_));
    }
    glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(before));
    return images;
}

void EyePictures::begin(std::size_t eye, const Eigen::Vector3f& ground) {
    glBindFramebuffer(GL_FRAMEBUFFER, eye_[eye].frame.get());
    glViewport(0, 0, width_px_, height_px_);
    glDisable(GL_SCISSOR_TEST);
    glClearColor(ground.x(), ground.y(), ground.z(), 1.0F);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void EyePictures::compose(GLuint frame_buffer, int x_px, int y_px) {
    if (mode_ == StereoMode::anaglyph) {
        glBindFramebuffer(GL_FRAMEBUFFER, frame_buffer);
        glViewport(x_px, y_px, output_width_px_, output_height_px_);
        glDisable(GL_DEPTH_TEST);
        glDisable(GL_BLEND);
        for (std::size_t eye = 0; eye < 2; ++eye) {
            glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(eye));
            glBindTexture(GL_TEXTURE_2D, texture(eye));
        }
        anaglyph_.use();
        glUniform2f(anaglyph_.uniform("u_corner"), static_cast<float>(x_px), static_cast<float>(y_px));
        glBindVertexArray(empty_.get());
        glDrawArrays(GL_TRIANGLES, 0, 3);
        glBindVertexArray(0);
        glUseProgram(0);
        for (const GLenum unit : {GL_TEXTURE1, GL_TEXTURE0}) {
            glActiveTexture(unit);
            glBindTexture(GL_TEXTURE_2D, 0);
        }
        return;
    }
    for (std::size_t eye = 0; eye < 2; ++eye) {
        const PixelArea to = area_of_eye(mode_, eye, output_width_px_, output_height_px_);
        glBindFramebuffer(GL_READ_FRAMEBUFFER, eye_[eye].frame.get());
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, frame_buffer);
        glBlitFramebuffer(0, 0, width_px_, height_px_, x_px + to.x_px, y_px + to.y_px,
                          x_px + to.x_px + to.width_px, y_px + to.y_px + to.height_px, GL_COLOR_BUFFER_BIT,
                          GL_NEAREST);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, frame_buffer);
}

void EyePictures::show_one(std::size_t eye, GLuint frame_buffer, const PixelArea& area) {
    const double scale = std::min(static_cast<double>(area.width_px) / output_width_px_,
                                  static_cast<double>(area.height_px) / output_height_px_);
    const int width = std::max(static_cast<int>(std::lround(scale * output_width_px_)), 1),
              height = std::max(static_cast<int>(std::lround(scale * output_height_px_)), 1);
    const int x = area.x_px + (area.width_px - width) / 2, y = area.y_px + (area.height_px - height) / 2;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, eye_[eye].frame.get());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, frame_buffer);
    glBlitFramebuffer(0, 0, width_px_, height_px_, x, y, x + width, y + height, GL_COLOR_BUFFER_BIT,
                      GL_LINEAR);
    glBindFramebuffer(GL_FRAMEBUFFER, frame_buffer);
}

}  // namespace tact
