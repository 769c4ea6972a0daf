// A synthetic closed mesh of any size with bumps of all sizes down to a few triangles, for speed measurements.
#pragma once

#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

// n x m points, 2 n m triangles; radii 1 and about 0.3 m.
TriangleMesh rough_torus(std::uint32_t n, std::uint32_t m);

}  // namespace tact
