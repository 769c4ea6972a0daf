// Moves the vertices of a simplified mesh to where it lies nearest to the original, in the mean of squares.
//
// Contraction puts a vertex where the planes of its neighbourhood want it; between the vertices the surface
// follows as it can. Here samples of the original pull on the triangle that is nearest to each. The triangles
// stay as they are. Topology  unchanged; a vertex does not move where a triangle would turn over or fold onto
// its neighbour. Cost      about 20 samples a vertex and round, not more than the original has.  Thread  any
// but the servo's.
#pragma once

#include "prep/mesh/simplify.hpp"

namespace tact {

// `simplified` comes from `original`. Two rounds bring most of the gain.
void relax(const TriangleMesh& original, Simplified& simplified, std::uint32_t rounds,
           const Progress& progress = {});

}  // namespace tact
