// Moves the vertices of a simplified mesh to where it lies nearest to the original, in the mean of squares.
//
// Contraction puts a vertex where the planes of its neighbourhood want it; between the vertices the surface
// follows as it can. Here samples of the original pull on the triangle that is nearest to each. The triangles
// stay as they are.
//
// Topology  unchanged; a vertex does not move where a triangle would turn over or fold onto its neighbour,
//           nor, in more rounds than one, away from the original.
// Cost      about 20 samples a vertex and round, not more than the original has.
// Thread    any but the servo's.
#pragma once

#include "prep/mesh/simplify.hpp"

namespace tact {

// How many rounds are worth their time: one, and up to 40 where a mesh with borders has few vertices, as its
// border comes nearer to the original's slowly.
std::uint32_t relax_rounds(const TriangleMesh& original, const Simplified& simplified);

// `simplified` comes from `original`. Two rounds bring most of the gain.
void relax(const TriangleMesh& original, Simplified& simplified, std::uint32_t rounds,
           const Progress& progress = {});

}  // namespace tact
