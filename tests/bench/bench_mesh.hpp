// Cost of changing the detail of a progressive mesh of a million vertices on this machine: for `tact bench docking`.
//
// Method   a torus of 1024 x 1024 vertices, contracted row by row and column by column, each round in random
//          order, which spreads over memory about as a real surface does. Medians of processor time, with the caches
//          as left by the work before. Jumps include finding the ranges to upload; for walks this is a value of its
//          own. Uploading is not measured.
// Takes    about three seconds, mostly to make the mesh.
#pragma once

namespace tact {

struct MeshBench {
    double jump_ms = 0.0;              // from 100 % of the vertices to 28 %
    double jump_back_ms = 0.0;         // and back
    double copy_ms = 0.0;              // memcpy of the data drawn at 28 %, as a reference for the machine
    double ns_per_contraction = 0.0;   // of a walk of 1000 contractions, at half of the vertices
    double ns_per_vertex_split = 0.0;  // of the same walk in reverse
    double changes_ms = 0.0;           // time to find the ranges to upload after a walk of 1000
    double bytes_per_vertex = 0.0;     // of the mesh in memory, without drawing buffers
};

[[nodiscard]] MeshBench bench_mesh();

}  // namespace tact
