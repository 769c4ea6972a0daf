// Simplifies a triangle mesh by contracting pairs of vertices, least error first (Garland, Heckbert 1997).
//
// Topology  a contraction is refused where it would pinch, close or double the surface (link condition), turn
//           a triangle over or make it degenerate. Borders move along themselves, held by planes upright on
//           them.
// Errors    integrated over the area: sum of triangle areas times squared distances. error_m is the root of
//           its mean over the planes that a vertex stands for, never falling along the sequence.
// Repeats   the same mesh and settings give the same sequence.
// Cost      about 2.4 us and 240 bytes a vertex, see tests/bench/simplify_bench.cpp.  Thread  any but the
// servo's. Fails by  StartupError on indices out of range or positions that are not finite.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ipc/assets/progressive_mesh.hpp"
#include "ipc/base/progress.hpp"

namespace tact {

inline constexpr double kSeedBoundaryWeight = 1000.0;  // f of the seed

struct SimplifySettings {
    std::uint32_t vertices_min = 4;  // stops there, or earlier where nothing more can be contracted
    double boundary_weight = 10.0;   // f: planes upright on border edges, against triangle planes; 0: none
};

struct Contraction {
    std::uint32_t kept, gone;         // vertices of the original mesh
    std::array<float, 3> position_m;  // of the kept one, from now on
    float error_m;
};

struct Simplified {
    std::vector<Contraction> contraction;  // in order
    TriangleMesh mesh;                     // what is left; vertices renumbered
};

Simplified simplify(const TriangleMesh& mesh, const SimplifySettings& settings,
                    const Progress& progress = {});

// Without vertices that no triangle uses, repeated triangles and triangles with two equal corners.
// Throws as above.
TriangleMesh cleaned(const TriangleMesh& mesh);

}  // namespace tact
