#include "gui/render/target.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include "ipc/base/error.hpp"

namespace tact {

OffscreenTarget::OffscreenTarget(int width_px, int height_px) : width_px_(width_px), height_px_(height_px) {
    glGenFramebuffers(1, &frame_);
    glGenRenderbuffers(1, &colour_);
    glGenRenderbuffers(1, &depth_);
    gl_names_held() += 3;
    glBindRenderbuffer(GL_RENDERBUFFER, colour_);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width_px, height_px);
    glBindRenderbuffer(GL_RENDERBUFFER, depth_);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, width_px, height_px);
    glBindFramebuffer(GL_FRAMEBUFFER, frame_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, depth_);
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE)
        throw StartupError("creating an offscreen image of " + std::to_string(width_px) + "x" +
                               std::to_string(height_px) + " pixels",
                           "the graphics driver rejects it with status " + std::to_string(status),
                           "use a smaller --size");
}

OffscreenTarget::~OffscreenTarget() {
    glDeleteFramebuffers(1, &frame_);
    glDeleteRenderbuffers(1, &colour_);
    glDeleteRenderbuffers(1, &depth_);
    gl_names_held() -= 3;
}

Image read_pixels(int width_px, int height_px) {
    Image image{static_cast<std::uint32_t>(width_px), static_cast<std::uint32_t>(height_px), {}};
    const std::size_t row = std::size_t{3} * image.width_px;
    std::vector<std::uint8_t> upward(row * image.height_px);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width_px, height_px, GL_RGB, GL_UNSIGNED_BYTE, upward.data());
    image.rgb.resize(upward.size());
    for (std::size_t y = 0; y < image.height_px; ++y)
        std::copy_n(upward.data() + (image.height_px - 1 - y) * row, row, image.rgb.data() + y * row);
    return image;
}

}  // namespace tact
