// Saves placed bodies: each as a structure file in the map's frame with its matrix, and a table of all.
//
//   NAME-bodyID.pdb or .cif     the original file with its atoms moved and the fit in its remarks
//   NAME-bodyID.matrix.txt      3x4 matrix from the file's coordinates to the placed ones, in ångström; axis, angle
//   NAME-bodyID.residues.csv    with `residues`: the fit of each residue (residue_column.hpp)
//   bodies.csv                  a row for each body: matrix, axis, angle, fit
//   combined.pdb or .cif        with `combined`: all bodies in one file, with a unique id per chain
//
// Reads     the files from which the scene was baked; they must be unchanged.
// Never     overwrites one of these files, nor, without `force`, any other file. Checks this before it writes.
// Fails by  StartupError.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "prep/export/poses_file.hpp"

namespace tact {

struct ExportOptions {
    std::filesystem::path folder;  // created if absent
    bool combined = false;
    bool force = false;
    std::optional<double>
        contour{};     // that the fractions inside refer to, in the map's unit; none: the scene's
    int residues = 0;  // window of the correlation of residues, an odd number of them; 0: none is computed
    bool b_column = false;  // that correlation also replaces the B values
    std::optional<DensityGrid>
        local_resolution{};  // angstrom, by a program for it; its means are added to the table of residues
};

// Returns the files written, in order.
std::vector<std::filesystem::path> export_bodies(const SceneFile& scene,
                                                 const std::vector<PlacedBody>& bodies,
                                                 const ExportOptions& options);

}  // namespace tact
