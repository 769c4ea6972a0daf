#include "gui/drilling/fluid_target.hpp"

#include <string>

#include "ipc/base/error.hpp"

namespace tact {
namespace {

GLuint make_texture(GLint inside, GLenum format, int width_px, int height_px, GLint filter) {
    GLuint name = 0;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexImage2D(GL_TEXTURE_2D, 0, inside, width_px, height_px, 0, format, GL_FLOAT, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glBindTexture(GL_TEXTURE_2D, 0);
    return name;
}

}  // namespace

FluidTarget::FluidTarget(int frame_width_px, int frame_height_px, int coarser)
    : width_px_(frame_width_px), height_px_(frame_height_px), coarser_(coarser) {
    // 32-bit floats: sums of depths must distinguish a puddle's surface from its bed.
    sums_ = make_texture(GL_RGBA32F, GL_RGBA, width_px(), height_px(), GL_LINEAR);
    depth_ = make_texture(GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, width_px_, height_px_, GL_NEAREST);
    GLint before = 0;
    glGetIntegerv(GL_FRAMEBUFFER_BINDING, &before);
    glGenFramebuffers(1, &frame_);
    gl_names_held() += 3;
    glBindFramebuffer(GL_FRAMEBUFFER, frame_);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, sums_, 0);
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(before));
    if (status != GL_FRAMEBUFFER_COMPLETE)
        throw StartupError("creating an image of " + std::to_string(width_px()) + "x" +
                               std::to_string(height_px()) + " pixels for water and blood",
                           "the graphics driver rejects it with status " + std::to_string(status),
                           "update the graphics driver, or set LIBGL_ALWAYS_SOFTWARE=1");
}

FluidTarget::~FluidTarget() {
    glDeleteFramebuffers(1, &frame_);
    glDeleteTextures(1, &sums_);
    glDeleteTextures(1, &depth_);
    gl_names_held() -= 3;
}

void FluidTarget::take_depth(int x_px, int y_px) const {
    glBindTexture(GL_TEXTURE_2D, depth_);
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, x_px, y_px, width_px_, height_px_);
    glBindTexture(GL_TEXTURE_2D, 0);
}

void FluidTarget::bind_sums(GLenum unit) const {
    glActiveTexture(unit);
    glBindTexture(GL_TEXTURE_2D, sums_);
}

void FluidTarget::bind_depth(GLenum unit) const {
    glActiveTexture(unit);
    glBindTexture(GL_TEXTURE_2D, depth_);
}

}  // namespace tact
