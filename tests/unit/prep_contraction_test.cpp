// Invariants of pair contraction on any mesh, and the effect of pairs without an edge.
#include <gtest/gtest.h>

#include <numbers>

#include "ipc/scene/density/isosurface.hpp"
#include "prep/mesh/mesh_distance.hpp"
#include "prep/mesh/near_pairs.hpp"
#include "prep/mesh/progressive.hpp"
#include "prep/mesh/relax.hpp"
#include "prep/synthetic/rough_sphere.hpp"
#include "tests/unit/prep_mesh_fixtures.hpp"

namespace tact::test::prep_contraction_test {
namespace {

// A sphere of vertex rings between two poles.
void add_ball(TriangleMesh& mesh, const Vec3& centre, double radius, std::uint32_t rings = 7) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices());
    const std::uint32_t around = 2 * rings;
    const auto add = [&](const Vec3& n) {
        for (int i = 0; i < 3; ++i) mesh.position_m.push_back(static_cast<float>(centre[i] + radius * n[i]));
    };
    for (std::uint32_t r = 1; r <= rings; ++r) {
        const double v = std::numbers::pi * r / (rings + 1);
        for (std::uint32_t k = 0; k < around; ++k) {
            const double u = 2.0 * std::numbers::pi * k / around;
            add({std::sin(v) * std::cos(u), std::sin(v) * std::sin(u), std::cos(v)});
        }
    }
    add({0, 0, 1});
    add({0, 0, -1});
    const std::uint32_t top = first + rings * around, bottom = top + 1;
    for (std::uint32_t k = 0; k < around; ++k) {
        const std::uint32_t l = (k + 1) % around;
        for (std::uint32_t r = 0; r + 1 < rings; ++r) {
            const std::uint32_t a = first + r * around + k, b = first + r * around + l, c = a + around,
                                d = b + around;
            mesh.triangle.insert(mesh.triangle.end(), {a, c, b, b, c, d});
        }
        const std::uint32_t end = first + (rings - 1) * around;
        mesh.triangle.insert(mesh.triangle.end(), {top, first + k, first + l, bottom, end + l, end + k});
    }
}

TriangleMesh balls(int n, double gap) {  // n³ spheres of radius 1
    TriangleMesh mesh;
    for (int i = 0; i < n * n * n; ++i)
        add_ball(mesh, (2.0 + gap) * Vec3(i % n, i / n % n, i / (n * n)), 1.0);  // NOLINT
    return mesh;
}

// Thin, rough and tightly bent: easily folded by contraction.
TriangleMesh crumpled() {
    return isosurface(sampled(41,
                              [](const Vec3& p) {
                                  const double r = p.norm();
                                  return -std::abs(r - 0.6 -
                                                   0.12 * std::sin(9.0 * p.x()) * std::sin(8.0 * p.y()) *
                                                       std::cos(7.0 * p.z()));
                              }),
                      -0.06);
}

TEST(Contraction, folds_no_level_of_a_crumpled_shell) {
    const TriangleMesh fine = crumpled();
    ASSERT_GT(topology(fine).sharpest, -0.9);
    for (const std::uint32_t n : {4000U, 1000U, 300U, 100U, 30U}) {
        Simplified coarse = simplify(fine, {.vertices_min = n});
        EXPECT_GT(topology(coarse.mesh).sharpest, -0.9) << n;
        EXPECT_EQ(topology(coarse.mesh).flat_triangles, 0U) << n;
        EXPECT_EQ(topology(coarse.mesh).tangled_edges, 0U) << n;
        relax(fine, coarse, 2);
        EXPECT_GT(topology(coarse.mesh).sharpest, -0.9) << n;
        EXPECT_EQ(topology(coarse.mesh).flat_triangles, 0U) << n;
    }
}

// For a surface visible as a whole from the origin: smallest cosine between an outward normal and the outward direction.
double least_outward(const TriangleMesh& mesh) {
    double least = 1.0;
    for (std::size_t t = 0; t < mesh.triangles(); ++t) {
        std::array<Vec3, 3> p;
        for (std::size_t i = 0; i < 3; ++i) {
            const float* const at = &mesh.position_m[3 * std::size_t{mesh.triangle[3 * t + i]}];
            p[i] = Vec3(at[0], at[1], at[2]);
        }
        const Vec3 area = (p[1] - p[0]).cross(p[2] - p[0]), out = p[0] + p[1] + p[2];
        least = std::min(least, area.dot(out) / (area.norm() * out.norm()));
    }
    return least;
}

// Checks per step and per neighbour would let a triangle turn over in many steps.
TEST(Contraction, no_triangle_turns_over) {
    const TriangleMesh fine = rough_sphere(60);
    ASSERT_GT(least_outward(fine), 0.5);
    for (const std::uint32_t n : {3000U, 1000U, 300U}) {
        Simplified coarse = simplify(fine, {.vertices_min = n});
        EXPECT_EQ(coarse.mesh.vertices(), n);
        EXPECT_GT(least_outward(coarse.mesh), 0.25) << n;
        relax(fine, coarse, 2);
        EXPECT_GT(least_outward(coarse.mesh), 0.25) << n;
    }
}

