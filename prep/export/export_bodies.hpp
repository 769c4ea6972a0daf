// Saves placed bodies: each as a structure file of its own in the map's frame, with its matrix, and all in a
// table.
//
//   NAME-bodyID.pdb or .cif     the original file with its atoms moved, the fit in its remarks
//   NAME-bodyID.matrix.txt      3x4 matrix that takes the file's coordinates there, in ångström; axis, angle
//   bodies.csv                  a row for each body: matrix, axis, angle, fit
//   combined.pdb or .cif        with `combined`: all bodies in one, every chain with an id of its own
//
// Reads     the files that the scene was baked from, which must be as they were then.
// Never     overwrites one of those; nor, without `force`, any other file. Refuses before it writes.
// Fails by  StartupError.
#pragma once

#include <filesystem>
#include <vector>

#include "ipc/scene/file/scene_file.hpp"
#include "prep/export/poses_file.hpp"

namespace tact {

struct ExportOptions {
    std::filesystem::path folder;  // is made where it is not there
    bool combined = false;
    bool force = false;
};

// What was written, in order.
std::vector<std::filesystem::path> export_bodies(const SceneFile& scene,
                                                 const std::vector<PlacedBody>& bodies,
                                                 const ExportOptions& options);

}  // namespace tact
