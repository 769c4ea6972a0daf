// A molecular surface in graphics memory: its shape, shared by all colourings and copies, and colours of its vertices.
//
// Thread   frame thread, context current.
#pragma once

#include <memory>
#include <span>

#include "gui/docking/molecular_surface.hpp"
#include "gui/render/gl.hpp"

namespace tact {

class SurfaceShape {
public:
    SurfaceShape(std::span<const SurfaceVertex> vertex, std::span<const std::uint32_t> index);
    [[nodiscard]] GLsizei indices() const { return count_; }

private:
    friend class PaintedSurface;
    GlBuffer vertices_, indices_;
    GLsizei count_ = 0;
};

class PaintedSurface {
public:
    PaintedSurface(std::shared_ptr<SurfaceShape> shape, std::span<const Rgba8> colours);  // one per vertex
    void draw();  // with a program of triangles in use

private:
    std::shared_ptr<SurfaceShape> shape_;
    GlVertexArray array_;
    GlBuffer colours_;
};

}  // namespace tact
