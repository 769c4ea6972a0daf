// Dust as small lit balls; water, blood and paste as wet bodies, drawn over the scene.
//
// Hides    by the depth of earlier content: bone and instruments. Grains write depth, fluids do not.
// Fluid    method in particle_cloud.cpp
// Cost     one point per particle, and the pixels of the fluids' bounding box
// Thread   frame thread, context current; draws into the bound framebuffer.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "gui/drilling/fluid_target.hpp"
#include "gui/drilling/particle_dots.hpp"
#include "gui/render/shading.hpp"

namespace tact {

class ParticleCloud {
public:
    ParticleCloud();

    struct View {
        Eigen::Matrix4f eye_from_cells, projection;  // eye: ångström
        float cell_a = 1.0F;
        Haze haze;
        int x_px = 0, y_px = 0, width_px = 1, height_px = 1;  // of the viewport
    };
    // Uploads the current particles; positions are in cells.
    void fill(std::span<const Particle> particles);
    void draw(const View& view);
    [[nodiscard]] const DotRanges& sent() const { return sent_; }

private:
    struct Program {
        Program(const char* what, const char* vertex, const char* fragment);
        GlProgram program;
        ViewUniforms view;
        GLint size;  // radius of a cell; pixels per length at distance 1
    };
    void draw_grains(const View& view);
    void draw_fluids(const View& view);
    // Pixels of the viewport that the fluids may cover; empty: none.
    struct Box {
        int x = 0, y = 0, width = 0, height = 0;
    };
    [[nodiscard]] std::optional<Box> fluid_box(const View& view) const;

    Program grains_, sums_;
    GlProgram surface_;
    ViewUniforms surface_view_;
    std::unique_ptr<FluidTarget> target_;
    GlVertexArray dots_array_, empty_;
    GlBuffer dots_buffer_;
    std::vector<ParticleDot> dots_;
    DotRanges sent_;
};

}  // namespace tact
