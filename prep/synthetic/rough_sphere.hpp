// Synthetic surfaces to touch: a rough sphere, a smooth sphere and a rough terrain, of any number of triangles.
//
// Roughness  value noise in five octaves, each half as high and about twice as fine as the previous one: bumps of all
//            sizes down to a few triangles. It repeats exactly.
// Unit       metres
#pragma once

#include "ipc/base/pose.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

inline constexpr double kRoughSphereM = 0.05;  // radius

// Radius of the rough sphere in a direction of length 1: 0.05 m plus or minus about 5 mm.
double rough_radius_m(const Vec3& direction);

// An icosahedron whose edges are divided into `parts`: 20 parts^2 triangles, closed.
TriangleMesh rough_sphere(std::uint32_t parts);
// The same without roughness: all vertices lie kRoughSphereM from the origin.
TriangleMesh smooth_sphere(std::uint32_t parts);

// A square of 0.12 m, y up, parts x parts cells of two triangles, open. Hills of up to about 12 mm.
TriangleMesh rough_terrain(std::uint32_t parts);
double rough_height_m(double x_m, double z_m);

}  // namespace tact
