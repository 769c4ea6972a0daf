// Adjacency of a constant mesh: the triangles of each vertex, and its next vertex along the border.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

class MeshStars {
public:
    explicit MeshStars(const TriangleMesh& mesh) : corner_(mesh.triangle) {
        first_.assign(mesh.vertices() + 1, 0);
        for (const std::uint32_t v : corner_) ++first_[v + 1];
        for (std::size_t v = 0; v < mesh.vertices(); ++v) first_[v + 1] += first_[v];
        list_.resize(corner_.size());
        std::vector<std::uint32_t> place(first_.begin(), first_.end() - 1);
        for (std::uint32_t i = 0; i < corner_.size(); ++i) list_[place[corner_[i]]++] = i / 3;
        border_.assign(mesh.vertices(), kNoIndex);
        for (std::uint32_t i = 0; i < corner_.size(); ++i) {
            const std::uint32_t v = corner_[i], w = corner_[i % 3 == 2 ? i - 2 : i + 1];
            if (count(v, w) == 1) border_[v] = w;
        }
    }
    [[nodiscard]] std::span<const std::uint32_t> triangles(std::uint32_t v) const {
        return std::span(list_).subspan(first_[v], first_[v + 1] - first_[v]);
    }
    // Per vertex: the end of the border edge that begins there, or kNoIndex.
    [[nodiscard]] std::span<const std::uint32_t> border() const { return border_; }
    [[nodiscard]] bool has(std::uint32_t t, std::uint32_t v) const {
        return corner_[3 * std::size_t{t}] == v || corner_[3 * std::size_t{t} + 1] == v ||
               corner_[3 * std::size_t{t} + 2] == v;
    }
    [[nodiscard]] bool share_edge(std::uint32_t t, std::uint32_t other) const {
        int common = 0;
        for (std::size_t i = 0; i < 3; ++i) common += has(other, corner_[3 * std::size_t{t} + i]) ? 1 : 0;
        return common == 2;
    }

private:
    [[nodiscard]] std::size_t count(std::uint32_t v, std::uint32_t w) const {
        const std::span<const std::uint32_t> around = triangles(v);
        return static_cast<std::size_t>(
            std::count_if(around.begin(), around.end(), [&](std::uint32_t t) { return has(t, w); }));
    }
    const std::vector<std::uint32_t>& corner_;
    std::vector<std::uint32_t> first_, list_, border_;
};

}  // namespace tact
