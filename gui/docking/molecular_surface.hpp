// A smooth closed surface over the atoms of a structure, as plain data.
//
// Surface  where the sum over the atoms i of w_i exp(-|r - r_i|^2 / (2 s_i^2)) is 1: the Gaussian surface of Krone, Stone, Ertl and
//          Schulten, "Fast Visualization of Gaussian Density Surfaces for Molecular Dynamics and Particle System Trajectories", EuroVis 2012
//          (short papers). s_i = R_i / sqrt(2 b) and w_i = exp(b), so that the surface of a lone atom is the sphere of its van der Waals
//          radius R_i (Blinn 1982); b = kSurfaceDecay sets how far neighbours melt together.
// Coarse   where the spacing of the grid would miss an atom, its s_i is raised to kWidestGrid of the spacing, at the same total weight
//          while that keeps the atom inside: every atom is inside at any spacing.
// Vertices of marching cubes (ipc/scene/density/isosurface), moved onto the surface along its normal by one step of Newton's method in the
//          logarithm of the sum, which is exact for a lone atom; by at most kNewtonMost of the spacing.
// Error    vertices lie on the surface (of a lone atom within 0.002 Å), so triangles lie inside where it is convex: of a lone atom, area and
//          volume are too small by about 0.25 and 0.5 of (spacing / R)^2.
// Normals  the exact gradient of the sum, outward. Triangles are counter-clockwise seen from outside; every edge has two.
// Frame    body, ångström.  Thread any.
// Memory   four bytes per voxel, at most kSurfaceVoxelsMax: a structure too large for that has a coarser grid.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "gui/docking/atom_shapes.hpp"
#include "ipc/base/progress.hpp"
#include "ipc/scene/density/structure.hpp"

namespace tact {

inline constexpr double kSurfaceDecay = 1.5, kWidestGrid = 0.7, kNewtonMost = 0.3;
inline constexpr std::size_t kSurfaceVoxelsMax = std::size_t{16} << 20;
// Steps of detail: parts of the vertices of the finest.
inline constexpr std::array kSurfaceShares{1.0F, 0.7F, 0.5F, 0.35F, 0.25F, 0.17F};
inline constexpr std::size_t kSurfaceSteps = kSurfaceShares.size();
// Of the finest step: never finer than this, and coarser where it would have more vertices.
inline constexpr double kFinestSpacingA = 0.6;

struct SurfaceVertex {
    std::array<float, 3> position_a;
    std::array<std::int16_t, 4> normal;  // unit vector times 32767; the last is 0

    friend bool operator==(const SurfaceVertex&, const SurfaceVertex&) = default;
};
static_assert(sizeof(SurfaceVertex) == 20);

struct MolecularSurface {
    std::vector<SurfaceVertex> vertex;
    std::vector<std::uint32_t> atom;  // per vertex: the atom with the nearest centre
    std::vector<std::uint32_t> index;
    double spacing_a = 0.0;  // of the grid; above the wanted one if that had too many voxels
};

// Throws Cancelled, and StartupError as isosurface(). Empty for a structure without atoms.
[[nodiscard]] MolecularSurface build_surface(const Structure& structure, double spacing_a,
                                             const Progress& progress = {});

// Spacing of the finest step that has about vertices_max vertices, told from a coarse surface.
[[nodiscard]] double finest_spacing_a(const MolecularSurface& coarse, std::size_t vertices_max);
// Of a step whose vertices are about kSurfaceShares[step] of those at `finest_a`.
[[nodiscard]] double spacing_of_step_a(double finest_a, std::size_t step);

// The colour of each vertex: of its atom.
[[nodiscard]] std::vector<Rgba8> surface_colours(const MolecularSurface& surface, const Structure& structure,
                                                 bool by_element, AtomPaint paint = {});
// The surface of the straight structure moved with the bent atoms: each vertex as its nearest one, with new normals.
[[nodiscard]] std::vector<SurfaceVertex> bent_surface(const MolecularSurface& surface,
                                                      const Structure& straight, const Structure& bent);

}  // namespace tact
