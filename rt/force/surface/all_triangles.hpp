// Linear search over all triangles of a surface: mode off-brute, for comparison with the tree.
//
// Thread    any, TACT_RT.  Unit  metres of the model.
#pragma once

#include <cstdint>
#include <span>

#include "ipc/scene/mesh/surface_mesh.hpp"

namespace tact {

class AllTriangles {
public:
    explicit AllTriangles(const SurfaceMesh& mesh) : mesh_(mesh), kernel_(&best_query_kernel()) {}

    // Finds the triangles nearer than radius_m, in index order. False: more than `out` holds.
    bool near(const Vec3& place_m, double radius_m, std::span<std::uint32_t> out,
              std::size_t& count) const noexcept TACT_RT;
    // A lower bound on the distance of the surface, at most at_most_m.
    [[nodiscard]] double clearance_m(const Vec3& place_m, double at_most_m) const noexcept TACT_RT;

private:
    SurfaceMesh mesh_;  // a view
    const QueryKernel* kernel_;
};

}  // namespace tact
