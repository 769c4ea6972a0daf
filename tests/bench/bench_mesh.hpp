// Cost of changing the detail of a progressive mesh of a million vertices on this machine: for `tact bench docking`.
//
// Method   a torus of 1024 x 1024 vertices, contracted row by row and column by column, each round in random
//          order, which is about how a real surface spreads over memory. Each is repeated 15 or 101 times; the
//          time that went by, as a display loop sees it, with the caches as left by what came before. Finding
//          the ranges to upload is part of the jumps, and of the walks a figure of its own; sending them is
//          not measured.
// Takes    about three seconds, most of them to make the mesh.
#pragma once

#include "tests/bench/percentiles.hpp"

namespace tact {

struct MeshBench {
    Percentiles jump_ms;              // from 100 % of the vertices to 28 %
    Percentiles jump_back_ms;         // and back
    Percentiles copy_ms;              // memcpy of what is drawn at 28 %, to judge the machine by
    Percentiles ns_per_contraction;   // of a walk of 1000 down, at half of the vertices
    Percentiles ns_per_vertex_split;  // of the same walk up
    Percentiles changes_ms;           // to find what to upload after a walk of 1000
    double bytes_per_vertex = 0.0;    // of the mesh in memory, without the buffers that are drawn
};

[[nodiscard]] MeshBench bench_mesh();

}  // namespace tact
