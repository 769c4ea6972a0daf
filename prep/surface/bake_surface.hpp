// Bakes a scene with a surface to touch: the surface at full resolution, the drawn mesh, and the transform from model
// to hand space.
//
// Forest    FRST covers the same triangles as SURF in the same order, so that the resolution can follow the tool. The
//           vertices are numbered as the leaves of the forest and stored once.
// Place     the mesh's diagonal is size_m long in hand space. Its top (the largest y) lies kBelowM below the centre of
//           the workspace, and below a tool there, so that a hand at rest is outside.
// Tool      in the scale of the mesh, or with a diagonal of tool_size_m in hand space
// Fails by  StartupError; Cancelled when `progress` returns false. Writes no file.
// Repeats   the same input gives the same sections.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ipc/base/progress.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"
#include "prep/surface/forest_builder.hpp"
#include "prep/surface/sample_tool.hpp"

namespace tact {

struct SurfaceInput {
    static constexpr double kBelowM = 0.01;
    std::string title;
    TriangleMesh mesh;              // metres, y up, counter-clockwise seen from outside
    std::vector<std::string> note;  // lines "key: value"
    double size_m = 0.15;
    bool forest = true;                    // false: the surface can only be touched at full resolution
    bool compare_locality = false;         // also builds the forest without locality, for comparison
    bool picture = true;                   // false: no drawn mesh, for measurements
    std::uint32_t vertices_max = 500'000;  // of the drawn mesh; 0: no limit
    TriangleMesh tool;                     // metres, axes of the hand; empty: none
    ToolSampling tool_sampling;
    double tool_size_m = 0.0;  // 0: in the scale of the mesh
};

struct BakedSurface {
    SceneMeta meta{};
    std::string note;
    std::size_t vertices = 0, triangles = 0;
    std::uint32_t display_vertices = 0;
    std::size_t tool_points = 0;
    bool tool_too_large = false;  // it reaches farther than the mesh is long
    bool closed = false;
    double build_s = 0.0;             // time for surface and tree
    double forest_s = 0.0;            // time for the forest; 0: none
    double bytes_per_triangle = 0.0;  // of all data that the controller maps
    std::optional<ForestShape> shape, shape_without_locality;
};

BakedSurface bake_surface(SurfaceInput&& input, SceneWriter& out, const Progress& progress = {});

}  // namespace tact
