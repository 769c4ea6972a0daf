// The map that placed structures would give at a resolution, on the voxels of another map.
//
// Density   a Gaussian on every atom, of height proportional to its atomic number Z (mass in u where Z is
//           unknown) and sigma = 0.225 * resolution, cut off 4 sigma away along each axis. Map unit: Z.
//           That is what map-fitting programs draw from a structure (sigma = resolution / (pi sqrt 2)).
// Frame     model; positions between voxels are exact, nothing is binned.
// Thread    slow (tens of milliseconds for tens of thousands of atoms); never on the servo thread.
// Fails by  StartupError where the resolution is not positive and finite. Atoms that are off the grid, or
//           whose place is not a number, add nothing.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"

namespace tact {

inline constexpr double kSigmaPerResolution = 0.225;
inline constexpr double kSimulatedCutSigmas = 4.0;

struct PlacedStructure {
    const Structure* structure;
    Pose T_model_body;
};

// Some voxels of a grid: first, first + 1, … along each axis; x fastest in what is stored for it.
struct VoxelBox {
    std::array<std::uint32_t, 3> first{}, size{};
    [[nodiscard]] std::size_t count() const { return std::size_t{size[0]} * size[1] * size[2]; }
};

// Atomic number, or the mass in u of an atom of unknown kind.
[[nodiscard]] double scattering_weight(const Structure& structure, std::size_t atom);

[[nodiscard]] VoxelBox whole_box(const DensityGrid& grid);
// The voxels of the grid that the placed structures can reach; empty where they are off the grid.
[[nodiscard]] VoxelBox reached_box(const DensityGrid& grid, std::span<const PlacedStructure> placed,
                                   double resolution_m);

// Adds scale * density to `values`, one per voxel of `box`. Of the grid only the geometry is used.
void add_simulated(const DensityGrid& grid, const PlacedStructure& placed, double resolution_m, float scale,
                   const VoxelBox& box, std::span<float> values);

// All of them together, one value per voxel of the grid.
[[nodiscard]] std::vector<float> simulated_map(const DensityGrid& grid,
                                               std::span<const PlacedStructure> placed, double resolution_m);

}  // namespace tact
