// Glass whose layers are blended in the order of their depth at each pixel, whatever order its triangles are drawn in.
//
// Source   depth peeling: Everitt, "Interactive Order-Independent Transparency", NVIDIA 2001; here from the front, with the light that still
//          passes kept beside the colour. The front `layers` are exact; what lies behind them is blended in the order of drawing.
// Cost     the triangles once for each layer and once for the rest, but no more often than layers overlap anywhere.
// Thread   frame thread, context current; the framebuffer that was bound is bound again.
#pragma once

#include <functional>

#include "gui/render/gl.hpp"
#include "gui/render/programs.hpp"

namespace tact {

// Enough for what shows, as opaque as glass is; in software rendering fewer, because each draws the triangles once more.
inline constexpr int kGlassLayers = 8, kGlassLayersInSoftware = 3;
[[nodiscard]] constexpr int glass_layers(bool software) {
    return software ? kGlassLayersInSoftware : kGlassLayers;
}

class SortedGlass {
public:
    explicit SortedGlass(Programs& programs);
    // Blends into this part of the bound framebuffer, whose depth is that of opaque content. `draw` draws all glass by
    // Programs::use_lit(), without changing blending or the depth's mask.
    void draw(int x_px, int y_px, int width_px, int height_px, int layers, const std::function<void()>& draw);
    [[nodiscard]] int layers_drawn() const { return layers_drawn_; }  // by the last draw()

private:
    void fit(int width_px, int height_px);
    void attach(GLuint colour, GLuint depth);
    void add(GLuint layer, bool straight);
    void fill_screen(GLuint texture, GLint how);

    Programs& programs_;
    GlProgram blend_;
    GLint how_, corner_;
    GlTexture solid_, before_[2], layer_, sum_;
    GlFramebuffer frame_;
    GlVertexArray empty_;
    int width_px_ = 0, height_px_ = 0, layers_drawn_ = 0;
};

}  // namespace tact
