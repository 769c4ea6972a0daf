#include "gui/render/surface.hpp"

namespace tact {

Surface::Surface(const ProgressiveMesh& mesh) : cut_(mesh) {
    glBindVertexArray(array_.get());
    glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(sizeof(PackedVertex) * mesh.vertices()), nullptr,
                 GL_DYNAMIC_DRAW);
    attribute(0, 3, GL_FLOAT, GL_FALSE, sizeof(PackedVertex), 0);
    attribute(1, 4, GL_INT_2_10_10_10_REV, GL_TRUE, sizeof(PackedVertex), 12);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.get());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(sizeof(std::uint32_t) * 3 * mesh.triangles()), nullptr,
                 GL_DYNAMIC_DRAW);
    glBindVertexArray(0);
}

void Surface::approach(std::uint32_t wanted, double budget_s, double at_once_s) noexcept {
    const Instant begin = Monotonic::now();
    if (cut_.whole_ns(wanted) <= pace_.budget_ns(at_once_s))
        cut_.set_vertices(wanted);
    else
        cut_.approach(wanted, pace_.budget_ns(budget_s));
    moving_ = Monotonic::now() - begin;
}

std::size_t Surface::upload() {
    const Instant begin = Monotonic::now();
    const MeshChanges changes = cut_.changes();
    if (changes.vertex.empty() && changes.index.empty()) return 0;
    std::size_t sent = 0;
    glBindVertexArray(0);  // otherwise the vertex array drawn last would take this index buffer
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
    send(vertices_.get(), changes.vertex, cut_.vertex().data(), sizeof(PackedVertex));
    send(indices_.get(), changes.index, cut_.index().data(), sizeof(std::uint32_t));
    glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
    if (drawn_) pace_.took(cut_.cost_ns(), to_s(moving_ + (Monotonic::now() - begin)));
    drawn_ = true;
    return sent;
}

void Surface::draw(const Eigen::Vector3f& colour) {
    glBindVertexArray(array_.get());
    glVertexAttrib4f(2, colour.x(), colour.y(), colour.z(), 1.0F);
    draw_count_.clear();
    draw_first_.clear();
    for (const MeshRange& range : cut_.draws()) {
        if (range.count == 0) continue;
        draw_count_.push_back(static_cast<GLsizei>(range.count));
        draw_first_.push_back(reinterpret_cast<const void*>(sizeof(std::uint32_t) * range.first));
    }
    glMultiDrawElements(GL_TRIANGLES, draw_count_.data(), GL_UNSIGNED_INT, draw_first_.data(),
                        static_cast<GLsizei>(draw_count_.size()));
    glBindVertexArray(0);
}

std::size_t PlainSurface::fill(const PlainMesh& mesh) {
    const std::size_t vertex_bytes = mesh.vertex.size() * sizeof(MeshVertex);
    const std::size_t index_bytes = mesh.index.size() * sizeof(std::uint32_t);
    glBindVertexArray(array_.get());
    glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertex_bytes), mesh.vertex.data(), GL_STREAM_DRAW);
    attribute(0, 3, GL_FLOAT, GL_FALSE, sizeof(MeshVertex), 0);
    attribute(1, 4, GL_SHORT, GL_TRUE, sizeof(MeshVertex), 12);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.get());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(index_bytes), mesh.index.data(),
                 GL_STREAM_DRAW);
    glBindVertexArray(0);
    vertex_count_ = static_cast<std::uint32_t>(mesh.vertex.size());
    index_count_ = static_cast<std::uint32_t>(mesh.index.size());
    return vertex_bytes + index_bytes;
}

void PlainSurface::draw(const Eigen::Vector3f& colour) {
    glBindVertexArray(array_.get());
    glVertexAttrib4f(2, colour.x(), colour.y(), colour.z(), 1.0F);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(index_count_), GL_UNSIGNED_INT, nullptr);
    glBindVertexArray(0);
}

}  // namespace tact
