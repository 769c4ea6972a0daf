#include "gui/docking/painted_surface.hpp"

#include <utility>

namespace tact {

SurfaceShape::SurfaceShape(std::span<const SurfaceVertex> vertex, std::span<const std::uint32_t> index)
    : count_(static_cast<GLsizei>(index.size())) {
    glBindVertexArray(0);  // otherwise the vertex array drawn last would take this index buffer
    glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertex.size_bytes()), vertex.data(),
                 GL_STATIC_DRAW);
    glBindBuffer(GL_COPY_WRITE_BUFFER, indices_.get());
    glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(index.size_bytes()), index.data(),
                 GL_STATIC_DRAW);
    glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
}

PaintedSurface::PaintedSurface(std::shared_ptr<SurfaceShape> shape, std::span<const Rgba8> colours)
    : shape_(std::move(shape)) {
    glBindVertexArray(array_.get());
    glBindBuffer(GL_ARRAY_BUFFER, shape_->vertices_.get());
    attribute(0, 3, GL_FLOAT, GL_FALSE, sizeof(SurfaceVertex), 0);
    attribute(1, 4, GL_SHORT, GL_TRUE, sizeof(SurfaceVertex), 12);
    glBindBuffer(GL_ARRAY_BUFFER, colours_.get());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(colours.size_bytes()), colours.data(),
                 GL_STATIC_DRAW);
    attribute(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(Rgba8), 0);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, shape_->indices_.get());
    glBindVertexArray(0);
}

void PaintedSurface::draw() {
    glBindVertexArray(array_.get());
    glDrawElements(GL_TRIANGLES, shape_->count_, GL_UNSIGNED_INT, nullptr);
}

}  // namespace tact
