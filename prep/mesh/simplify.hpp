// Simplifies a triangle mesh by contracting pairs of vertices, least error first (Garland, Heckbert 1997).
//
// Pairs     edges; with pair_distance also vertices that are near in space, so that parts may join or vanish.
// Topology  edge contractions that would pinch, close or double the surface are refused (link condition). Borders, and
//           edges with more than two triangles, contract along themselves, held by planes perpendicular to them. Any
//           mesh is accepted; parts that cannot be contracted soundly are left unchanged.
// Folds     none is made: no triangle turns by more than 60 degrees in one step, becomes a needle, or comes within 30
//           degrees of lying on a neighbour, at the new vertex or across from it. If the surface that a vertex
//           represents mostly faces one side, its triangles stay within 60 degrees of that side over all steps.
// Spikes    where the surface is bent, a new vertex stays within the error level of the surface before, and what a step
//           removes within that level of the surface after: no spike grows, or is lost while larger. Not with pair_distance.
// Errors    integrated over the area: sum of triangle areas times squared distances. error_m is the root of its mean
//           over the planes that a vertex represents; it never decreases along the sequence.
// Repeats   the same mesh and settings give the same sequence.
// Cost      about 1.6 us and 350 bytes per vertex, see tests/bench/simplify_bench.cpp.
// Thread    any but the servo's.
// Fails by  StartupError on indices out of range or positions that are not finite.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ipc/base/progress.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

inline constexpr double kPublishedBoundaryWeight = 1000.0;  // f of the published method

struct SimplifySettings {
    std::uint32_t vertices_min = 4;  // stops there, or earlier if no further contraction is possible
    // f: weight of planes at border edges, relative to triangle planes; a tenth of it where more than 5 % of these edges
    // have three or more triangles
    double boundary_weight = 100.0;
    // t, in mean edge lengths: unconnected vertices that are nearer to each other are pairs too; 0: only edges.
    double pair_distance = 0.0;
    std::uint32_t pairs_per_vertex_max = 4;  // the nearest of these pairs
    // Above 0 the order also weighs the extent of the surface that a vertex represents, as if it were displaced by this
    // fraction of the radius. Keeps the parts of a forest compact.
    double locality = 0.0;
};

struct Contraction {
    std::uint32_t kept, gone;         // vertices of the original mesh
    std::array<float, 3> position_m;  // of the kept vertex, after this contraction
    float error_m;                    // the largest of this and all earlier contractions
    float own_error_m;                // of this contraction
};

struct Simplified {
    std::vector<Contraction> contraction;  // in order
    TriangleMesh mesh;                     // the remaining mesh; vertices renumbered
    std::vector<std::uint32_t> origin;     // original number of each vertex of mesh
};

Simplified simplify(const TriangleMesh& mesh, const SimplifySettings& settings,
                    const Progress& progress = {});

// Removes vertices without triangles, repeated triangles and triangles with two equal corners. Throws like simplify().
TriangleMesh cleaned(const TriangleMesh& mesh);

}  // namespace tact
