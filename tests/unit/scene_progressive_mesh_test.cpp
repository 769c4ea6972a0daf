// Section MESH: data reads back unchanged; damaged data is refused or harmless.
#include "ipc/scene/mesh/progressive_mesh.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>

#include "ipc/base/error.hpp"
#include "ipc/scene/density/isosurface.hpp"
#include "ipc/scene/mesh/mesh_cut.hpp"
#include "prep/mesh/progressive.hpp"
#include "tests/unit/prep_mesh_fixtures.hpp"

namespace tact::test::scene_progressive_mesh_test {
namespace {

ProgressiveMeshData small_data() { return make_progressive(isosurface(sampled(13, torus), -0.25)); }

TEST(ProgressiveMesh, reads_back_from_a_file_unchanged) {
    const ProgressiveMeshData data = small_data();
    SceneWriter out;
    write_mesh(out, 0, data);
    const std::vector<std::byte> bytes = out.to_bytes();
    const ProgressiveMeshData back = read_mesh_data(SceneFile::from_bytes(bytes, "torus"), 0);
    EXPECT_EQ(back.vertex, data.vertex);
    EXPECT_EQ(back.merged, data.merged);
    EXPECT_EQ(back.parent, data.parent);
    EXPECT_EQ(back.error_m, data.error_m);
    EXPECT_EQ(back.triangle, data.triangle);
    EXPECT_EQ(back.triangle_count, data.triangle_count);
}

// Accepted data can be traversed; the sanitizers check the access.
void check(const MeshCut& cut) {
    for (const MeshRange draw : cut.draws())
        for (const std::uint32_t v : cut.index().subspan(draw.first, draw.count))
            ASSERT_LT(v, cut.vertices());
}
void read_and_walk(const ProgressiveMeshData& data) {
    SceneWriter out;
    write_mesh(out, 0, data);
    const std::vector<std::byte> bytes = out.to_bytes();
    const ProgressiveMesh mesh = read_mesh(SceneFile::from_bytes(bytes, "hostile"), 0);
    MeshCut cut(mesh);
    for (std::uint32_t level = mesh.vertices_min(); level < mesh.vertices(); level += 3)
        cut.set_vertices(level);
    cut.set_vertices(mesh.vertices_min());
    check(cut);
    cut.set_vertices(mesh.vertices() / 2);
    check(cut);
}

TEST(ProgressiveMesh, refuses_each_kind_of_damage) {
    const ProgressiveMeshData good = small_data();
    ASSERT_NO_THROW(read_and_walk(good));
    const auto damaged = [&](auto&& damage) {
        ProgressiveMeshData bad = good;
        damage(bad);
        EXPECT_THROW(read_and_walk(bad), StartupError);
    };
    damaged([](ProgressiveMeshData& d) { d.parent[3] = d.base_vertices + 3; });
    damaged([](ProgressiveMeshData& d) { d.parent.back() = UINT32_MAX; });
    damaged([](ProgressiveMeshData& d) { d.triangle[5] = static_cast<std::uint32_t>(d.vertex.size()); });
    damaged([](ProgressiveMeshData& d) { d.triangle[1] = d.triangle[0]; });
    damaged([](ProgressiveMeshData& d) { d.triangle_count[2] = UINT32_MAX; });
    damaged([](ProgressiveMeshData& d) { d.triangle_count.back() -= 1; });
    damaged([](ProgressiveMeshData& d) { d.triangle_count.front() = d.triangle_count.back(); });
    // Removed one level before its corners meet.
    damaged([](ProgressiveMeshData& d) {
        const auto last = static_cast<std::ptrdiff_t>(d.triangle_count.size() - 1);
        const auto begin = d.triangle_count.begin();
        *std::lower_bound(begin, begin + last, d.triangle_count.back()) -= 1;
    });
    damaged([](ProgressiveMeshData& d) { d.error_m[1] = std::nanf(""); });
    damaged([](ProgressiveMeshData& d) { d.error_m.back() = 1e30F; });
    damaged(
        [](ProgressiveMeshData& d) { d.vertex[0].position_m[1] = std::numeric_limits<float>::infinity(); });
    damaged([](ProgressiveMeshData& d) { d.merged[0].position_m[1] = std::nanf(""); });
    damaged([](ProgressiveMeshData& d) { d.base_vertices = 0; });
    damaged([](ProgressiveMeshData& d) { d.base_vertices = UINT32_MAX; });
    damaged([](ProgressiveMeshData& d) { d.parent.pop_back(); });
    damaged([](ProgressiveMeshData& d) { d.triangle.pop_back(); });
}

TEST(ProgressiveMesh, random_damage_is_refused_or_harmless) {
    const ProgressiveMeshData good = small_data();
    rc::check([&] {
        ProgressiveMeshData bad = good;
        const auto hits = *rc::gen::inRange(1, 6);
        for (int i = 0; i < hits; ++i) {
            const auto value =
                *rc::gen::inRange<std::uint32_t>(0, static_cast<std::uint32_t>(good.vertex.size()) + 2);
            const auto at = *rc::gen::inRange<std::size_t>(0, 1U << 20);
            switch (*rc::gen::inRange(0, 4)) {
                case 0:
                    bad.parent[at % bad.parent.size()] = value;
                    break;
                case 1:
                    bad.triangle[at % bad.triangle.size()] = value;
                    break;
                case 2:
                    bad.triangle_count[at % bad.triangle_count.size()] = value;
                    break;
                default:
                    bad.base_vertices = value;
                    break;
            }
        }
        try {
            read_and_walk(bad);
        } catch (const StartupError&) {
        }
    });
}

TEST(ProgressiveMesh, chains_with_quadratic_cost_are_refused) {
    // A chain: each vertex merges into the one before it, and each triangle uses the end of the chain.
    ProgressiveMeshData d;
    const std::uint32_t n = 20000;
    d.base_vertices = 3;
    d.vertex.assign(n, MeshVertex{{0.0F, 0.0F, 0.0F}, {0, 0, 32767, 0}});
    for (std::uint32_t v = 3; v < n; ++v) d.parent.push_back(v - 1);
    d.merged.assign(n - 3, d.vertex[0]);
    d.error_m.assign(n - 2, 0.0F);
    for (std::uint32_t t = 0; t < 20000; ++t) d.triangle.insert(d.triangle.end(), {0, 1, n - 1});
    d.triangle_count.assign(n - 2, 20000);
    EXPECT_THROW(ProgressiveMesh{d}, StartupError);
}

}  // namespace
}  // namespace tact::test::scene_progressive_mesh_test
