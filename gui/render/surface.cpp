#include "gui/render/surface.hpp"

namespace tact {

Surface::Surface(const ProgressiveMesh& mesh) : cut_(mesh) {
    glBindVertexArray(array_.get());
    glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(sizeof(MeshVertex) * mesh.vertices()), nullptr,
                 GL_DYNAMIC_DRAW);
    attribute(0, 3, GL_FLOAT, GL_FALSE, sizeof(MeshVertex), 0);
    attribute(1, 4, GL_SHORT, GL_TRUE, sizeof(MeshVertex), 12);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.get());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(sizeof(std::uint32_t) * 3 * mesh.triangles()), nullptr,
                 GL_DYNAMIC_DRAW);
    glBindVertexArray(0);
}

std::size_t Surface::upload() {
    const MeshChanges changes = cut_.changes();
    if (changes.vertex.empty() && changes.index.empty()) return 0;
    std::size_t sent = 0;
    glBindVertexArray(0);  // the index buffer would otherwise be bound into whatever is drawn last
    const auto send = [&sent](GLuint buffer, std::span<const MeshRange> ranges, const void* data,
                              std::size_t size) {
        glBindBuffer(GL_COPY_WRITE_BUFFER, buffer);
        for (const MeshRange& range : ranges) {
            const std::size_t first = size * range.first, bytes = size * range.count;
            glBufferSubData(GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(first),
                            static_cast<GLsizeiptr>(bytes), static_cast<const std::byte*>(data) + first);
            sent += bytes;
        }
    };
    send(vertices_.get(), changes.vertex, cut_.vertex().data(), sizeof(MeshVertex));
    send(indices_.get(), changes.index, cut_.index().data(), sizeof(std::uint32_t));
    glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
    return sent;
}

void Surface::draw() {
    glBindVertexArray(array_.get());
    glVertexAttrib4f(2, 0.66F, 0.80F, 0.95F, 1.0F);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * cut_.triangles()), GL_UNSIGNED_INT, nullptr);
    glBindVertexArray(0);
}

}  // namespace tact
