// A surface of a scene's map at another level than the scene's own: a file of sections CONT and MESH,
// written by `tact-prep contour`.
#pragma once

#include <memory>

#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

struct ContourOrigin {
    std::uint64_t scene_checksum;  // of the scene that contains the map
    double level;                  // in the map's unit
    friend bool operator==(const ContourOrigin&, const ContourOrigin&) = default;
};

void write_contour(SceneWriter& out, const ContourOrigin& origin, const ProgressiveMeshData& mesh);
// Throws StartupError for damage, or a file of another scene or level.
std::unique_ptr<ProgressiveMesh> read_contour(const SceneFile& file, const ContourOrigin& expected);

}  // namespace tact
