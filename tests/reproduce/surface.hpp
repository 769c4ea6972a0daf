// tact reproduce surface: the surface paper's table 1 and figure 3 on this machine, its values beside ours.
//
// Meshes   a rough sphere and a rough terrain made here, by number of triangles the seed's 2 K, 8 K, 20 K and 92 K, and
//          beyond; or those that are given
// Hand     0.055 m/s, 1.5 mm deep, lifted every two seconds; fast: 0.22 m/s
// Tools    a point, balls of 1 and 3 mm, and a block of 1000 points, 16 mm long, on the mesh as large as in its file
// Modes    off-tree, off-brute (to 0.6 million triangles, 0.1 with the block, and fewer steps the more there are), chr
// Rate     what one core could do: one over the mean time of a step. The time of a step is the least of three
//          passes, so what other programs of the machine take does not count.
// Direction  of the force, against the true normal of smooth spheres (surface_direction.hpp)
// Quality  breaks: below 1000 Hz on average. bad: above, but more than one step in a thousand takes more than 1 ms, or
//          the proxy stands still. good: neither.
// Writes   CSV and PNG of the table and the figures, direction.csv, surface.json
// Thread   one; some minutes and, for the largest mesh, 4 GB. Fails by StartupError; leaves no process behind.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tact::launch {

struct SurfaceExperiment {
    std::filesystem::path out;                  // folder
    std::vector<std::filesystem::path> meshes;  // instead of our own
    std::string unit = "mm";                    // of those
    std::size_t triangles_max = 10'000'000;     // of our own
    bool quick = false;                         // seconds: shows that it works
};

int reproduce_surface(const SurfaceExperiment& experiment);  // the exit code

}  // namespace tact::launch
