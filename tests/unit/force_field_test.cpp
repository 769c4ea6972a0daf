// The field's force against the analytic field of two charges (double precision); energy on closed paths; the contract.
#include <gtest/gtest.h>

#include <cmath>

#include "ipc/base/random.hpp"
#include "prep/field/bake_field.hpp"
#include "prep/field/charges.hpp"
#include "rt/force/field/field_model.hpp"
#include "tests/contract/force_model_contract.hpp"

namespace tact {
namespace {

struct Scene {
    SceneMeta meta{};
    FieldMeta field{};
    DensityGrid grid;
};

Scene scene_of(double probe_radius_m, std::uint32_t points = 65) {
    FieldInput input;
    input.grid = two_charges_grid({}, points);
    input.probe_radius_m = probe_radius_m;
    SceneWriter out;
    Scene scene;
    const BakedField baked = bake_field(input, out);
    const std::vector<std::byte> bytes = out.to_bytes();
    scene.grid = read_grid(SceneFile::from_bytes(bytes, "charges"));
    scene.meta = baked.meta;
    scene.field = baked.field;
    return scene;
}

ToolState tool_at(const Vec3& world_m) {
    ToolState tool;
    tool.T_world_tool.p_m = world_m;
    return tool;
}

Budget budget_of(float fidelity) {
    Budget b;
    b.fidelity = fidelity;
    return b;
}

// Settled force at one position.
Vec3 force_at(FieldModel& model, const Vec3& world_m, float fidelity = 1.0F) {
    StepResult r;
    for (int i = 0; i <= ForceFade::ramp_steps(1e-3); ++i)
        r = model.step(tool_at(world_m), budget_of(fidelity));
    return r.wrench_world.force_n;
}

// Minus the gradient of the analytic potential times the scene's gain, by central differences.
Vec3 analytic_n(const Scene& scene, const Vec3& at_m) {
    constexpr double kStep = 1e-5;
    Vec3 gradient;
    for (Eigen::Index a = 0; a < 3; ++a) {
        const Vec3 d = kStep * Vec3::Unit(a);
        gradient[a] = (potential({}, at_m + d) - potential({}, at_m - d)) / (2.0 * kStep);
    }
    return -scene.field.force_n_m_per_unit * gradient;
}

TEST(FieldModel, force_on_a_point_is_the_analytic_field_of_two_charges) {
    const Scene scene = scene_of(0.0);
    FieldModel model(scene.meta, scene.field, scene.grid);
    SeededRandom random(7);
    for (int i = 0; i < 200; ++i) {
        const Vec3 at_m = 0.48 * Vec3(2.0 * random.uniform() - 1.0, 2.0 * random.uniform() - 1.0,
                                      2.0 * random.uniform() - 1.0);
        const Vec3 wanted = analytic_n(scene, at_m);
        EXPECT_LT((force_at(model, scene.meta.to_world(at_m)) - wanted).norm(),
                  0.01 * scene.field.force_n_max)
            << at_m.transpose();
    }
}

TEST(FieldModel, force_on_a_ball_is_the_mean_analytic_field_over_its_volume) {
    const Scene scene = scene_of(0.012);
    FieldModel model(scene.meta, scene.field, scene.grid);
    const double radius_m = scene.field.probe_radius_m;
    SeededRandom random(11);
    for (int i = 0; i < 20; ++i) {
        const Vec3 at_m = 0.3 * Vec3(2.0 * random.uniform() - 1.0, 2.0 * random.uniform() - 1.0,
                                     2.0 * random.uniform() - 1.0);
        Vec3 sum = Vec3::Zero();
        int count = 0;
        constexpr int kCells = 24;  // a midpoint rule over the ball
        for (int x = 0; x < kCells; ++x)
            for (int y = 0; y < kCells; ++y)
                for (int z = 0; z < kCells; ++z) {
                    const Vec3 p = radius_m * ((2.0 * Vec3(x, y, z).array() + 1.0) / kCells - 1.0).matrix();
                    if (p.norm() > radius_m) continue;
                    sum += analytic_n(scene, at_m + p);
                    ++count;
                }
        const Vec3 wanted = sum / count;
        const Vec3 felt = force_at(model, scene.meta.to_world(at_m));
        EXPECT_LT((felt - wanted).norm(), 0.015 * scene.field.force_n_max) << at_m.transpose();
    }
}

TEST(FieldModel, the_reported_error_holds_at_new_positions) {
    const Scene scene = scene_of(0.012);
    FieldModel model(scene.meta, scene.field, scene.grid), finest(scene.meta, scene.field, scene.grid);
    SeededRandom random(23);
    int beyond = 0, all = 0;
    for (int i = 0; i < 200; ++i) {
        const Vec3 world_m = 0.07 * Vec3(2.0 * random.uniform() - 1.0, 2.0 * random.uniform() - 1.0,
                                         2.0 * random.uniform() - 1.0);
        const Vec3 wanted = force_at(finest, world_m);
        for (const float level : {0.0F, 1.0F / 3.0F, 2.0F / 3.0F}) {
            const Vec3 felt = force_at(model, world_m, level);
            const double error = model.step(tool_at(world_m), budget_of(level)).load.error;
            beyond += (felt - wanted).norm() > error + 1e-6 ? 1 : 0;
            ++all;
        }
    }
    EXPECT_LE(beyond, all / 100);
}

TEST(FieldModel, a_level_changes_force_and_cost) {
    const Scene scene = scene_of(0.012);
    FieldModel model(scene.meta, scene.field, scene.grid);
    const Vec3 near_m = scene.meta.to_world(Vec3(-0.2, 0.03, 0.02));
    EXPECT_GT((force_at(model, near_m, 0.0F) - force_at(model, near_m, 1.0F)).norm(), 1e-5);
    EXPECT_EQ(model.items(0.0F), 8U);
    EXPECT_EQ(model.items(1.0F), 4096U);
}

TEST(FieldModel, no_closed_path_inside_the_box_gains_energy) {
    const Scene scene = scene_of(0.006);
    FieldModel model(scene.meta, scene.field, scene.grid);
    (void)force_at(model, Vec3(0.03, 0.0, 0.0));
    double work_j = 0.0, moved_j = 0.0;
    constexpr int kSteps = 40000;
    Vec3 before = Vec3(0.03, 0.0, 0.0);
    Vec3 force = force_at(model, before);
    for (int i = 1; i <= kSteps; ++i) {  // a tilted loop about one charge
        const double a = 2.0 * std::numbers::pi * i / kSteps;
        const Vec3 at = 0.03 * Vec3(std::cos(a), std::sin(a), 0.5 * std::sin(2.0 * a));
        const Vec3 now = model.step(tool_at(at), budget_of(1.0F)).wrench_world.force_n;
        const double dw = 0.5 * (now + force).dot(at - before);
        work_j += dw;
        moved_j += std::abs(dw);
        before = at;
        force = now;
    }
    EXPECT_GT(moved_j, 1e-3);
    EXPECT_LT(std::abs(work_j), 1e-6);
}

TEST(FieldModel, the_reported_stiffness_bounds_the_derivative_of_the_force) {
    const Scene scene = scene_of(0.0);
    FieldModel model(scene.meta, scene.field, scene.grid);
    EXPECT_EQ(model.stiffness().force_n_m, scene.field.stiffness_n_m);
    SeededRandom random(5);
    for (int i = 0; i < 300; ++i) {
        const Vec3 at = 0.07 * Vec3(2.0 * random.uniform() - 1.0, 2.0 * random.uniform() - 1.0,
                                    2.0 * random.uniform() - 1.0);
        const Vec3 d = 1e-5 * random.direction();
        const double k = (force_at(model, at + d) - force_at(model, at - d)).norm() / 2e-5;
        EXPECT_LT(k, 1.1 * scene.field.stiffness_n_m);
    }
}

TEST(FieldModel, outside_the_box_the_force_fades_to_zero) {
    const Scene scene = scene_of(0.002);
    FieldModel model(scene.meta, scene.field, scene.grid);
    const Vec3 step_m(scene.grid.spacing_m.x(), 0.0, 0.0), face_m(-0.5, 0.1, 0.0);
    EXPECT_GT(force_at(model, scene.meta.to_world(face_m)).norm(), 1e-3);
    EXPECT_EQ(force_at(model, scene.meta.to_world(face_m - FieldModel::kFadeSteps * 1.01 * step_m)).norm(),
              0.0);
}

std::unique_ptr<ForceModel> make() {
    static const Scene scene = scene_of(0.012);
    return std::make_unique<FieldModel>(scene.meta, scene.field, scene.grid);
}

INSTANTIATE_TEST_SUITE_P(Field, ForceModelContract,
                         testing::Values(ForceModelCase{"two_charges",
                                                        &make,
                                                        {Vec3(0.0, 0.05, 0.0), Quat::Identity()},
                                                        {Vec3(-0.02, 0.005, 0.0), Quat::Identity()},
                                                        0.05}),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace tact
