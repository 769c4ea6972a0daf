// Simplifies a triangle mesh by contracting pairs of vertices, least error first (Garland, Heckbert 1997).
//
// Pairs     edges; with pair_distance also vertices that are near in space, so that parts may join or vanish.
// Topology  over edges a contraction is refused where it would pinch, close or double the surface (link
//           condition). Borders, and edges with more than two triangles, move along themselves, held by
//           planes upright on them. Any mesh is taken; what cannot be contracted soundly is left as it
//           is.
// Folds     none is made: no triangle turns by more than 60 degrees in one step, becomes a needle, or
//           comes to lie within 26 degrees on a neighbour, at the new vertex or across from it. Where the surface that a
//           vertex stands for looks to one side, its triangles stay within 60 degrees of it however many steps they took.
// Errors    integrated over the area: sum of triangle areas times squared distances. error_m is the root of
//           its mean over the planes that a vertex stands for, never falling along the sequence.
// Repeats   the same mesh and settings give the same sequence.
// Cost      about 1.6 us and 260 bytes a vertex, see tests/bench/simplify_bench.cpp.
// Thread    any but the servo's.
// Fails by  StartupError on indices out of range or positions that are not finite.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ipc/base/progress.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

inline constexpr double kSeedBoundaryWeight = 1000.0;  // f of the seed

struct SimplifySettings {
    std::uint32_t vertices_min = 4;  // stops there, or earlier where nothing more can be contracted
    double boundary_weight = 100.0;  // f: planes upright on border edges, against triangle planes; 0: none
    // t, in mean edge lengths: vertices without an edge that are nearer to each other are pairs too; 0: edges
    // alone.
    double pair_distance = 0.0;
    std::uint32_t pairs_per_vertex_max = 4;  // of those, the nearest
    // Above 0 the order weighs, beside the error, how far the vertices lie apart that one comes to stand for:
    // as if their surface had moved by this part of that radius. Keeps the parts of a forest round.
    double locality = 0.0;
};

struct Contraction {
    std::uint32_t kept, gone;         // vertices of the original mesh
    std::array<float, 3> position_m;  // of the kept one, from now on
    float error_m;                    // the largest of this and all before
    float own_error_m;                // of this one
};

struct Simplified {
    std::vector<Contraction> contraction;  // in order
    TriangleMesh mesh;                     // what is left; vertices renumbered
    std::vector<std::uint32_t> origin;     // the original number of each vertex of mesh
};

Simplified simplify(const TriangleMesh& mesh, const SimplifySettings& settings,
                    const Progress& progress = {});

// Without vertices that no triangle uses, repeated triangles and triangles with two equal corners.
// Throws as above.
TriangleMesh cleaned(const TriangleMesh& mesh);

}  // namespace tact
