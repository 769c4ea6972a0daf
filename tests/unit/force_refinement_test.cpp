// Refinement: each cut is the whole surface, as fine as requested around the probe, and independent of the path
// on which the probe came.
#include <gtest/gtest.h>

#include <set>

#include "ipc/base/error.hpp"
#include "ipc/base/random.hpp"
#include "ipc/scene/mesh/refinement.hpp"
#include "prep/mesh/mesh_folds.hpp"
#include "prep/mesh/nearest_point.hpp"
#include "prep/surface/forest_builder.hpp"
#include "prep/synthetic/rough_torus.hpp"
#include "tests/unit/prep_mesh_fixtures.hpp"

namespace tact {
namespace {

struct Surface {
    explicit Surface(TriangleMesh from) : mesh(std::move(from)) {}
    TriangleMesh mesh;
    BuiltForest built = build_forest(mesh);
    [[nodiscard]] std::array<std::uint32_t, 3> corners(std::uint32_t t) const {
        return {mesh.triangle[3 * std::size_t{t}], mesh.triangle[3 * std::size_t{t} + 1],
                mesh.triangle[3 * std::size_t{t} + 2]};
    }
    VertexForest forest = view_forest(built.data, mesh.position_m, mesh.triangle);
};

const Surface& torus() {
    static const Surface surface(rough_torus(64, 32));
    return surface;
}

RefinementSettings some_settings(float radius_m) {
    RefinementSettings s;
    s.filter = RefineFilter::bell(radius_m, 0.3F, 0.05F);
    s.look_ahead_s = 0.01;
    return s;
}

TriangleMesh active_mesh(const Refinement& r) {
    TriangleMesh mesh;
    std::map<std::uint32_t, std::uint32_t> number;
    r.each_triangle([&](std::uint32_t, const std::array<std::uint32_t, 3>& at) {
        for (const std::uint32_t place : at) {
            const auto [found, fresh] =
                number.try_emplace(place, static_cast<std::uint32_t>(mesh.vertices()));
            if (fresh)
                for (const float x : r.position_m(place)) mesh.position_m.push_back(x);
            mesh.triangle.push_back(found->second);
        }
    });
    return mesh;
}

// By definition a triangle of the full mesh is active exactly if three different places hold its corners, and
// those places are its active corners.
void expect_whole(const Refinement& r, const Surface& s) {
    std::map<std::uint32_t, std::array<std::uint32_t, 3>> there;
    r.each_triangle([&](std::uint32_t t, const std::array<std::uint32_t, 3>& at) {
        EXPECT_TRUE(there.emplace(t, at).second) << "triangle " << t << " twice";
    });
    for (std::uint32_t t = 0; t < s.forest.triangles(); ++t) {
        std::array<std::uint32_t, 3> at{};
        for (std::size_t k = 0; k < 3; ++k) at[k] = r.place_of(s.corners(t)[k]);
        const bool degenerate = at[0] == at[1] || at[1] == at[2] || at[2] == at[0];
        const auto found = there.find(t);
        ASSERT_EQ(found == there.end(), degenerate) << "triangle " << t;
        if (!degenerate) {
            ASSERT_EQ(found->second, at) << "triangle " << t;
        }
    }
}

void expect_full_detail(const Refinement& r, const Surface& s, const Vec3& probe_m, double radius_m) {
    for (std::uint32_t t = 0; t < s.forest.triangles(); ++t) {
        // The request uses the triangle's box, a little larger than the guarantee, so this test checks only corners
        // and centre.
        std::array<Vec3, 4> point;
        point[3].setZero();
        const auto corner = s.corners(t);
        for (std::size_t k = 0; k < 3; ++k) {
            const auto p = s.forest.leaf_position_m(corner[k]);
            point[k] = Vec3(p[0], p[1], p[2]);
            point[3] += point[k] / 3.0;
        }
        const bool near = std::any_of(point.begin(), point.end(), [&](const Vec3& p) {
            return (p - probe_m).cwiseAbs().maxCoeff() < 0.9999 * radius_m;
        });
        if (!near) continue;
        for (const std::uint32_t v : corner) ASSERT_EQ(r.leaf(r.place_of(v)), v) << "triangle " << t;
    }
}

std::set<std::array<float, 3>> vertices_of(const Refinement& r) {
    std::set<std::array<float, 3>> all;
    r.each_triangle([&](std::uint32_t, const auto& at) {
        for (const std::uint32_t place : at) all.insert(r.position_m(place));
    });
    return all;
}

void settle(Refinement& r, const Vec3& probe_m) {
    for (int i = 0; i < 1000; ++i)
        if (r.step(probe_m, Vec3::Zero()).settled) return;
    FAIL() << "still changing after 1000 steps";
}

TEST(RefineFilter, distance_is_the_inverse_of_the_allowed_error) {
    const RefineFilter bell = RefineFilter::bell(0.1F, 0.2F, 0.01F);
    const RefineFilter::Point points[] = {
        {0.3F, 0.02F}, {0.2F, 0.01F}, {0.4F, 0.015F}, {NAN, 1.0F}, {0.5F, -1.0F}};
    const RefineFilter steps = RefineFilter::frustums(0.1F, points);
    for (const RefineFilter& f : {bell, steps}) {
        EXPECT_EQ(f.allowed_m(0.1F), 0.0F);
        float last = 0.0F;
        for (float d = 0.0F; d < 1.0F; d += 0.003F) {
            EXPECT_GE(f.allowed_m(d), last);
            last = f.allowed_m(d);
            if (last > 0.0F && last < 0.999F * f.allowed_m(10.0F)) {
                EXPECT_NEAR(f.distance_m(last), d, 1e-4F);
            }
        }
        EXPECT_GT(f.distance_m(0.021F), 1e30F);
        EXPECT_GE(f.distance_m(1e-9F), 0.1F);
    }
    EXPECT_NEAR(steps.allowed_m(0.25F), 0.015F, 1e-6F);
    EXPECT_EQ(steps.allowed_m(0.4F), 0.02F);  // raised: allowed errors never decrease with distance
    EXPECT_NEAR(bell.allowed_m(0.3F), 0.01F * (1.0F - std::exp(-1.0F)), 3e-4F);
    EXPECT_GT(RefineFilter().distance_m(1e-9F), 1e30F);
}

TEST(Refinement, each_cut_on_a_path_is_the_whole_closed_surface_without_folds) {
    Refinement r(torus().forest, some_settings(0.12F));
    expect_whole(r, torus());
    const std::size_t folds = count_folds(torus().mesh);
    Vec3 probe(1.0, 0.0, 0.3);
    for (int i = 0; i < 12; ++i) {
        const double angle = 0.3 * i;
        const Vec3 next(std::cos(angle), std::sin(angle), 0.3 * std::sin(3.0 * angle));
        const RefineStep done = r.step(probe, (next - probe) / 0.01);
        probe = next;
        EXPECT_TRUE(done.full_detail);
        expect_whole(r, torus());
        const TriangleMesh mesh = active_mesh(r);
        EXPECT_EQ(mesh.vertices(), done.vertices);
        EXPECT_EQ(mesh.triangles(), done.triangles);
        EXPECT_LT(mesh.vertices(), torus().mesh.vertices() * 2 / 3);
        const test::Topology shape = test::topology(mesh);
        EXPECT_EQ(shape.border_edges, 0U);
        EXPECT_EQ(shape.tangled_edges, 0U);
        EXPECT_EQ(shape.tangled_vertices, 0U);
        EXPECT_EQ(shape.euler, 0);
        EXPECT_LE(count_folds(mesh), folds);
        if (::testing::Test::HasFatalFailure()) return;
    }
}

TEST(Refinement, no_triangle_flips_against_the_smooth_surface) {
    const Surface ball([] {
        TriangleMesh mesh = test::sheet(70, [](float, float) { return 0.0F; });
        for (std::size_t v = 0; v < mesh.vertices(); ++v) {  // a cap of a sphere, almost a hemisphere
            const float x = 2.0F * mesh.position_m[3 * v] - 1.0F,
                        y = 2.0F * mesh.position_m[3 * v + 1] - 1.0F;
            const Eigen::Vector3f p = Eigen::Vector3f(x, y, 0.8F).normalized();
            std::copy_n(p.data(), 3, &mesh.position_m[3 * v]);
        }
        return mesh;
    }());
    RefinementSettings settings = some_settings(0.1F);
    settings.filter = RefineFilter::bell(0.1F, 0.2F, 0.02F);
    Refinement r(ball.forest, settings);
    double worst = 1.0;
    for (int i = 0; i < 12; ++i) {
        const double angle = 0.5 * i;
        r.step(Vec3(0.6 * std::cos(angle), 0.6 * std::sin(angle), 0.8), Vec3::Zero());
        const TriangleMesh mesh = active_mesh(r);
        std::size_t t = 0;
        r.each_triangle([&](std::uint32_t number, const auto&) {
            const Vec3 now = test::double_area(mesh, t++), full = test::double_area(ball.mesh, number);
            worst = std::min(worst, now.dot(full) / (now.norm() * full.norm()));
        });
    }
    EXPECT_GT(worst, 0.5);  // 60 degrees: triangles at the border are as large as the cap
}

TEST(Refinement, inside_the_radius_the_cut_equals_the_full_mesh) {
    Refinement r(torus().forest, some_settings(0.15F));
    for (const Vec3& probe : {Vec3(1.3, 0.0, 0.0), Vec3(0.0, -1.0, 0.3), Vec3(-0.7, 0.1, 0.0)}) {
        EXPECT_TRUE(r.step(probe, Vec3::Zero()).full_detail);
        expect_full_detail(r, torus(), probe, 0.15);
        EXPECT_LT(r.step(probe, Vec3::Zero()).vertices, torus().forest.leaves() * 2 / 3);
    }
    // The same holds along the predicted path.
    const Vec3 from(0.0, 1.2, 0.1), velocity(30.0, -10.0, 0.0);
    EXPECT_TRUE(r.step(from, velocity).full_detail);
    for (const double part : {0.0, 0.4, 1.0})
        expect_full_detail(r, torus(), from + 0.01 * part * velocity, 0.15);
}

TEST(Refinement, the_cut_does_not_depend_on_the_path_of_the_probe) {
    Refinement r(torus().forest, some_settings(0.2F));
    const Vec3 here(1.1, 0.3, 0.2);
    settle(r, here);
    const auto first = vertices_of(r);
    const std::size_t bytes = r.memory_bytes();
    SeededRandom random(3);
    for (int i = 0; i < 20; ++i) {
        const double angle = 6.28 * random.uniform();
        r.step(Vec3(std::cos(angle), std::sin(angle), 0.2), Vec3(2.0, 0.0, 0.0));
    }
    settle(r, Vec3(100.0, 0.0, 0.0));
    EXPECT_LT(vertices_of(r).size(), first.size() / 2);
    settle(r, here);
    EXPECT_EQ(vertices_of(r), first);
    expect_whole(r, torus());
    EXPECT_EQ(r.memory_bytes(), bytes);
}

// Brute force: from points of one surface to all triangles of the other.
double farthest_from(const TriangleMesh& from, const TriangleMesh& to) {
    const auto at = [](const TriangleMesh& m, std::size_t corner) {
        const float* const p = &m.position_m[3 * std::size_t{m.triangle[corner]}];
        return Vec3(static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2]));
    };
    double farthest = 0.0;
    for (std::size_t t = 0; t < from.triangle.size(); t += 3) {
        const Vec3 middle = (at(from, t) + at(from, t + 1) + at(from, t + 2)) / 3.0;
        for (const Vec3& p : {at(from, t), middle}) {
            double nearest = 1e300;
            for (std::size_t s = 0; s < to.triangle.size(); s += 3) {
                const NearestPoint q = nearest_point(p, at(to, s), at(to, s + 1), at(to, s + 2));
                nearest = std::min(nearest, std::sqrt(q.square));
            }
            farthest = std::max(farthest, nearest);
        }
    }
    return farthest;
}