TEST(Contraction, relaxing_reduces_the_distance) {
    const TriangleMesh fine = isosurface(sampled(33, torus), -0.25);
    Simplified coarse = simplify(fine, {.vertices_min = 150});
    const double before_m = two_sided(fine, coarse.mesh, 5000).rms_m;
    const std::vector<std::uint32_t> triangle = coarse.mesh.triangle;
    relax(fine, coarse, 1);
    EXPECT_LT(two_sided(fine, coarse.mesh, 5000).rms_m, 0.95 * before_m);
    EXPECT_EQ(coarse.mesh.triangle, triangle);
    const std::vector<float> position_m = coarse.mesh.position_m;
    relax(fine, coarse, 0);
    EXPECT_EQ(coarse.mesh.position_m, position_m);
}

TEST(Contraction, a_round_border_keeps_its_area_and_shape) {
    // A disc: its mean outline radius shrinks if border vertices move to chords, and grows if they move to tangents.
    TriangleMesh disc;
    constexpr std::uint32_t kRings = 12, kAround = 72;
    disc.position_m = {0, 0, 0};
    for (std::uint32_t r = 1; r <= kRings; ++r) {
        for (std::uint32_t k = 0; k < kAround; ++k) {
            const double u = 2.0 * std::numbers::pi * k / kAround, d = static_cast<double>(r) / kRings;
            const std::uint32_t a = 1 + (r - 1) * kAround + k, b = 1 + (r - 1) * kAround + (k + 1) % kAround;
            for (const double x : {d * std::cos(u), d * std::sin(u), 0.0})
                disc.position_m.push_back(static_cast<float>(x));
            if (r == 1) {
                disc.triangle.insert(disc.triangle.end(), {0, a, b});
            } else {
                disc.triangle.insert(disc.triangle.end(), {a - kAround, a, b, a - kAround, b, b - kAround});
            }
        }
    }
    Simplified coarse = simplify(disc, {.vertices_min = 20});
    EXPECT_EQ(topology(coarse.mesh).euler, 1);
    EXPECT_NEAR(area(coarse.mesh), area(disc), 0.01 * area(disc));
    relax(disc, coarse, 2);
    EXPECT_NEAR(area(coarse.mesh), area(disc), 0.01 * area(disc));
    EXPECT_LT(two_sided(disc, coarse.mesh, 5000).max_m, 0.08);
}

TEST(Contraction, without_pairs_every_part_is_kept) {
    const TriangleMesh fine = balls(2, 0.1);
    const TriangleMesh coarse = simplify(fine, {.vertices_min = 0}).mesh;
    EXPECT_EQ(coarse.vertices(), 32U);  // eight tetrahedra
    EXPECT_EQ(topology(coarse).euler, 16);
}

TEST(Contraction, with_pairs_parts_merge_and_the_result_stays_close) {
    const TriangleMesh fine = balls(3, 0.1);
    // Edges alone stop at 27 tetrahedra; with pairs, half as many vertices give a better result.
    const TriangleMesh solid = simplify(fine, {.vertices_min = 54}).mesh;
    const TriangleMesh coarse = simplify(fine, {.vertices_min = 54, .pair_distance = 1.0}).mesh;
    EXPECT_EQ(solid.vertices(), 108U);
    EXPECT_LE(coarse.vertices(), 54U);
    EXPECT_GE(coarse.vertices(), 40U);
    EXPECT_EQ(topology(coarse).flat_triangles, 0U);
    EXPECT_LT(two_sided(fine, coarse, 3000).rms_m, 0.5);  // spheres of radius 1
}

TEST(Contraction, with_pairs_adjacent_sheets_are_joined) {
    // Two sheets whose borders lie 0.02 edge lengths apart: an unwelded scan.
    TriangleMesh halves;
    constexpr std::uint32_t kSide = 12;
    for (std::uint32_t half = 0; half < 2; ++half) {
        const auto first = static_cast<std::uint32_t>(halves.vertices());
        for (std::uint32_t y = 0; y <= kSide; ++y) {
            for (std::uint32_t x = 0; x <= kSide; ++x) {
                const float u = static_cast<float>(x + half * kSide) + 0.02F * static_cast<float>(half);
                halves.position_m.insert(halves.position_m.end(),
                                         {u, static_cast<float>(y), 0.1F * std::sin(0.5F * u)});
                if (x == kSide || y == kSide) continue;
                const std::uint32_t a = first + y * (kSide + 1) + x, b = a + 1, c = a + kSide + 1, d = c + 1;
                halves.triangle.insert(halves.triangle.end(), {a, b, d, a, d, c});
            }
        }
    }
    ASSERT_EQ(topology(halves).euler, 2);
    const TriangleMesh apart = simplify(halves, {.vertices_min = 80}).mesh;
    EXPECT_EQ(topology(apart).euler, 2);
    const TriangleMesh sewn =
        simplify(halves, {.vertices_min = 40, .boundary_weight = 1.0, .pair_distance = 0.5}).mesh;
    EXPECT_EQ(topology(sewn).euler, 1);
    EXPECT_EQ(topology(sewn).tangled_edges, 0U);
    EXPECT_NEAR(area(sewn), 24.02 * 12.0, 0.02 * 24.02 * 12.0);
}

