// Converts a mesh to a tool: points spread evenly over its surface, and the drawn mesh.
//
// Order     each point is the candidate farthest from all earlier points (Gonzalez 1985); about 16 candidates per
//           point, spread by area, and the vertices of the mesh. The distance of sharp corners and tips counts 1.5 times, so
//           that they are among the first points.
// Balls     each point lies below the surface by the radius of its ball, along the normal of its place; at a corner,
//           along the mean normal until the ball pierces no facet (at most 2 radii). Places beside an edge whose ball
//           would stick out are taken last.
// Grip      the origin of the tool: the area-weighted centre of the surface, or the mesh's origin
// Fails by  StartupError on a mesh without area, or wider than a scene permits; Cancelled from progress
// Repeats   the same mesh gives the same points.  Thread  any but the servo's.
#pragma once

#include <cstdint>

#include "ipc/base/progress.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"
#include "ipc/scene/mesh/touch_tool.hpp"

namespace tact {

struct ToolSampling {
    std::uint32_t points = 1000;  // maximum; a mesh may have fewer different places
    bool grip_in_middle = true;   // false: at the mesh's origin
    double ball_share = 0.002;    // ball radius relative to the distance of the farthest point from the grip
    std::uint32_t drawn_triangles = 20'000;  // of the drawn mesh, approximately
};

// mesh: metres in the scene's model frame, axes of the hand; cleaned (clean_mesh.hpp).
TouchTool sample_tool(TriangleMesh mesh, const ToolSampling& sampling, const Progress& progress = {});

}  // namespace tact
