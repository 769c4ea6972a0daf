// Distance between the borders of two surfaces, in metres: root mean square over sample points of each border of their
// distance to the other border, weighted by length. 0 if one surface has no border.
//
// Compares every edge with every edge: for borders of some thousand edges.
#pragma once

#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

double border_distance_rms_m(const TriangleMesh& a, const TriangleMesh& b);

}  // namespace tact
