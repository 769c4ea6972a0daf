// A mesh becomes a tool to touch with: points spread evenly over its surface, and its picture.
//
// Order     each point is the place of the surface that is farthest from all before it (Gonzalez 1985), among
//           some 16 candidates a point: places spread by area, and the mesh's own vertices. Sharp corners and
//           tips count for half as far again, so that they are among the first.
// Balls     a point lies below the surface by the radius of its ball, along the normal of its place; at a
//           corner along the mean of the facets, until none of them is pierced (by 2 radii at the most). Places
//           beside an edge whose ball would stick out are taken last.
// Grip      the hand's point: the middle of the surface, by area, or the mesh's origin
// Fails by  StartupError on a mesh without area, or wider than what a scene takes; Cancelled from progress
// Repeats   the same mesh gives the same points.  Thread  any but the servo's.
#pragma once

#include <cstdint>

#include "ipc/base/progress.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"
#include "ipc/scene/mesh/touch_tool.hpp"

namespace tact {

struct ToolSampling {
    std::uint32_t points = 1000;             // at the most: a mesh may have fewer places
    bool grip_in_middle = true;              // false: at its origin
    double ball_share = 0.002;               // radius of a ball, of the farthest point's way from the hand's
    std::uint32_t drawn_triangles = 20'000;  // of the picture, about
};

// mesh: metres of the scene's model, axes as the hand's; clean (clean_mesh.hpp).
TouchTool sample_tool(TriangleMesh mesh, const ToolSampling& sampling, const Progress& progress = {});

}  // namespace tact
