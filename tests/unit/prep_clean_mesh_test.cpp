// Cleaning: defects are removed and counted, and the rest is unchanged.
#include <gtest/gtest.h>

#include <limits>

#include "ipc/base/error.hpp"
#include "prep/surface/clean_mesh.hpp"
#include "tests/unit/prep_mesh_fixtures.hpp"

namespace tact::prep_clean_mesh_test {
namespace {

// A square of two triangles, vertices 0 to 3.
TriangleMesh square() { return {{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, {0, 1, 2, 0, 2, 3}}; }

void add_vertex(TriangleMesh& mesh, float x, float y, float z) {
    mesh.position_m.insert(mesh.position_m.end(), {x, y, z});
}

TEST(CleanMesh, a_clean_mesh_is_unchanged) {
    const TriangleMesh sheet = test::sheet(20, [](float x, float y) { return x * y; });
    TriangleMesh mesh = sheet;
    const CleanReport done = clean_mesh(mesh);
    EXPECT_FALSE(done.changed());
    EXPECT_EQ(done.words(), "nothing to clean");
    EXPECT_EQ(mesh.position_m, sheet.position_m);
    EXPECT_EQ(mesh.triangle, sheet.triangle);
}

TEST(CleanMesh, each_kind_of_defect_is_dropped_and_counted) {
    TriangleMesh mesh = square();
    add_vertex(mesh, -0.0F, 0.0F, -0.0F);       // 4: equals vertex 0
    add_vertex(mesh, 9.0F, 9.0F, 9.0F);         // 5: unused
    add_vertex(mesh, 2.0F, 0.0F, 0.0F);         // 6: on a line with 0 and 1
    for (const std::uint32_t v : {3U, 4U, 2U,   // triangle 1 again, rotated and reversed
                                  0U, 1U, 0U,   // a repeated corner
                                  4U, 0U, 2U,   // the same after merging 4 into 0
                                  0U, 1U, 6U})  // no area
        mesh.triangle.push_back(v);
    const CleanReport done = clean_mesh(mesh);
    EXPECT_EQ(done.merged_vertices, 1U);
    EXPECT_EQ(done.repeated_triangles, 1U);
    EXPECT_EQ(done.repeated_corners, 2U);
    EXPECT_EQ(done.zero_area, 1U);
    EXPECT_EQ(done.unused_vertices, 2U);
    EXPECT_EQ(mesh.position_m, square().position_m);
    EXPECT_EQ(mesh.triangle, square().triangle);
    EXPECT_EQ(done.words(),
              "merged 1 vertex, dropped 2 triangles with a repeated corner, dropped 1 triangle without area, "
              "dropped 1 triangle given twice, dropped 2 unused vertices");
    EXPECT_EQ(done.json(),
              "{\"vertices_in\":7,\"triangles_in\":6,\"merged_vertices\":1,\"repeated_corners\":2,"
              "\"zero_area\":1,\"repeated_triangles\":1,\"unused_vertices\":2,\"vertices\":4,"
              "\"triangles\":2}");
}

TEST(CleanMesh, a_torn_sheet_is_welded) {
    const TriangleMesh whole = test::sheet(12, [](float x, float y) { return 0.3F * x * y; });
    TriangleMesh torn;  // three vertices per triangle
    for (const std::uint32_t v : whole.triangle) {
        add_vertex(torn, whole.position_m[3 * v], whole.position_m[3 * v + 1], whole.position_m[3 * v + 2]);
        torn.triangle.push_back(static_cast<std::uint32_t>(torn.triangle.size()));
    }
    TriangleMesh shaken = torn;
    for (std::size_t i = 0; i < shaken.position_m.size(); ++i)
        shaken.position_m[i] += 1e-4F * static_cast<float>(i * 7 % 11);
    clean_mesh(torn);
    EXPECT_EQ(torn.vertices(), whole.vertices());
    EXPECT_EQ(test::topology(torn).border_edges, 48U);
    TriangleMesh exact = shaken;
    clean_mesh(exact);
    EXPECT_GT(exact.vertices(), 2 * whole.vertices());
    clean_mesh(shaken, 4e-3);  // larger than the largest displacement of two equal vertices
    EXPECT_EQ(shaken.vertices(), whole.vertices());
    EXPECT_EQ(test::topology(shaken).border_edges, 48U);
}

TEST(CleanMesh, open_and_tangled_meshes_are_accepted) {
    TriangleMesh book = square();  // three pages at edge 0 2
    add_vertex(book, 0.0F, 0.0F, 1.0F);
    book.triangle.insert(book.triangle.end(), {0, 2, 4});
    EXPECT_FALSE(clean_mesh(book).changed());
}

TEST(CleanMesh, irreparable_meshes_are_refused) {
    TriangleMesh out_of_range = square();
    out_of_range.triangle[4] = 4;
    EXPECT_THROW(clean_mesh(out_of_range), StartupError);
    TriangleMesh lost = square();
    lost.position_m[7] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(clean_mesh(lost), StartupError);
    TriangleMesh flat{{0, 0, 0, 1, 0, 0, 2, 0, 0}, {0, 1, 2}};
    EXPECT_THROW(clean_mesh(flat), StartupError);
    TriangleMesh empty;
    EXPECT_THROW(clean_mesh(empty), StartupError);
    TriangleMesh mesh = square();
    EXPECT_THROW(clean_mesh(mesh, -1.0), StartupError);
}

}  // namespace
}  // namespace tact::prep_clean_mesh_test
