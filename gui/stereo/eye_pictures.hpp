// Images of two eyes, and their composition into one output.
//
// Layout   side by side: left eye on the left; top-bottom: left eye above; each squeezed into its half of the
//          output, as 3D displays expect. Anaglyph: red for the left eye, cyan for the right, half of the colour
//          kept.
// Thread   frame thread, context current.  Fails by StartupError: the driver rejects images of that size.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "gui/render/gl.hpp"
#include "gui/render/target.hpp"
#include "gui/stereo/stage_file.hpp"

namespace tact {

// Pixels, y from below.
struct PixelArea {
    int x_px = 0, y_px = 0, width_px = 1, height_px = 1;
};
// Area of an eye's image in an output of this size; anaglyph, two windows, quad buffer: all of it.
[[nodiscard]] PixelArea area_of_eye(StereoMode mode, std::size_t eye, int width_px, int height_px);

class EyePictures {
public:
    EyePictures();
    // For an output of this size, which also sets the size of each eye's image.
    void resize(StereoMode mode, int width_px, int height_px);
    [[nodiscard]] int eye_width_px() const { return width_px_; }
    [[nodiscard]] int eye_height_px() const { return height_px_; }
    // Starts drawing an eye's image: binds its framebuffer, sets the viewport and clears it.
    void begin(std::size_t eye, const Eigen::Vector3f& ground);
    // Composes both into this framebuffer at this position, in the size of resize().
    void compose(GLuint frame_buffer, int x_px, int y_px);
    // Draws one eye's image, scaled into an area with its aspect kept.
    void show_one(std::size_t eye, GLuint frame_buffer, const PixelArea& area);
    [[nodiscard]] GLuint texture(std::size_t eye) { return eye_[eye].colour.get(); }
    // Both composed, as a texture.
    [[nodiscard]] GLuint composed();
    [[nodiscard]] std::vector<Image> read(bool each_eye);

private:
    struct Eye {
        GlTexture colour, depth;
        GlFramebuffer frame;
    };
    StereoMode mode_ = StereoMode::off;
    int output_width_px_ = 0, output_height_px_ = 0, width_px_ = 0, height_px_ = 0;
    std::array<Eye, 2> eye_;
    GlTexture whole_;
    GlFramebuffer whole_frame_;
    GlProgram anaglyph_;
    GlVertexArray empty_;
};

}  // namespace tact
