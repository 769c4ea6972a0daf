// The simulated map of placed structures at a resolution, on the voxels of another map.
//
// Density   a Gaussian at every atom, of height proportional to its atomic number Z (mass in u if Z is
//           unknown) and sigma = 0.225 * resolution, cut off 4 sigma away along each axis. Map unit: Z.
//           Map-fitting programs use the same sigma = resolution / (pi sqrt 2)
// Frame     model; positions between voxels are exact, without binning
// Thread    slow (tens of milliseconds for tens of thousands of atoms); never on the servo thread
// Errors    StartupError if the resolution is not positive and finite. Atoms off the grid or at NaN
//           positions add nothing
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

// A box of grid voxels: first, first + 1, … along each axis; its values are stored with x fastest.
struct VoxelBox {
    std::array<std::uint32_t, 3> first{}, size{};
    [[nodiscard]] std::size_t count() const { return std::size_t{size[0]} * size[1] * size[2]; }
};

// Atomic number, or the mass in u of an atom of unknown kind.
[[nodiscard]] double scattering_weight(const Structure& structure, std::size_t atom);

[[nodiscard]] VoxelBox whole_box(const DensityGrid& grid);
// The voxels of the grid within range of the placed structures; empty if they are off the grid.
[[nodiscard]] VoxelBox reached_box(const DensityGrid& grid, std::span<const PlacedStructure> placed,
                                   double resolution_m);

// Adds scale * density to `values`, one per voxel of `box`. Uses only the geometry of the grid.
void add_simulated(const DensityGrid& grid, const PlacedStructure& placed, double resolution_m, float scale,
                   const VoxelBox& box, std::span<float> values);

// Sum of all structures, one value per voxel of the grid.
[[nodiscard]] std::vector<float> simulated_map(const DensityGrid& grid,
                                               std::span<const PlacedStructure> placed, double resolution_m);

}  // namespace tact
