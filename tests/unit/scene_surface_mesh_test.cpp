#include "ipc/scene/mesh/surface_mesh.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include "ipc/base/error.hpp"
#include "ipc/base/random.hpp"
#include "prep/surface/build_surface.hpp"

namespace tact::scene_surface_mesh_test {
namespace {

// A scene in memory and its surface.
struct Held {
    std::vector<std::byte> bytes;
    std::unique_ptr<SceneFile> file;
    SurfaceMesh mesh;
};

Held held(const SurfaceData& data) {
    Held h;
    SceneWriter out;
    write_surface(out, data);
    h.bytes = out.to_bytes();
    h.file = std::make_unique<SceneFile>(SceneFile::from_bytes(h.bytes, "test.tact"));
    h.mesh = read_surface(*h.file);
    return h;
}

// Random triangles; some are needles, points or repeated.
TriangleMesh soup(std::uint32_t count, std::uint64_t seed) {
    SeededRandom random(seed);
    TriangleMesh mesh;
    for (std::uint32_t t = 0; t < count; ++t) {
        const Vec3 centre = random.direction() * random.uniform();
        for (std::uint32_t k = 0; k < 3; ++k) {
            const Vec3 p = t % 7 == 3 ? centre : Vec3(centre + random.within(0.2));
            for (const double x : {p.x(), p.y(), p.z()}) mesh.position_m.push_back(static_cast<float>(x));
            mesh.triangle.push_back(t % 11 == 5 && k == 2 ? 3 * t : 3 * t + k);
        }
    }
    return mesh;
}

TriangleMesh octahedron() {
    TriangleMesh mesh;
    mesh.position_m = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
    mesh.triangle = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    return mesh;
}

RC_GTEST_PROP(SurfaceMesh, the_nearest_point_matches_brute_force, ()) {
    const auto count = *rc::gen::inRange<std::uint32_t>(1, 400);
    const auto seed = *rc::gen::arbitrary<std::uint32_t>();
    const Held h = held(build_surface(soup(count, seed)));
    RC_ASSERT(h.mesh.triangles() == count);
    SeededRandom random(seed + 1U);
    for (int i = 0; i < 20; ++i) {
        const Vec3 p = random.within(1.5);
        double least = 1e9;
        for (std::uint32_t t = 0; t < count; ++t) least = std::min(least, h.mesh.point_of(t, p).distance_m);
        const auto hint = static_cast<std::uint32_t>(random.below(count));
        const SurfacePoint found = h.mesh.nearest(p, 1e6, i % 2 == 0 ? hint : SurfacePoint::kNone);
        RC_ASSERT(!found.exhausted);
        RC_ASSERT(std::abs(found.distance_m - least) < 1e-12);
        RC_ASSERT(h.mesh.nearest(p, 0.999 * least).triangle == SurfacePoint::kNone);
    }
}

RC_GTEST_PROP(SurfaceMesh, the_nearby_leaves_contain_every_triangle_in_the_ball, ()) {
    const auto count = *rc::gen::inRange<std::uint32_t>(1, 300);
    const auto seed = *rc::gen::arbitrary<std::uint32_t>();
    const Held h = held(build_surface(soup(count, seed)));
    SeededRandom random(seed + 1U);
    std::vector<std::uint32_t> leaves(count);
    for (int i = 0; i < 10; ++i) {
        const Vec3 p = random.within(1.2);
        const double radius = 0.5 * random.uniform();
        std::size_t found = 0;
        RC_ASSERT(h.mesh.leaves_near(p, radius, leaves, found));
        std::vector<bool> held_by_leaf(count, false);
        for (std::size_t l = 0; l < found; ++l) {
            const std::uint32_t first = SurfaceNode::leaf_first(leaves[l]);
            if (l > 0) RC_ASSERT(first > SurfaceNode::leaf_first(leaves[l - 1]));
            for (std::uint32_t k = 0; k < SurfaceNode::leaf_count(leaves[l]); ++k)
                held_by_leaf[first + k] = true;
        }
        for (std::uint32_t t = 0; t < count; ++t) {
            if (h.mesh.point_of(t, p).distance_m <= radius) RC_ASSERT(held_by_leaf[t]);
        }
        if (found > 0) {
            std::size_t fewer = 0;
            RC_ASSERT(!h.mesh.leaves_near(p, radius, std::span(leaves).first(found - 1), fewer));
            RC_ASSERT(fewer == found - 1);
        }
    }
}

RC_GTEST_PROP(SurfaceMesh, batch_queries_agree_with_single_queries, ()) {
    const Held h = held(build_surface(soup(kLooks, *rc::gen::arbitrary<std::uint32_t>())));
    SeededRandom random(*rc::gen::arbitrary<std::uint32_t>());
    std::array<std::uint32_t, kLooks> triangle;
    for (std::uint32_t& t : triangle) t = static_cast<std::uint32_t>(random.uniform() * (kLooks - 0.01));
    const Vec3 p = random.within(1.2);
    QueryJob job = h.mesh.query_job(p);
    job.triangle = triangle.data();
    job.limit = 0.3F;
    for (std::size_t k = 0; k < kQueryKernelCount; ++k) {
        if (!kQueryKernels[k].runs_here()) continue;
        TriangleQueries seen;
        kQueryKernels[k].query(job, seen);
        for (std::size_t lane = 0; lane < kLooks; ++lane) {
            const auto vector = [&](const auto& of) {
                return Vec3(static_cast<double>(of[0][lane]), static_cast<double>(of[1][lane]),
                            static_cast<double>(of[2][lane]));
            };
            const SurfacePoint one = h.mesh.point_of(triangle[lane], p);
            RC_ASSERT(std::abs(static_cast<double>(seen.distance[lane]) - one.distance_m) < 2e-6);
            RC_ASSERT((seen.near >> lane & 1U) == (seen.distance[lane] < job.limit ? 1U : 0U));
            if (one.distance_m > 1e-3)
                RC_ASSERT((vector(seen.away) - (p - one.point_m) / one.distance_m).norm() < 2e-3);
            if ((seen.over >> lane & 1U) != 0) RC_ASSERT(one.part.minCoeff() > -1e-3);
            if (one.part.minCoeff() > 1e-2 && one.distance_m > 1e-3)
                RC_ASSERT((seen.over >> lane & 1U) == 1U);
            // A plane with the triangle on its other side.
            for (const std::uint32_t v : h.mesh.corners(triangle[lane]))
                RC_ASSERT(vector(seen.facet).dot(p - h.mesh.position_m(v)) >=
                          static_cast<double>(seen.height[lane]) - 1e-3);
        }
    }
}

// A ball beside an edge is not over the triangle, whatever rounding makes of its parts: a part of 4e-17 was taken for the inside.
TEST(SurfaceMesh, beside_a_triangle_a_part_of_the_nearest_point_is_exactly_zero) {
    const Held h = held(build_surface(octahedron()));
    SeededRandom random(6);
    int beside = 0;
    for (int i = 0; i < 20'000; ++i) {
        const auto t = static_cast<std::uint32_t>(random.below(8));
        const auto c = h.mesh.corners(t);
        const Vec3 place = 2.0 * random.direction();
        const Vec3 normal = (h.mesh.position_m(c[1]) - h.mesh.position_m(c[0]))
                                .cross(h.mesh.position_m(c[2]) - h.mesh.position_m(c[0]));
        bool over = true;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 from = h.mesh.position_m(c[k]), to = h.mesh.position_m(c[(k + 1) % 3]);
            over = over && normal.cross(to - from).dot(place - from) > -1e-9;
        }
        if (over) continue;
        ++beside;
        const SurfacePoint at = h.mesh.point_of(t, place);
        EXPECT_EQ(at.part.minCoeff(), 0.0) << at.part.transpose();
        EXPECT_NEAR(at.part.sum(), 1.0, 1e-12);
    }
    EXPECT_GT(beside, 10'000);
}

TEST(SurfaceMesh, a_triangle_mesh_keeps_its_triangles_and_its_orientation) {
    const Held h = held(build_surface(octahedron()));
    ASSERT_EQ(h.mesh.triangles(), 8U);
    ASSERT_EQ(h.mesh.vertices(), 6U);
    for (std::uint32_t t = 0; t < 8; ++t) {
        const auto c = h.mesh.corners(t);
        const Vec3 middle =
            (h.mesh.position_m(c[0]) + h.mesh.position_m(c[1]) + h.mesh.position_m(c[2])) / 3.0;
        EXPECT_GT(h.mesh.facet_normal(t).dot(middle), 0.5);
    }
    for (std::uint32_t v = 0; v < 6; ++v) EXPECT_LT((h.mesh.normal(v) - h.mesh.position_m(v)).norm(), 1e-4);
    EXPECT_EQ(h.mesh.low_m(), Vec3(-1, -1, -1));
    EXPECT_EQ(h.mesh.high_m(), Vec3(1, 1, 1));
}

TEST(SurfaceMesh, only_an_oriented_surface_without_a_border_is_closed) {
    TriangleMesh mesh = octahedron();
    EXPECT_TRUE(build_surface(mesh).closed);
    std::swap(mesh.triangle[0], mesh.triangle[1]);
    EXPECT_FALSE(build_surface(mesh).closed);
    mesh = octahedron();
    mesh.triangle.resize(21);
    EXPECT_FALSE(build_surface(mesh).closed);
}

TEST(SurfaceMesh, normals_are_accurate_to_a_hundredth_of_a_degree) {
    SeededRandom random(5);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 n = random.direction();
        EXPECT_LT((unit_normal(oct_normal(n)) - n).norm(), 1.7e-4);
    }
}

TEST(SurfaceMesh, a_search_out_of_visits_reports_it) {
    const Held h = held(build_surface(soup(300, 1)));
    EXPECT_TRUE(h.mesh.nearest(Vec3(0, 0, 0), 10.0, SurfacePoint::kNone, 3).exhausted);
}

TEST(SurfaceMesh, every_invalid_index_range_and_box_is_refused) {
    const SurfaceData good = build_surface(soup(40, 2));
    const auto refused = [&](auto&& spoil) {
        SurfaceData bad = good;
        spoil(bad);
        EXPECT_THROW((void)held(bad), StartupError);
    };
    EXPECT_NO_THROW((void)held(good));
    refused([](SurfaceData& d) { d.triangle[5] = 4000; });
    refused([](SurfaceData& d) { d.triangle.resize(d.triangle.size() - 3); });
    refused([](SurfaceData& d) { d.position_m[7] = std::numeric_limits<float>::quiet_NaN(); });
    refused([](SurfaceData& d) { d.position_m[7] = 50.0F; });  // outside its box
    refused([](SurfaceData& d) { d.normal.resize(d.normal.size() / 2); });
    refused([](SurfaceData& d) { d.node[0].child[0] = 0; });
    refused([](SurfaceData& d) { d.node[0].child[1] = d.node[0].child[0]; });
    refused([](SurfaceData& d) { d.node[0].child[0] = 10000; });
    refused([](SurfaceData& d) { d.node[0].high_m[1][0] = -10.0F; });
    refused([](SurfaceData& d) { d.node[0].low_m[1][0] = std::numeric_limits<float>::quiet_NaN(); });
    refused([](SurfaceData& d) { d.node[0].reserved[2] = 1; });
    refused([](SurfaceData& d) {
        for (SurfaceNode& node : d.node)
            for (std::size_t k = 0; k < 4; ++k)
                if (node.child[k] == SurfaceNode::kNone) node.low_m[0][k] = 1.0F, node.high_m[0][k] = -1.0F;
    });
    refused([](SurfaceData& d) { d.node[1].child[0] = SurfaceNode::leaf(8, 4); });
    refused([](SurfaceData& d) { d.node.push_back(d.node.back()); });
    refused([](SurfaceData& d) { d = {}; });
}

TEST(SurfaceMesh, an_invalid_mesh_is_refused) {
    EXPECT_THROW((void)build_surface({}), StartupError);
    TriangleMesh mesh = octahedron();
    mesh.triangle[4] = 6;
    EXPECT_THROW((void)build_surface(mesh), StartupError);
    mesh = octahedron();
    mesh.position_m[4] = std::numeric_limits<float>::infinity();
    EXPECT_THROW((void)build_surface(mesh), StartupError);
}

}  // namespace
}  // namespace tact::scene_surface_mesh_test