TEST(Refinement, the_active_surface_stays_within_its_reported_deviation) {
    static const Surface small(rough_torus(24, 12));
    Refinement r(small.forest, some_settings(0.15F));
    for (const Vec3& probe : {Vec3(1.3, 0.0, 0.0), Vec3(-0.9, 0.4, 0.2), Vec3(40.0, 0.0, 0.0)}) {
        settle(r, probe);
        const TriangleMesh active = active_mesh(r);
        const auto said = static_cast<double>(r.deviation_m());
        EXPECT_GT(said, 0.0);
        EXPECT_LE(farthest_from(active, small.mesh), said);
        EXPECT_LE(farthest_from(small.mesh, active), said);
    }
    r.set_filter(RefineFilter());
    settle(r, Vec3::Zero());
    EXPECT_EQ(r.deviation_m(), 0.0F);
}

TEST(Refinement, budgets_hold_and_later_steps_finish_the_work) {
    RefinementSettings settings = some_settings(0.25F);
    settings.splits_max = 37;
    settings.merges_max = 23;
    Refinement r(torus().forest, settings);
    const Vec3 here(1.0, 0.0, 0.3), there(-1.0, 0.0, 0.3);
    EXPECT_FALSE(r.step(here, Vec3::Zero()).full_detail);
    for (const Vec3& probe : {here, there, here}) {
        for (int i = 0; i < 1000; ++i) {
            const RefineStep done = r.step(probe, Vec3::Zero());
            ASSERT_LE(done.splits, 37U);
            ASSERT_LE(done.merges, 23U);
            if (i % 10 == 0) expect_whole(r, torus());
            if (done.settled) {
                EXPECT_TRUE(done.full_detail);
                break;
            }
            ASSERT_LT(i, 900);
        }
        expect_full_detail(r, torus(), probe, 0.25);
    }
    Refinement at_once(torus().forest, some_settings(0.25F));
    settle(at_once, here);
    EXPECT_EQ(vertices_of(r), vertices_of(at_once));
}

