// The full mesh around the tool with a small tree of its own, which the contact searches instead of the full tree.
//
// Tree      the part of the full tree that reaches into a box: same leaves, so same triangles. Nodes with only one
//           child in the box are left out.
// Memory    128 bytes per node of capacity, allocated by the constructor
// Thread    build() on the refining thread; then the servo reads. No allocation.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ipc/scene/mesh/surface_mesh.hpp"

namespace tact {

class NearSurface {
public:
    NearSurface() = default;
    explicit NearSurface(std::uint32_t nodes_max) : node_(nodes_max) {}
    // Collects every triangle whose bounding box overlaps the given box. False: too many; the surface is then empty.
    // version: increases from build to build, from 1.
    bool build(const SurfaceMesh& full, const std::array<float, 3>& low_m, const std::array<float, 3>& high_m,
               std::uint64_t version) noexcept;

    [[nodiscard]] bool holds(const Vec3& centre_m, double radius_m) const noexcept TACT_RT {
        return nodes_ > 0 && ((centre_m.array() - radius_m) >= low_m_.array()).all() &&
               ((centre_m.array() + radius_m) <= high_m_.array()).all();
    }
    // Only if not empty.
    [[nodiscard]] const SurfaceMesh& mesh() const noexcept TACT_RT { return mesh_; }
    [[nodiscard]] std::uint64_t version() const noexcept TACT_RT { return version_; }

private:
    struct Builder;

    Vec3 low_m_ = Vec3::Zero(), high_m_ = Vec3::Zero();
    std::uint32_t nodes_ = 0;
    std::uint64_t version_ = 0;
    std::vector<SurfaceNode> node_;
    SurfaceMesh mesh_;  // a view on the full mesh and on node_
};

}  // namespace tact
