// What walking a progressive mesh of a million vertices costs on this machine: for `tact bench docking`.
//
// Method   a torus of 1024 x 1024 vertices, contracted row by row and column by column, each round in random
//          order, which is about how a real surface spreads over memory. Medians of processor time, as the
//          caches are left by what came before; finding the ranges to upload is part of the jumps, and of the
//          walks a figure of its own; sending them is not measured.
// Takes    about three seconds, most of them to make the mesh.
#pragma once

namespace tact {

struct MeshBench {
    double jump_ms = 0.0;              // from 100 % of the vertices to 28 %
    double jump_back_ms = 0.0;         // and back
    double copy_ms = 0.0;              // memcpy of what is drawn at 28 %, to judge the machine by
    double ns_per_contraction = 0.0;   // of a walk of 1000 down, at half of the vertices
    double ns_per_vertex_split = 0.0;  // of the same walk up
    double changes_ms = 0.0;           // to find what to upload after a walk of 1000
    double bytes_per_vertex = 0.0;     // of the mesh in memory, without the buffers that are drawn
};

[[nodiscard]] MeshBench bench_mesh();

}  // namespace tact
