// Repairs a mesh before it is baked for touching, and says what it did.
//
// Done      in this order: equal vertices become one, with a tolerance near ones too (a vertex goes to the
//           first one before it that lies within the tolerance, itself not moved); triangles with a repeated
//           corner go; triangles without area (of the square of the longest side less than 1e-10); triangles
//           with the corners of an earlier one, whichever way round; vertices that no triangle uses.
// Kept      the order of vertices and triangles, and positions. Open meshes and edges with more than two
//           triangles are taken as they are. Dropping a triangle may open the surface where it was.
// Memory    24 bytes a vertex and 8 a triangle besides the mesh; time in proportion.
// Thread    any but the servo's.
// Fails by  StartupError on an index out of range, a number that is not finite, or when no triangle is left.
#pragma once

#include <cstdint>
#include <string>

#include "ipc/base/progress.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

struct CleanReport {
    std::uint64_t vertices_in = 0, triangles_in = 0;
    std::uint64_t merged_vertices = 0;   // went into another one
    std::uint64_t repeated_corners = 0;  // triangles
    std::uint64_t zero_area = 0;         // triangles
    std::uint64_t repeated_triangles = 0;
    std::uint64_t unused_vertices = 0;
    std::uint64_t vertices = 0, triangles = 0;  // that are left

    [[nodiscard]] bool changed() const { return vertices != vertices_in || triangles != triangles_in; }
    [[nodiscard]] std::string words() const;  // "merged 12 vertices, dropped 3 triangles without area"
    [[nodiscard]] std::string json() const;   // one object, the names above as keys
};

// tolerance: in the units of the mesh; 0 joins equal positions alone.
CleanReport clean_mesh(TriangleMesh& mesh, double tolerance = 0.0, const Progress& progress = {});

}  // namespace tact
