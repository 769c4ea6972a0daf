// Energy of closed excursions: from free, along a random path in contact, back to free.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "rt/force/surface/surface_model.hpp"
#include "tests/unit/force_surface_fixture.hpp"
#include "tests/unit/force_surface_meshes.hpp"

namespace tact::force_surface_energy_test {
namespace {

using namespace surface_test;

struct Path {
    Vec3 foot, normal, a, b;
    double depth_m;
    // s from 0 to 1; free at both ends.
    [[nodiscard]] Vec3 at(double s, double radius_m) const {
        const double round = 2.0 * std::numbers::pi * s, in = std::sin(std::numbers::pi * s);
        const double press = in < 0.6 ? 0.5 - 0.5 * std::cos(std::numbers::pi * in / 0.6) : 1.0;
        return foot + std::sin(round) * a + std::sin(2.0 * round) * b +
               (radius_m + 0.002 - (0.002 + depth_m) * press) * normal;
    }
};

struct Excursion {
    double gained_j = 0.0;  // by the hand: trapezoids of the force
    double jump_n = 0.0;    // largest change of force beyond what the hand's motion explains
    double shaded = 0.0;    // fraction of the steps in contact whose force is that of full shading
    bool closed = false;    // ended free, and was never released as too deep
};

Excursion run(const MeshScene& scene, SurfaceSettings settings, const Path& path, double speed_m_s) {
    SceneMeta meta{};
    meta.kind = SceneKind::surface;
    meta.world_per_model = 1.0;
    SurfaceModel model(meta, scene.mesh, settings);
    double most_m = 0.0;  // speed_m_s is the highest speed on the path
    for (int i = 0; i < 1000; ++i)
        most_m = std::max(
            most_m,
            (path.at(1e-3 * (i + 1), settings.radius_m) - path.at(1e-3 * i, settings.radius_m)).norm());
    const int steps = static_cast<int>(1e3 * most_m / (1e-3 * speed_m_s));
    Vec3 last = path.at(0.0, settings.radius_m);
    model.reset(at(last));
    for (int i = 0; i < ForceFade::ramp_steps(1e-3); ++i) (void)model.step(at(last), {});
    Vec3 before = Vec3::Zero();
    Excursion e;
    int touching = 0, full = 0;
    for (int i = 1; i <= steps + 200; ++i) {
        const Vec3 place = path.at(std::min(static_cast<double>(i) / steps, 1.0), settings.radius_m);
        const Vec3 force = model.step(at(place), {}).wrench_world.force_n;
        e.gained_j += 0.5 * (force + before).dot(place - last);
        e.jump_n = std::max(e.jump_n,
                            (force - before).norm() - 2.5 * settings.stiffness_n_m * (place - last).norm());
        if (model.contact().planes > 0) {
            ++touching;
            full += model.shading_loss_n() < 0.01 ? 1 : 0;
        }
        last = place;
        before = force;
    }
    e.closed = before.norm() == 0.0 && model.released() == 0;
    e.shaded = static_cast<double>(full) / std::max(touching, 1);
    return e;
}

const std::vector<std::unique_ptr<MeshScene>>& scenes() {
    static const auto made = [] {
        std::vector<std::unique_ptr<MeshScene>> m;
        m.push_back(mesh_scene("rough terrain, flipped", with_flipped(uneven_terrain(4), 0.3, 5)));
        m.push_back(mesh_scene("terrain, flipped", with_flipped(uneven_terrain(4, 30, 0.03, 2e-4), 0.3, 5)));
        m.push_back(mesh_scene("rough terrain", uneven_terrain(4)));
        m.push_back(mesh_scene("terrain", uneven_terrain(4, 30, 0.03, 2e-4)));
        m.push_back(mesh_scene("coarse sphere", smooth_sphere(8)));
        m.push_back(mesh_scene("sphere, flipped", with_flipped(smooth_sphere(12), 0.3, 6)));
        m.push_back(mesh_scene("smooth sphere", smooth_sphere(30)));
        return m;
    }();
    return made;
}

Path random_path(const MeshScene& scene, SeededRandom& random) {
    const reference::Triangles& mesh = scene.triangles;
    const auto& corner = mesh.corner[random.below(mesh.corner.size())];
    const Vec3 foot = (mesh.vertex[corner[0]] + mesh.vertex[corner[1]] + mesh.vertex[corner[2]]) / 3.0;
    const bool sphere = scene.name.find("sphere") != std::string::npos;
    const Vec3 normal = sphere ? foot.normalized() : Vec3::UnitY();
    Path path{foot, normal, 0.004 * random.direction(), 0.002 * random.direction(), 0.002 * random.uniform()};
    path.a -= path.a.dot(normal) * normal;
    path.b -= 0.8 * path.b.dot(normal) * normal;
    return path;
}

void expect_passive(const MeshScene& scene, bool shading, double friction, int paths,
                    std::optional<double> dynamic_friction = {}) {
    SeededRandom random(11);
    int closed = 0;
    for (int k = 0; k < paths; ++k) {
        const Path path = random_path(scene, random);
        const double speed_m_s = 0.02 * std::pow(25.0, random.uniform());
        const Excursion e = run(scene,
                                {.radius_m = k % 3 * 1e-3,
                                 .stiffness_n_m = 1000.0,
                                 .damping_n_s_m = 0.0,
                                 .friction = friction,
                                 .dynamic_friction = dynamic_friction,
                                 .shading = shading},
                                path, speed_m_s);
        if (!e.closed) continue;
        ++closed;
        EXPECT_LT(e.gained_j, 1e-6) << scene.name << ", shading " << shading << ", friction " << friction
                                    << ", path " << k;
        // Twice the lag force, without the clicks of a limit that switches.
        EXPECT_LT(e.jump_n, 2.0 * SurfaceModel::kLagN + 1e-3) << scene.name << ", path " << k;
    }
    EXPECT_GT(closed, paths / 2);
}

TEST(SurfaceEnergy, a_closed_excursion_gains_nothing_at_any_speed) {
    for (const auto& scene : scenes()) {
        for (const bool shading : {false, true})
            for (const double friction : {0.0, 0.2, 0.8}) expect_passive(*scene, shading, friction, 150);
    }
}

TEST(SurfaceEnergy, a_closed_excursion_with_static_and_dynamic_friction_gains_nothing) {
    for (const auto& scene : scenes()) {
        for (const bool shading : {false, true}) expect_passive(*scene, shading, 0.8, 60, 0.3);
    }
}

// The axis of the cone is the normal that the force uses; the settled test compares it with the triangles.
TEST(SurfaceEnergy, on_curved_surfaces_with_shading_the_force_stays_in_the_friction_cone) {
    for (const auto& scene : scenes()) {
        for (const double friction : {0.0, 0.1, 0.5}) {
            SeededRandom random(13);
            double most = 0.0;
            for (int k = 0; k < 20; ++k) {
                const Path path = random_path(*scene, random);
                SceneMeta meta{};
                meta.kind = SceneKind::surface;
                meta.world_per_model = 1.0;
                SurfaceModel model(meta, scene->mesh, {.radius_m = k % 3 * 1e-3, .friction = friction});
                const double radius_m = k % 3 * 1e-3;
                model.reset(at(path.at(0.0, radius_m)));
                for (int i = 0; i < 256; ++i) (void)model.step(at(path.at(0.0, radius_m)), {});
                for (int i = 0; i <= 600; ++i) {
                    ToolState tool = at(path.at(i / 600.0, radius_m));
                    tool.twist_world.linear_m_s =
                        600.0 * (path.at((i + 1) / 600.0, radius_m) - tool.T_world_tool.p_m);
                    const Vec3 force_n = model.step(tool, {}).wrench_world.force_n;
                    if (force_n.norm() < 1e-6) continue;
                    const Vec3 normal = model.push_world_m().normalized();
                    const double along_n = force_n.dot(normal),
                                 across_n = (force_n - along_n * normal).norm();
                    ASSERT_LE(across_n, friction * along_n + 1e-9)
                        << scene->name << ", path " << k << ", step " << i;
                    most = std::max(most, across_n / along_n);
                }
            }
            EXPECT_GE(most, 0.99 * friction);
        }
    }
}

// Shading of a smooth surface does no work around a closed path, so it must stay on.
TEST(SurfaceEnergy, on_a_smooth_sphere_shading_stays_on) {
    const MeshScene& scene = *scenes().back();
    SeededRandom random(12);
    for (int k = 0; k < 40; ++k) {
        const Path path = random_path(scene, random);
        const SurfaceSettings settings{.radius_m = k % 3 * 1e-3, .damping_n_s_m = 0.0, .friction = 0.0};
        EXPECT_GT(run(scene, settings, path, 0.05).shaded, 0.9) << "path " << k;
    }
}

}  // namespace
}  // namespace tact::force_surface_energy_test