TEST(Refinement, full_pools_are_reported_and_the_surface_stays_whole) {
    RefinementSettings settings = some_settings(0.5F);
    settings.nodes_max = torus().forest.roots() + 200;
    Refinement r(torus().forest, settings);
    for (int i = 0; i < 5; ++i) {
        const RefineStep done = r.step(Vec3(1.0, 0.0, 0.3), Vec3::Zero());
        EXPECT_TRUE(done.no_room);
        EXPECT_FALSE(done.full_detail);
        EXPECT_LE(done.vertices, settings.nodes_max);
        expect_whole(r, torus());
    }
    EXPECT_FALSE(r.step(Vec3(50.0, 0.0, 0.3), Vec3::Zero()).no_room);
    settings.nodes_max = torus().forest.roots() - 1;
    EXPECT_THROW(Refinement(torus().forest, settings), StartupError);
}

TEST(Refinement, a_probe_that_is_not_finite_changes_nothing) {
    Refinement r(torus().forest, some_settings(0.1F));
    settle(r, Vec3(1.0, 0.0, 0.3));
    const auto before = vertices_of(r);
    EXPECT_EQ(r.step(Vec3(NAN, 0.0, 0.0), Vec3::Zero()).splits, 0U);
    EXPECT_EQ(r.step(Vec3::Zero(), Vec3(INFINITY, 0.0, 0.0)).merges, 0U);
    EXPECT_EQ(vertices_of(r), before);
    (void)r.step(Vec3(1e300, 0.0, 0.0), Vec3(-1e300, 0.0, 0.0));
    expect_whole(r, torus());
}

TEST(Refinement, the_next_step_applies_another_filter) {
    Refinement r(torus().forest, some_settings(0.1F));
    const Vec3 here(1.0, 0.0, 0.3);
    settle(r, here);
    r.set_filter(RefineFilter::bell(0.3F, 0.2F, 0.05F));
    settle(r, here);
    expect_full_detail(r, torus(), here, 0.3);
    r.set_filter(RefineFilter());
    EXPECT_EQ(r.step(here, Vec3::Zero()).vertices, torus().forest.leaves());
    EXPECT_EQ(active_mesh(r).triangles(), torus().mesh.triangles());
}

}  // namespace
}  // namespace tact
