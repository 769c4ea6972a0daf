// Cost of changing the detail of a progressive mesh of a million vertices on this machine: for `tact bench docking`.
//
// Method   a torus of 1024 x 1024 vertices, contracted row by row and column by column. Each round is in random order,
//          which resembles the memory layout of a real surface. Each measurement is repeated 5, 15 or 101 times. Times are
//          wall-clock times, as in a display loop; the caches are not flushed in between. The times of the jumps
//          include the search for the ranges to upload; for the walks it is measured separately (changes_ms). The
//          upload itself is not measured.
// Takes    about three seconds, most of them to make the mesh
#pragma once

#include "tests/bench/percentiles.hpp"

namespace tact {

struct MeshBench {
    Percentiles jump_ms;       // from 100 % of the vertices to 28 %
    Percentiles jump_back_ms;  // back from there to 100 %
    Percentiles
        jump_back_walked_ms;   // the same after single steps to 28 %, which leave hardly a block unchanged
    Percentiles copy_ms;       // memcpy of the drawn buffers at 28 %, as a reference for the machine
    Percentiles copy_back_ms;  // the same at 100 %
    Percentiles ns_per_contraction;   // in a walk of 1000 contractions from half of the vertices
    Percentiles ns_per_vertex_split;  // in the same walk reversed
    Percentiles changes_ms;           // search for the ranges to upload after a walk of 1000
    double bytes_per_vertex = 0.0;    // memory of the mesh without the drawn buffers
};

[[nodiscard]] MeshBench bench_mesh();

}  // namespace tact
