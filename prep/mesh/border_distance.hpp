// How far the borders of two surfaces are apart: the root mean square of the distances of points of each to
// the other, over the length, in metres. 0 where one of them has none.
//
// Every edge is compared with every edge: for borders of some thousand edges.
#pragma once

#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

double border_distance_rms_m(const TriangleMesh& a, const TriangleMesh& b);

}  // namespace tact
