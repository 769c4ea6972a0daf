#include "gui/window/demo_pictures.hpp"

#include "gui/render/gl.hpp"
#include "ipc/image/png.hpp"

namespace tact {

DemoPictures::DemoPictures(std::vector<DemoCard>& cards) {
    for (DemoCard& card : cards) {
        const auto content = demo_picture(card.name);
        if (content.empty()) continue;
        PngReader png(content);
        const auto width = static_cast<GLsizei>(png.width_px()),
                   height = static_cast<GLsizei>(png.height_px());
        const std::vector<std::uint8_t> pixels = png.read(PngFormat::rgba);
        GLuint texture = 0;
        glGenTextures(1, &texture);
        glBindTexture(GL_TEXTURE_2D, texture);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
        glGenerateMipmap(GL_TEXTURE_2D);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
        glBindTexture(GL_TEXTURE_2D, 0);
        textures_.push_back(texture);
        // ImGui 1.91 on Debian 13 has an integer, 1.86 a pointer.
        card.picture = (ImTextureID)(static_cast<std::uintptr_t>(texture));
    }
}

DemoPictures::~DemoPictures() { glDeleteTextures(static_cast<GLsizei>(textures_.size()), textures_.data()); }

}  // namespace tact
