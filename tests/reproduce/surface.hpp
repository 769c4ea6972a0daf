// tact reproduce surface: table 1 and figure 3 of the surface paper on this machine, beside the published values.
//
// Meshes   a rough sphere and a rough terrain made here, with the published sizes of 2 K, 8 K, 20 K and 92 K triangles, and
//          larger ones; or given meshes
// Hand     0.055 m/s, 1.5 mm deep, lifted every two seconds; fast: 0.22 m/s
// Tools    a point, balls of 1 and 3 mm, and a block of 1000 points, 16 mm long, on the mesh at its true size
// Modes    off-tree, off-brute (up to 0.6 million triangles, 0.1 with the block, with fewer steps for larger meshes), chr
// Rate     of one core: one over the mean time of a step. The time of a step is the minimum of three passes, which excludes
//          other programs of the machine.
// Direction  of the force, against the true normal of smooth spheres (surface_direction.hpp)
// Quality  breaks: below 1000 Hz on average. bad: above, but more than one step in a thousand takes more than 1 ms, or the
//          proxy jams. good: neither.
// Writes   CSV and PNG of the table and the figures, direction.csv, surface.json
// Thread   one; some minutes and, for the largest mesh, 4 GB. Fails by StartupError; leaves no process behind.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tact::launch {

struct SurfaceExperiment {
    std::filesystem::path out;                  // folder
    std::vector<std::filesystem::path> meshes;  // instead of the synthetic ones
    std::string unit = "mm";                    // of the given meshes
    std::size_t triangles_max = 10'000'000;     // of the synthetic meshes
    bool quick = false;                         // some seconds, as a check
};

int reproduce_surface(const SurfaceExperiment& experiment);  // returns the exit code

}  // namespace tact::launch
