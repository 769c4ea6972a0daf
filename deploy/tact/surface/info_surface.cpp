#include "deploy/tact/surface/surface.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"
#include "ipc/scene/mesh/surface_mesh.hpp"
#include "ipc/scene/mesh/touch_tool.hpp"
#include "ipc/scene/mesh/vertex_forest.hpp"

namespace tact::launch {
namespace {

using nlohmann::json;

constexpr SectionTag kForest{'F', 'R', 'S', 'T'}, kPicture{'M', 'E', 'S', 'H'};
constexpr std::uint32_t kForestVersion = 1;

constexpr const char* kFormulas[] = {
    "x_world = world_per_model * (x_model - centre_model_m); axes parallel, metres",
    "the tool is a ball of radius r (a point: 4 um) around the hand g; its centre c follows g until the ball "
    "meets triangles",
    "F = stiffness * (c - g) at rest, without friction and shading; world, N",
    "friction: c stays in place within friction * p of its frictionless position x along the surface, p = |x "
    "- g|; friction: the static coefficient, while c slides (until it has rested for 20 ms) the dynamic one",
    "shading: + stiffness * sum w_i s_i (N_i - n_i), n_i the contact normals that hold x with weights w_i, "
    "N_i the normal interpolated there, s_i from 1 to 0 for angles of 20 to 40 degrees between them",
    "stiffness, friction, radius, damping and the force limit are settings of the controller, not of the "
    "scene",
};

json vec(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

json surface_info(const SceneFile& file) {
    const SceneMeta m = read_meta(file);
    const SurfaceMesh mesh = read_surface(file);
    const auto triangles = static_cast<double>(mesh.triangles());
    const std::size_t arrays = mesh.vertices() * (3 * sizeof(float) + sizeof(OctNormal)) +
                               mesh.triangles() * 3 * sizeof(std::uint32_t);
    std::size_t bytes = mesh.bytes();
    json forest = nullptr;
    if (file.count(kForest) > 0) {
        const VertexForest f = read_forest(file, mesh.all_positions_m(), mesh.all_corners());
        const std::size_t size = file.section(kForest, kForestVersion).size();
        bytes += size;
        forest = {{"trees", f.roots()},
                  {"nodes", f.nodes()},
                  {"triangles_always", f.triangles_always().size()},
                  {"bytes", size}};
    }
    json tool = nullptr;
    if (file.count(TouchTool::kTag) > 0) tool = {{"points", read_touch_tool(file).points()}};
    return {
        {"world_per_model", m.world_per_model},
        {"centre_model_m", {m.centre_model_m[0], m.centre_model_m[1], m.centre_model_m[2]}},
        {"diagonal_world_m", m.world_per_model * (mesh.high_m() - mesh.low_m()).norm()},
        {"mesh",
         {{"vertices", mesh.vertices()},
          {"triangles", mesh.triangles()},
          {"closed", mesh.closed()},
          {"low_model_m", vec(mesh.low_m())},
          {"high_model_m", vec(mesh.high_m())},
          {"bytes", arrays}}},
        {"tree", {{"bytes", mesh.bytes() - std::min(arrays, mesh.bytes())}}},
        {"forest", forest},
        {"bytes_per_triangle", static_cast<double>(bytes) / triangles},
        {"display_vertices", file.count(kPicture) > 0 ? json(read_mesh(file, 0).vertices()) : json(nullptr)},
        {"tool", tool},
        {"formulas", kFormulas}};
}

}  // namespace tact::launch