TEST(Contraction, edges_with_three_triangles_are_kept) {
    // Three pages of a book: the spine is a line of edges with three triangles each.
    TriangleMesh book;
    constexpr std::uint32_t kLong = 16, kWide = 6;
    for (std::uint32_t y = 0; y <= kLong; ++y)
        book.position_m.insert(book.position_m.end(), {0, static_cast<float>(y), 0});
    for (int page = 0; page < 3; ++page) {
        const double angle = 2.1 * page;
        std::vector<std::uint32_t> before(kLong + 1);
        for (std::uint32_t y = 0; y <= kLong; ++y) before[y] = y;
        for (std::uint32_t x = 1; x <= kWide; ++x) {
            std::vector<std::uint32_t> now;
            for (std::uint32_t y = 0; y <= kLong; ++y) {
                now.push_back(static_cast<std::uint32_t>(book.vertices()));
                for (const double c : {x * std::cos(angle), double(y), x * std::sin(angle)})
                    book.position_m.push_back(static_cast<float>(c));
            }
            for (std::uint32_t y = 0; y < kLong; ++y)
                book.triangle.insert(book.triangle.end(),
                                     {before[y], now[y], now[y + 1], before[y], now[y + 1], before[y + 1]});
            before = now;
        }
    }
    Simplified coarse = simplify(book, {.vertices_min = 12});
    relax(book, coarse, 1);
    EXPECT_LE(coarse.mesh.vertices(), 20U);
    EXPECT_LT(two_sided(book, coarse.mesh, 3000).max_m, 0.5);
    EXPECT_NEAR(area(coarse.mesh), area(book), 0.02 * area(book));
}

TEST(Contraction, parts_joined_at_a_vertex_are_counted_correctly) {
    TriangleMesh two;
    add_ball(two, {0, 0, 0}, 1.0);
    add_ball(two, {0, 0, 2.0}, 1.0);
    // Weld the upper pole of the first sphere to the lower pole of the second.
    const auto half = static_cast<std::uint32_t>(two.vertices() / 2);
    for (std::uint32_t& v : two.triangle) v = v == 2 * half - 1 ? half - 2 : v;
    const TriangleMesh mesh = cleaned(two);
    const ProgressiveMesh baked(make_progressive(mesh));
    EXPECT_EQ(baked.vertices(), mesh.vertices());
    EXPECT_LE(simplify(mesh, {.vertices_min = 50}).mesh.vertices(), 50U);
}

TEST(Contraction, progressive_meshes_with_pairs_reverse_exactly) {
    const TriangleMesh fine = balls(2, 0.05);
    const ProgressiveMeshData data = make_progressive(fine, {.pair_distance = 1.0});
    const ProgressiveMesh checked(data);  // throws if a level refers to missing data
    EXPECT_LT(data.base_vertices, 32U);   // fewer than eight tetrahedra
    ASSERT_EQ(data.vertex.size(), fine.vertices());
    // All positions and triangles of the original are present exactly once.
    const auto key = [](const float* p) { return std::array<float, 3>{p[0], p[1], p[2]}; };
    std::multiset<std::array<float, 3>> was, is;
    for (std::size_t v = 0; v < fine.vertices(); ++v) {
        was.insert(key(&fine.position_m[3 * v]));
        is.insert(data.vertex[v].position_m);
    }
    EXPECT_EQ(was, is);
    EXPECT_EQ(data.triangle.size(), fine.triangle.size());
}

TEST(NearPairs, match_the_slow_search) {
    SeededRandom random(7);
    std::vector<Eigen::Vector3f> at;
    for (int i = 0; i < 400; ++i)
        at.emplace_back(static_cast<float>(random.uniform()), static_cast<float>(random.uniform()),
                        static_cast<float>(0.2 * random.uniform()));
    std::set<std::pair<std::uint32_t, std::uint32_t>> slow, fast;
    for (std::uint32_t i = 0; i < at.size(); ++i) {
        for (std::uint32_t j = i + 1; j < at.size(); ++j) {
            if ((at[i] - at[j]).norm() <= 0.1F) slow.insert({i, j});
        }
    }
    near_pairs(at, 0.1F, 400, [&](std::uint32_t i, const std::vector<std::uint32_t>& near) {
        for (const std::uint32_t j : near) fast.insert({i, j});
    });
    EXPECT_EQ(fast, slow);
    near_pairs(at, 0.1F, 2,
               [&](std::uint32_t, const std::vector<std::uint32_t>& near) { EXPECT_LE(near.size(), 2U); });
    near_pairs(std::vector<Eigen::Vector3f>(20000, {1, 1, 1}), 0.1F, 4,
               [](std::uint32_t, const std::vector<std::uint32_t>&) {});  // all at one position: bounded
}

}  // namespace
}  // namespace tact::test::prep_contraction_test
