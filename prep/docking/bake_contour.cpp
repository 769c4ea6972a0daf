#include "prep/docking/bake_contour.hpp"

#include <cstdio>
#include <string>

#include "ipc/base/error.hpp"
#include "ipc/scene/density/contour_mesh.hpp"
#include "ipc/scene/density/isosurface.hpp"
#include "prep/mesh/progressive.hpp"

namespace tact {
namespace {

std::string text_of(double level) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", level);
    return text;
}

}  // namespace

BakedContour bake_contour(const SceneFile& scene, double level, std::uint32_t vertices_max, SceneWriter& out,
                          const Progress& progress) {
    TriangleMesh surface = isosurface(read_grid(scene), level, part(progress, 0.0, 0.1));
    if (surface.triangles() == 0)
        throw StartupError("bake a contour of " + scene.name(),
                           "no surface lies at the level " + text_of(level), "give another --level");
    BakedContour baked;
    baked.vertices_found = surface.vertices();
    if (vertices_max > 0 && surface.vertices() > vertices_max) {
        SimplifySettings settings;
        settings.vertices_min = vertices_max;
        surface = simplify(surface, settings, part(progress, 0.1, 0.5)).mesh;
    }
    const ProgressiveMeshData mesh = make_progressive(surface, {}, part(progress, 0.5, 0.98));
    baked.vertices = static_cast<std::uint32_t>(mesh.vertex.size());
    baked.vertices_min = mesh.base_vertices;
    baked.triangles = static_cast<std::uint32_t>(mesh.triangle.size() / 3);
    write_contour(out, {scene.checksum(), level}, mesh);
    return baked;
}

}  // namespace tact
