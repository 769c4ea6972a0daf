#include "prep/surface/report_surface.hpp"

#include <nlohmann/json.hpp>

#include "ipc/scene/mesh/surface_mesh.hpp"

namespace tact {

void report_surface(const SceneFile& file, nlohmann::ordered_json& json) {
    const SurfaceMesh surface = read_surface(file);
    json["surface"] = {{"vertices", surface.vertices()},
                       {"triangles", surface.triangles()},
                       {"closed", surface.closed()},
                       {"bytes", surface.bytes()}};
}

}  // namespace tact
