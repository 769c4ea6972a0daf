#include "gui/render/triangle_buffers.hpp"

namespace tact {

void TriangleBuffers::fill(const TubeMesh& mesh, GLenum usage) {
    glBindVertexArray(array_.get());
    glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.vertex.size() * sizeof(TubeVertex)),
                 mesh.vertex.data(), usage);
    attribute(0, 3, GL_FLOAT, GL_FALSE, sizeof(TubeVertex), 0);
    attribute(1, 3, GL_FLOAT, GL_FALSE, sizeof(TubeVertex), 12);
    attribute(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(TubeVertex), 24);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.get());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.index.size() * sizeof(std::uint32_t)),
                 mesh.index.data(), usage);
    count_ = static_cast<GLsizei>(mesh.index.size());
    glBindVertexArray(0);
}

void TriangleBuffers::draw() {
    glBindVertexArray(array_.get());
    glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
}

}  // namespace tact
