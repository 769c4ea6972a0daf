// Moves the vertices of a simplified mesh to minimize the mean squared distance to the original.
//
// Contraction places a vertex by the planes around it; the surface between the vertices follows. Here samples of the
// original attract the triangle nearest to each. The triangles are unchanged.
//
// Topology  unchanged; a vertex does not move if a triangle would flip or fold onto its neighbour, nor, with more than
//           one round, away from the original.
// Cost      about 20 samples per vertex and round, at most as many as the original has triangles.
// Thread    any but the servo's.
#pragma once

#include "prep/mesh/simplify.hpp"

namespace tact {

// Useful number of rounds: one, and up to 40 for a mesh with borders and few vertices, whose border converges slowly.
std::uint32_t relax_rounds(const TriangleMesh& original, const Simplified& simplified);

// `simplified` must come from `original`. Two rounds bring most of the gain.
void relax(const TriangleMesh& original, Simplified& simplified, std::uint32_t rounds,
           const Progress& progress = {});

}  // namespace tact
