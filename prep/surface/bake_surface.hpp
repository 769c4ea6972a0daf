// Puts a scene to touch together: the surface at full resolution, its picture, and how the hand's world maps
// onto it.
//
// Forest    with SURF, FRST: the same triangles in the same order, so that how fine the surface is may follow the
//           tool. Its vertices are then numbered as the leaves of the forest, and are stored once.
// Place     the mesh's diagonal is size_m wide in the hand's world, and its top (the largest y) lies kBelowM
//           below the middle of the hand's space, and of a tool there, so that a hand at rest is outside.
// Tool      as large against the mesh as it is, or tool_size_m wide in the hand's world (its diagonal)
// Fails by  StartupError; Cancelled when `progress` returns false. Nothing is written here.
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
    bool forest = true;                    // false: the surface can be touched at full resolution alone
    bool compare_locality = false;         // the forest is also built without locality, to see what that does
    bool picture = true;                   // false: nothing to look at, for measurements
    std::uint32_t vertices_max = 500'000;  // of the picture; 0: all
    TriangleMesh tool;                     // metres, axes as the hand's; empty: none
    ToolSampling tool_sampling;
    double tool_size_m = 0.0;  // 0: as large as it is
};

struct BakedSurface {
    SceneMeta meta{};
    std::string note;
    std::size_t vertices = 0, triangles = 0;
    std::uint32_t picture_vertices = 0;
    std::size_t tool_points = 0;
    bool closed = false;
    double build_s = 0.0;             // of surface and tree
    double forest_s = 0.0;            // of the forest; 0: none
    double bytes_per_triangle = 0.0;  // of all that the controller maps
    std::optional<ForestShape> shape, shape_without_locality;
};

BakedSurface bake_surface(SurfaceInput&& input, SceneWriter& out, const Progress& progress = {});

}  // namespace tact
