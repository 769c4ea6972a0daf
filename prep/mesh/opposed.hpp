// Tells whether a triangle of a simplified mesh faces away from the part of the original that it stands for.
//
// Part       the original triangles at the vertices that were contracted into its three corners.
// Opposed    at a point of the triangle, the nearest original triangle faces away from it: opposed_m() is how much farther
//            the nearest one that faces its way is. At a crease or in a narrow gap both are about equally near.
// Positions  those of the original mesh, in m.  Thread  one at a time.
// Cost       4 bytes per vertex and a swap per contraction; from the first opposed_m() 32 bytes per vertex and 16 per triangle
//            more. opposed_m() visits all vertices of the part and the triangles that may be nearest.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "ipc/base/huge_pages.hpp"
#include "ipc/base/prefetch.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

class Opposed {
public:
    explicit Opposed(const TriangleMesh& original);  // which must live as long

    // What `gone` stands for goes to `kept`. Both are numbers of the original mesh, not joined yet; a second call parts them.
    void join(std::uint32_t kept, std::uint32_t gone) { std::swap(after_[kept], after_[gone]); }
    void prefetch_joint(std::uint32_t v) const { prefetch(after_.data() + v); }

    struct Face {
        std::array<std::uint32_t, 3> vertex;    // of the original; the parts of these
        std::array<Eigen::Vector3d, 3> corner;  // where they are now
    };
    // At the worst of four points: the centre, and half-way between it and each corner. 0: the nearest triangle faces its
    // way; about kNowhere: none does. May return any value up to enough_m instead of a lower one.
    [[nodiscard]] double opposed_m(const Face& face, double enough_m);
    static constexpr double kNowhere = 1e30;
    // Triangles looked at so far, and a quarter of the vertices visited.
    [[nodiscard]] std::uint64_t work() const { return work_; }

private:
    struct Spot {
        Eigen::Vector3f at;
        float reach;           // length of the longest edge here
        Eigen::Vector3f mean;  // sum of the normals here
    };
    void list_triangles();
    template <class Take>
    void each_in_part(const Face& face, Take&& take);
    [[nodiscard]] std::array<Eigen::Vector3d, 3> corners(std::uint32_t t) const;

    const TriangleMesh& original_;
    std::uint64_t work_ = 0;
    HugeVector<std::uint32_t> after_;          // the vertices of a part, in a ring
    std::vector<std::uint32_t> first_, list_;  // triangles of each vertex of the original, once needed
    std::vector<std::uint32_t> seen_;  // per triangle of the original: turn_ if looked at for this point
    std::uint32_t turn_ = 0;
    std::vector<Spot> spot_;  // of each vertex of the original
};

}  // namespace tact
