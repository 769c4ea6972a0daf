// Repairs a mesh before it is baked as a surface to touch, and reports the repairs.
//
// Done      in this order: equal vertices are merged, with a tolerance near ones too (a vertex is replaced by the first
//           kept vertex within the tolerance); triangles with a repeated corner are dropped; triangles without area
//           (less than 1e-10 of the square of the longest side); triangles with the corners of an earlier one, in any
//           order; vertices that no triangle uses.
// Kept      order of vertices and triangles, and positions. Open meshes and edges with more than two triangles are
//           accepted. Dropping a triangle may open the surface.
// Memory    24 bytes per vertex and 8 per triangle in addition to the mesh; linear time.
// Thread    any but the servo's.
// Fails by  StartupError on an index out of range, a number that is not finite, or if no triangle is left.
#pragma once

#include <cstdint>
#include <string>

#include "ipc/base/progress.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

struct CleanReport {
    std::uint64_t vertices_in = 0, triangles_in = 0;
    std::uint64_t merged_vertices = 0;   // merged into another vertex
    std::uint64_t repeated_corners = 0;  // triangles
    std::uint64_t zero_area = 0;         // triangles
    std::uint64_t repeated_triangles = 0;
    std::uint64_t unused_vertices = 0;
    std::uint64_t vertices = 0, triangles = 0;  // remaining

    [[nodiscard]] bool changed() const { return vertices != vertices_in || triangles != triangles_in; }
    [[nodiscard]] std::string words() const;  // "merged 12 vertices, dropped 3 triangles without area"
    [[nodiscard]] std::string json() const;   // one object, the names above as keys
};

// tolerance: in the units of the mesh; 0 merges only equal positions.
CleanReport clean_mesh(TriangleMesh& mesh, double tolerance = 0.0, const Progress& progress = {});

}  // namespace tact
