// tact reproduce surface: table 1 and figure 3 of the surface paper, compared with the published values.
//
// Meshes     synthetic rough spheres and a rough terrain with the published sizes of 2 K, 8 K, 20 K and 92 K triangles,
//            and larger meshes; or given meshes
// Hand       0.055 m/s, 1.5 mm deep, lifted every two seconds; fast: 0.22 m/s
// Tools      a point, balls of 1 and 3 mm; on the mesh at its true size, a block of 1000 points, 16 mm long
// Modes      off-tree; off-brute (up to 0.6 million triangles, 0.1 million with the block, with fewer steps for larger
//            meshes); chr
// Rate       of one core: the reciprocal of the mean time of a step. The time of a step is the minimum of three passes,
//            which excludes the effect of other programs on the machine.
// Direction  angle between the force and the true normal of smooth spheres (surface_direction.hpp)
// Quality    breaks: below 1000 Hz on average. bad: above, but more than one step in a thousand takes more than 1 ms,
//            or the proxy jams. good: neither.
// Writes     CSV and PNG of the table and the figures, direction.csv, surface.json
// Thread     one; takes some minutes and, for the largest mesh, 4 GB. Fails by StartupError. Ends all child processes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tact::launch {

struct SurfaceExperiment {
    std::filesystem::path out;                  // folder
    std::vector<std::filesystem::path> meshes;  // replace the synthetic meshes
    std::string unit = "mm";                    // of the given meshes
    std::size_t triangles_max = 10'000'000;     // of the synthetic meshes
    bool quick = false;                         // a check of some seconds
};

int reproduce_surface(const SurfaceExperiment& experiment);  // returns the exit code

}  // namespace tact::launch
