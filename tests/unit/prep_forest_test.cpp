// The forest of a surface: the reader accepts the built forest, and any cut of it is the surface.
#include <gtest/gtest.h>

#include <cstring>

#include "ipc/base/error.hpp"
#include "prep/surface/forest_builder.hpp"
#include "prep/synthetic/rough_torus.hpp"
#include "tests/unit/prep_mesh_fixtures.hpp"

namespace tact::prep_forest_test {
namespace {

TriangleMesh two_spheres_and_a_sheet() {
    TriangleMesh all = test::sheet(9, [](float x, float y) { return 0.2F * x * y; });
    for (const float x : {3.0F, -2.0F}) {
        const TriangleMesh torus = rough_torus(16, 8);
        const auto first = static_cast<std::uint32_t>(all.vertices());
        for (std::size_t i = 0; i < torus.position_m.size(); ++i)
            all.position_m.push_back(torus.position_m[i] + (i % 3 == 0 ? x : 0.0F));
        for (const std::uint32_t v : torus.triangle) all.triangle.push_back(first + v);
    }
    return all;
}

TEST(VertexForest, every_triangle_appears_once_and_the_reach_of_nodes_covers_their_triangles) {
    const TriangleMesh before = two_spheres_and_a_sheet();
    TriangleMesh mesh = before;
    const BuiltForest built = build_forest(mesh);
    const VertexForest forest = view_forest(built.data, mesh.position_m, mesh.triangle);  // also validates
    EXPECT_GE(forest.roots(), 3U);
    EXPECT_LT(forest.roots(), 60U);
    for (std::size_t v = 0; v < mesh.vertices(); ++v)
        for (std::size_t i = 0; i < 3; ++i)
            ASSERT_EQ(mesh.position_m[3 * v + i], before.position_m[3 * std::size_t{built.order[v]} + i]);
    for (std::size_t i = 0; i < mesh.triangle.size(); ++i)
        ASSERT_EQ(built.order[mesh.triangle[i]], before.triangle[i]);
    // Brute force: a box of `reach` around a node contains each corner of each triangle at its leaves.
    std::vector<VertexForest::Branch> stack;
    for (std::uint32_t r = 0; r < forest.roots(); ++r) stack.push_back(forest.root(r));
    while (!stack.empty()) {
        const VertexForest::Branch b = stack.back();
        stack.pop_back();
        if (b.is_leaf()) continue;
        const ForestNode& node = forest.node(b.node);
        for (std::uint32_t t = 0; t < forest.triangles(); ++t) {
            const std::span corner = std::span(mesh.triangle).subspan(3 * std::size_t{t}, 3);
            if (std::none_of(corner.begin(), corner.end(),
                             [&](std::uint32_t v) { return v >= b.first && v < b.end; }))
                continue;
            for (const std::uint32_t v : corner)
                for (std::size_t i = 0; i < 3; ++i)
                    ASSERT_LE(std::abs(forest.leaf_position_m(v)[i] - node.position_m[i]), node.reach_m);
        }
        stack.push_back(forest.child(b, 0));
        stack.push_back(forest.child(b, 1));
    }
}

// True if `to` must be split before `from`.
bool brings(const VertexForest& forest, std::uint32_t from, std::uint32_t to) {
    std::vector<bool> seen(forest.nodes());
    std::vector<std::uint32_t> stack{from};
    const auto look_at = [&](std::uint32_t n) {
        if (n == kNoForestNode || seen[n]) return;
        seen[n] = true;
        stack.push_back(n);
    };
    while (!stack.empty() && !seen[to]) {
        const std::uint32_t n = stack.back();
        stack.pop_back();
        look_at(forest.node(n).parent);
        for (const std::uint32_t need : forest.needs_of(n)) look_at(need);
    }
    return seen[to];
}

TEST(VertexForest, needs_follow_the_numbers_without_redundant_entries) {
    TriangleMesh mesh = two_spheres_and_a_sheet();
    const BuiltForest built = build_forest(mesh);
    const VertexForest forest = view_forest(built.data, mesh.position_m, mesh.triangle);
    std::vector<std::uint32_t> parent(forest.leaves(), kNoForestNode);
    for (std::uint32_t n = 0; n < forest.nodes(); ++n) {
        if (forest.node(n).first_is_leaf()) parent[forest.node(n).first] = n;
        if (forest.node(n).second_is_leaf()) parent[forest.node(n).middle] = n;
    }
    // Along both sides of each mesh edge: a merge happened next to the result of the previous merge.
    const auto number = [&](std::uint32_t n) {
        return n == kNoForestNode ? UINT32_MAX : forest.node(n).number;
    };
    std::size_t needed = 0;
    for (std::size_t i = 0; i < mesh.triangle.size(); ++i) {
        std::uint32_t a = parent[mesh.triangle[i]], b = parent[mesh.triangle[i - i % 3 + (i + 1) % 3]];
        while (a != b) {
            if (number(a) > number(b)) std::swap(a, b);
            if (b != kNoForestNode) {
                EXPECT_TRUE(brings(forest, a, b)) << a << " without " << b;
                ++needed;
            }
            a = forest.node(a).parent;
        }
    }
    EXPECT_GT(needed, 1000U);
    for (std::uint32_t n = 0; n < forest.nodes(); ++n) {
        for (const std::uint32_t need : forest.needs_of(n)) {
            const std::uint32_t up = forest.node(n).parent;
            EXPECT_FALSE(up != kNoForestNode && brings(forest, up, need));
            for (const std::uint32_t other : forest.needs_of(n)) {
                EXPECT_FALSE(other != need && brings(forest, other, need)) << n << ": " << need;
            }
        }
    }
}

TEST(VertexForest, builds_a_flat_fan_of_many_triangles) {  // one vertex takes part in every merge
    TriangleMesh fan{{0, 0, 0}, {}};
    constexpr std::uint32_t kBlades = 2000;
    for (std::uint32_t i = 0; i < kBlades; ++i) {
        const float angle = 6.2831853F * static_cast<float>(i) / kBlades;
        fan.position_m.insert(fan.position_m.end(), {std::cos(angle), std::sin(angle), 0.0F});
        fan.triangle.insert(fan.triangle.end(), {0, 1 + i, 1 + (i + 1) % kBlades});
    }
    const BuiltForest built = build_forest(fan);
    const VertexForest forest = view_forest(built.data, fan.position_m, fan.triangle);
    EXPECT_LT(forest.roots(), 10U);
}

TEST(VertexForest, is_local_on_request) {
    const auto shape = [](double locality) {
        TriangleMesh mesh = test::sheet(
            60, [](float, float) { return 0.0F; });  // no geometric error, so only locality decides
        const BuiltForest built = build_forest(mesh, {.locality = locality});
        return shape_of(view_forest(built.data, mesh.position_m, mesh.triangle), mesh.triangle);
    };
    EXPECT_LT(shape(0.03).p99, 0.7 * shape(0.0).p99);
}

struct Baked {
    TriangleMesh mesh = test::sheet(4, [](float x, float y) { return x * x - y; });
    BuiltForest built = build_forest(mesh);
    [[nodiscard]] VertexForest read(const VertexForestData& data) const {
        SceneWriter out;
        write_forest(out, data);
        const std::vector<std::byte> bytes = out.to_bytes();
        const SceneFile file = SceneFile::from_bytes(bytes, "test.tact");
        const VertexForest forest = read_forest(file, mesh.position_m, mesh.triangle);
        EXPECT_EQ(forest.nodes(), built.data.node.size());  // views, valid while the bytes exist
        EXPECT_EQ(std::memcmp(&forest.node(0), built.data.node.data(), sizeof(ForestNode)), 0);
        return view_forest(built.data, mesh.position_m, mesh.triangle);
    }
};

TEST(VertexForest, reads_back_unchanged_and_refuses_invalid_data) {
    const Baked baked;
    const VertexForestData& good = baked.built.data;
    EXPECT_NO_THROW((void)baked.read(good));
    ASSERT_GT(good.node.size(), 6U);
    const auto refuses = [&](const char* what, auto&& spoil) {
        VertexForestData bad = good;
        spoil(bad);
        EXPECT_THROW((void)baked.read(bad), StartupError) << what;
    };
    refuses("a middle outside", [](auto& d) { d.node[0].middle = 0; });
    refuses("another middle", [](auto& d) { d.node[0].middle += 1; });
    refuses("a strange parent", [](auto& d) { d.node[1].parent = 5; });
    refuses("a number twice", [](auto& d) { d.node[1].number = d.node[0].number; });
    refuses("a number larger than the parent's",
            [](auto& d) { std::swap(d.node[0].number, d.node[1].number); });
    refuses("an error larger than the parent's", [](auto& d) { d.node[1].error_m = 9.0F; });
    refuses("no position", [](auto& d) { d.node[2].position_m[1] = NAN; });
    refuses("no reach", [](auto& d) { d.node[0].reach_m = -1.0F; });
    refuses("a span smaller than its own triangles", [](auto& d) { d.node[0].span_m = 0.0F; });
    refuses("a deviation larger than the parent's", [](auto& d) { d.node[1].deviation_m = 9e3F; });
    refuses("another first leaf", [](auto& d) { d.node[1].first += 1; });
    refuses("another end", [](auto& d) { d.node[0].end -= 1; });
    refuses("needs out of order", [](auto& d) { d.node[3].first_need = 1000; });
    refuses("a reserved word", [](auto& d) { d.node[3].reserved = 1; });
    refuses("a need that was merged before", [](auto& d) {
        d.need.insert(d.need.begin(), 0U);
        for (auto& n : d.node) ++n.first_need;
        d.node[0].first_need = 0;  // the need of the root is the root itself
    });
    refuses("an invalid need", [](auto& d) { d.need.push_back(100000); });
    refuses("triangles out of order", [](auto& d) { d.node[3].first_triangle = 1000; });
    refuses("a triangle elsewhere", [](auto& d) { std::swap(d.triangle.front(), d.triangle.back()); });
    refuses("a triangle twice", [](auto& d) { d.triangle[1] = d.triangle[0]; });
    refuses("an invalid triangle", [](auto& d) { d.triangle[2].number = 4000; });
    refuses("other corners", [](auto& d) { std::swap(d.triangle[2].leaf[0], d.triangle[2].leaf[1]); });
    refuses("an invalid leaf", [](auto& d) { d.triangle[2].leaf[0] = 1000; });
    refuses("trees out of order", [](auto& d) { d.root_first[0] = 1; });
    refuses("fewer nodes", [](auto& d) { d.node.pop_back(); });
    refuses("fewer triangles", [](auto& d) { d.triangle.pop_back(); });
}

}  // namespace
}  // namespace tact::prep_forest_test
