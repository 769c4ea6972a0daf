// Settled means settled: an independent reference in double precision judges the proxy and the force of sampled steps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ipc/base/random.hpp"
#include "rt/force/surface/surface_model.hpp"
#include "tests/reference/surface_reference.hpp"
#include "tests/unit/force_surface_fixture.hpp"
#include "tests/unit/force_surface_meshes.hpp"

namespace tact::force_surface_settled_test {
namespace {

using namespace surface_test;

struct Ball {
    double radius_m, margin_m;
};
constexpr Ball kBalls[] = {{4e-6, 2e-6}, {1e-3, 1e-6}, {3e-3, 3e-6}};  // the first: a point

// A hand that strays over the mesh: strokes of various speeds, presses and pauses, no deeper than 3 mm.
class Stray {
public:
    Stray(const MeshScene& scene, std::uint64_t seed) : scene_(scene), random_(seed) {
        goal_ = anywhere() + 2.0 * scene.size_m * random_.direction();
        to_ = goal_;
    }
    [[nodiscard]] const Vec3& goal() const { return goal_; }
    const Vec3& next(const Vec3& proxy_m) {
        if ((to_ - goal_).norm() <= speed_m_ || step_ % 300 == 0) {
            to_ = anywhere() + random_.within(2e-3);
            speed_m_ = 5e-4 * std::pow(10.0, -2.0 * random_.uniform());
        }
        if (step_++ % 50 >= 4)
            goal_ += std::min(speed_m_ / std::max((to_ - goal_).norm(), 1e-12), 1.0) * (to_ - goal_);
        if ((proxy_m - goal_).norm() > 3e-3) goal_ = to_ = proxy_m;
        return goal_;
    }

private:
    Vec3 anywhere() {
        const reference::Triangles& mesh = scene_.triangles;
        const auto& c = mesh.corner[random_.below(mesh.corner.size())];
        const double u = random_.uniform(), v = random_.uniform() * (1.0 - u);
        return mesh.vertex[c[0]] + u * (mesh.vertex[c[1]] - mesh.vertex[c[0]]) +
               v * (mesh.vertex[c[2]] - mesh.vertex[c[0]]);
    }
    const MeshScene& scene_;
    SeededRandom random_;
    Vec3 goal_, to_;
    double speed_m_ = 0.0;
    int step_ = 0;
};

void expect_settled_is_at_rest(const MeshScene& scene, const Ball& ball, double friction, int steps,
                               int judged_every) {
    SurfaceContact contact(scene.mesh, {ball.radius_m, ball.margin_m, friction, 1e-4});
    const reference::Ball judged{ball.radius_m, ball.margin_m, friction};
    Stray hand(scene, 7);
    contact.seat(hand.goal());
    const double m = ball.margin_m;
    int settled = 0, touching = 0;
    for (int i = 0; i < steps; ++i) {
        const Vec3 goal = hand.next(contact.proxy_m());
        const Contact now = contact.follow(goal, SurfaceContact::kMovesMost);
        if (now.state != ContactState::settled) continue;
        ++settled;
        if (now.planes == 0 || ++touching % judged_every != 0) continue;
        const std::string where = scene.name + ", radius " + std::to_string(1e3 * ball.radius_m) +
                                  " mm, friction " + std::to_string(friction) + ", step " + std::to_string(i);
        const reference::Judgement j = reference::judge(scene.triangles, judged, now.proxy_m, goal, 3.0 * m);
        EXPECT_GT(j.least_gap, -0.5 * m) << where;
        EXPECT_LT(j.unborne, 2.0 * m) << where;
        if (friction > 0.0) continue;
        const double step_m = std::max(0.05 * ball.radius_m, 0.25 * m);
        EXPECT_LT(reference::unrest(scene.triangles, judged, now.proxy_m, goal, step_m, 0.01 * m, 0.02 * m),
                  2.0 * m)
            << where;
    }
    EXPECT_GT(settled, 0.7 * steps) << scene.name;
    EXPECT_TRUE(touching > 0 || &ball == kBalls) << scene.name;  // a point slips through a soup
}

TEST(SurfaceSettled, a_settled_proxy_is_free_and_at_rest_by_an_independent_reference) {
    for (const MeshScene* scene : difficult_meshes()) {
        for (const Ball& ball : kBalls)
            for (const double friction : {0.0, 0.3})
                expect_settled_is_at_rest(*scene, ball, friction, 4000, 12);
    }
}

TEST(SurfaceSettled, on_scanned_meshes_too) {
    const auto scenes = real_meshes();
    if (scenes.empty()) GTEST_SKIP() << "the folder of real data is absent (set TACT_SHARED)";
    for (const auto& scene : scenes)
        for (const Ball& ball : kBalls) expect_settled_is_at_rest(*scene, ball, 0.0, 4000, 40);
}

// The model's own law, computed anew from the triangles that the reference touches: the stiffness times the sum of the
// pushes along the shaded normals, and friction across it.
Vec3 expected_force_n(const MeshScene& scene, const reference::Judgement& j, const Vec3& way_m,
                      double friction, bool shading) {
    Vec3 push_m = Vec3::Zero();
    for (const reference::Touched& t : j.touched) {
        if (!(t.push > 0.0)) continue;
        Vec3 normal = t.normal;
        if (shading) {
            const auto corner = scene.triangles.corner[t.triangle];
            const Vec3 a = scene.triangles.vertex[corner[0]], b = scene.triangles.vertex[corner[1]],
                       c = scene.triangles.vertex[corner[2]];
            const Vec3 across = (b - a).cross(c - a),
                       point = j.place - (j.place - a).dot(across) / across.squaredNorm() * across;
            const double on_b = (point - a).cross(c - a).dot(across) / across.squaredNorm(),
                         on_c = (b - a).cross(point - a).dot(across) / across.squaredNorm();
            const Vec3 smooth = ((1.0 - on_b - on_c) * scene.mesh.normal(corner[0]) +
                                 on_b * scene.mesh.normal(corner[1]) + on_c * scene.mesh.normal(corner[2]))
                                    .normalized();
            const double side = across.dot(normal) < 0.0 ? -1.0 : 1.0,
                         cosine = smooth.dot(across.normalized());
            const double full = std::clamp((cosine - 0.766) / (0.940 - 0.766), 0.0, 1.0);
            normal +=
                full * full * (side * smooth - normal);  // over a facet its normal is that of the contact
        }
        push_m += t.push * normal;
    }
    Vec3 rub_m = way_m - j.lift;
    const double length = rub_m.norm();
    rub_m -= push_m.dot(rub_m) / push_m.squaredNorm() * push_m;
    const double most = std::min(friction * push_m.norm(), length);
    return kStiffness *
           (push_m + (rub_m.norm() > 0.0 ? Vec3(most / rub_m.norm() * rub_m) : Vec3(Vec3::Zero())));
}

TEST(SurfaceSettled, the_error_bounds_the_difference_from_the_reference_with_shading_and_friction) {
    const auto terrain = mesh_scene("terrain", uneven_terrain(6, 24, 0.03, 2e-4)),
               sphere = mesh_scene("sphere", smooth_sphere(8));
    for (const MeshScene* scene : {terrain.get(), sphere.get()}) {
        for (const double radius_m : {0.0, 0.001}) {
            for (const double friction : {0.0, 0.3}) {
                for (const bool shading : {false, true}) {
                    SceneMeta meta{};
                    meta.kind = SceneKind::surface;
                    meta.world_per_model = 1.0;
                    SurfaceModel model(meta, scene->mesh,
                                       {.radius_m = radius_m,
                                        .damping_n_s_m = 0.0,
                                        .friction = friction,
                                        .shading = shading});
                    const double r = std::max(radius_m, SurfaceModel::kPointM), m = std::max(1e-3 * r, 2e-6);
                    Stray hand(*scene, 9);
                    model.reset(at(hand.goal()));
                    for (int i = 0; i < ForceFade::ramp_steps(1e-3); ++i)
                        (void)model.step(at(hand.goal()), {});
                    int small = 0, judged = 0;
                    for (int i = 0; i < 3000; ++i) {
                        const Vec3 goal = hand.next(model.contact().proxy_m);
                        const StepResult result = model.step(at(goal), {});
                        if (model.contact().planes == 0 || i % 3 != 0) continue;
                        const Vec3 proxy = model.contact().proxy_m;
                        const reference::Judgement j =
                            reference::judge(scene->triangles, {r, m, friction}, proxy, goal, 3.0 * m);
                        // Where it touches several triangles, the one that bears the pull may be a matter of rounding.
                        if ((shading || friction > 0.0) && !(j.touched.size() == 1 && j.touched[0].inside))
                            continue;
                        const Vec3 expected_n = expected_force_n(*scene, j, proxy - goal, friction, shading);
                        EXPECT_LE((result.wrench_world.force_n - expected_n).norm(), result.load.error + 1e-9)
                            << scene->name << ", radius " << radius_m << ", friction " << friction
                            << ", shading " << shading << ", step " << i;
                        ++judged;
                        small += result.load.error < 0.02 ? 1 : 0;
                    }
                    EXPECT_GT(judged, 50);
                    EXPECT_GT(small, 0.5 * judged);
                }
            }
        }
    }
}

}  // namespace
}  // namespace tact::force_surface_settled_test
