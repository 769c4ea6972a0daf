// A tool for touch: a rigid body with contact at sampled points.
//
// Section   TOOL, at most one per scene: header, points (3 float), normals (2 int16, octahedral), parents
//           (u32), covers (float), then the triangles for drawing: positions (3 float per vertex), corners
//           (3 u32)
// Points    centres of spheres of radius ball_m that touch the tool's surface from inside, ordered so that
//           the first n are an even sampling for every n
// Parent    the nearest of the earlier points; the first point is its own parent
// Cover     of the first i + 1 points: no point of the tool's surface is farther from the nearest of them
// Frame     tool: origin at the hand's point, axes of the hand; metres of the scene's model
// Errors    StartupError: read_touch_tool() checks every count, index and number
// Thread    any but the servo's
#pragma once

#include <cstdint>
#include <vector>

#include "ipc/scene/file/scene_file.hpp"
#include "ipc/scene/mesh/surface_mesh.hpp"

namespace tact {

struct TouchTool {
    static constexpr SectionTag kTag{'T', 'O', 'O', 'L'};
    static constexpr std::uint32_t kVersion = 1;
    static constexpr std::uint32_t kPointsMax = 10'000;
    static constexpr std::uint32_t kDrawnMax = 100'000;  // triangles, and vertices

    double ball_m = 0.0;                // > 0
    std::vector<float> point_m;         // 3 per point
    std::vector<OctNormal> normal;      // 1 per point, outward
    std::vector<std::uint32_t> parent;  // 1 per point
    std::vector<float> cover_m;         // 1 per point, never increasing
    std::vector<float> drawn_m;         // 3 per vertex
    std::vector<std::uint32_t> drawn;   // 3 corners per triangle, counter-clockwise as viewed from outside

    [[nodiscard]] std::size_t points() const { return parent.size(); }
    [[nodiscard]] Vec3 at_m(std::size_t i) const {
        const float* const p = point_m.data() + 3 * i;
        return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
    }
};

void write_touch_tool(SceneWriter& out, const TouchTool& tool);
[[nodiscard]] inline bool has_touch_tool(const SceneFile& file) { return file.count(TouchTool::kTag) > 0; }
TouchTool read_touch_tool(const SceneFile& file);

}  // namespace tact
