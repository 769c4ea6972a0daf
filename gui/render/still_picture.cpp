#include "gui/render/still_picture.hpp"

#include <algorithm>
#include <array>

namespace tact {
namespace {

// The mean of side x side pixels.
std::array<int, 3> mean(const Image& image, std::uint32_t x, std::uint32_t y, std::uint32_t side) {
    std::array<std::uint32_t, 3> sum{};
    for (std::uint32_t j = 0; j < side; ++j)
        for (std::uint32_t i = 0; i < side; ++i)
            for (std::size_t k = 0; k < 3; ++k)
                sum[k] +=
                    image.rgb[3 * ((std::size_t{y} * side + j) * image.width_px + std::size_t{x} * side + i) +
                              k];
    std::array<int, 3> out{};
    for (std::size_t k = 0; k < 3; ++k) out[k] = static_cast<int>((sum[k] + side * side / 2) / (side * side));
    return out;
}

}  // namespace

std::array<std::uint8_t, 4> matted(const std::array<int, 3>& over_black,
                                   const std::array<int, 3>& over_white) noexcept {
    int through = 0;
    for (std::size_t k = 0; k < 3; ++k) through += over_white[k] - over_black[k];
    const int opaque = std::clamp(255 - (through + 1) / 3, 0, 255);
    std::array<std::uint8_t, 4> out{};
    for (std::size_t k = 0; k < 3 && opaque > 0; ++k)
        out[k] = static_cast<std::uint8_t>(std::clamp((255 * over_black[k] + opaque / 2) / opaque, 0, 255));
    out[3] = static_cast<std::uint8_t>(opaque);
    return out;
}

StillPicture draw_still_picture(int width_px, int height_px, bool transparent, double samples_max,
                                const DrawPicture& draw) {
    GLint most = 0, bound = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most);
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
    const bool many =
        2 * std::max(width_px, height_px) <= most && static_cast<double>(width_px) * height_px <= samples_max;
    const int side = many ? 2 : 1;
    const int w = side * width_px, h = side * height_px;
    const auto drawn = [&](const Eigen::Vector3f* ground) {
        glClear(GL_DEPTH_BUFFER_BIT);
        draw(w, h, many, ground);
        return read_pixels(w, h);
    };
    Image black, white;
    {
        const OffscreenTarget target(w, h);
        target.bind();
        glDisable(GL_SCISSOR_TEST);
        glViewport(0, 0, w, h);
        const Eigen::Vector3f none = Eigen::Vector3f::Zero(), all = Eigen::Vector3f::Ones();
        black = drawn(transparent ? &none : nullptr);
        if (transparent) white = drawn(&all);
        glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(bound));
    }
    StillPicture picture{
        static_cast<std::uint32_t>(width_px), static_cast<std::uint32_t>(height_px), transparent, {}};
    picture.pixels.reserve((transparent ? std::size_t{4} : std::size_t{3}) * picture.width_px *
                           picture.height_px);
    const auto part = static_cast<std::uint32_t>(side);
    for (std::uint32_t y = 0; y < picture.height_px; ++y)
        for (std::uint32_t x = 0; x < picture.width_px; ++x) {
            const std::array<int, 3> over_black = mean(black, x, y, part);
            if (transparent) {
                const auto rgba = matted(over_black, mean(white, x, y, part));
                picture.pixels.insert(picture.pixels.end(), rgba.begin(), rgba.end());
            } else {
                for (const int c : over_black) picture.pixels.push_back(static_cast<std::uint8_t>(c));
            }
        }
    return picture;
}

}  // namespace tact
