// The docking model against the derivatives of its energy; its grip, clutch, rebuild and start.
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "ipc/base/error.hpp"
#include "rt/force/docking/docking_model.hpp"
#include "rt/force/docking/start_pose.hpp"
#include "tests/contract/force_model_contract.hpp"
#include "tests/unit/force_rod_scene.hpp"

namespace tact {
namespace {

using namespace rod;

INSTANTIATE_TEST_SUITE_P(Docking, ForceModelContract,
                         testing::Values(ForceModelCase{
                             .name = "rod",
                             .make = [] { return make_model(); },
                             .grip = kGrip,
                             .touch = kTouch,
                             .force_n_min = 0.05,
                             .step_n_max = 0.05,
                             // The smallest levels of the rod are nearly equally wrong, and the
                             // offset of a level change adds to the error.
                             .items_tolerance = 1e-6}),
                         [](const auto& tested) { return tested.param.name; });

// -k_E sum w rho, in double precision, one atom at a time.
double energy_j(const DockingModel& model, const Pose& T_model_body) {
    const Structure& rod = scene().rod;
    double sum = 0.0;
    Vec3 gradient;
    for (std::size_t i = 0; i < rod.size(); ++i) {
        const Vec3 b(static_cast<double>(rod.x_m[i]), static_cast<double>(rod.y_m[i]),
                     static_cast<double>(rod.z_m[i]));
        sum += static_cast<double>(rod.mass_fraction[i]) * model.map().sample(T_model_body * b, gradient);
    }
    return -scene().meta.energy_j_per_sigma * sum;
}

TEST(Docking, wrench_is_the_energy_gradient_over_tool_position_and_rotation) {
    const auto model = make_model();
    const double scale = scene().meta.world_per_model;
    SeededRandom random(3);
    for (int i = 0; i < 20; ++i) {
        const Pose body =
            start_pose(model->home(), 8.0 * kA * random.uniform(), random.uniform(), random.next());
        const Wrench wrench = model->evaluate(body, at(1.0F)).wrench_world;
        for (int a = 0; a < 3; ++a) {
            const double step_m = 1e-5, turn_rad = 1e-5;  // motion of the hand
            Pose fore = body, back = body;
            fore.p_m[a] += step_m / scale;
            back.p_m[a] -= step_m / scale;
            const double force_n = -(energy_j(*model, fore) - energy_j(*model, back)) / (2.0 * step_m);
            EXPECT_NEAR(wrench.force_n[a], force_n, 2e-4);
            fore = back = body;
            fore.q = quat_from_rotation_vector(turn_rad * Vec3::Unit(a)) * body.q;
            back.q = quat_from_rotation_vector(-turn_rad * Vec3::Unit(a)) * body.q;
            const double torque_n_m = -(energy_j(*model, fore) - energy_j(*model, back)) / (2.0 * turn_rad);
            EXPECT_NEAR(wrench.torque_n_m[a], torque_n_m, 1e-5);
        }
    }
}

TEST(Docking, a_closed_path_of_the_hand_gains_no_energy_at_any_level) {
    const auto model = make_model();
    for (const float fidelity : {0.0F, 0.37F, 1.0F}) {
        model->reset(tool_at(kGrip));
        for (int i = 0; i < 2000; ++i) (void)model->step(tool_at(kGrip), at(fidelity));
        double work_j = 0.0, size_j = 0.0;
        constexpr int kSteps = 4000;
        Pose before = kGrip;
        Wrench felt = model->step(tool_at(kGrip), at(fidelity)).wrench_world;
        for (int i = 1; i <= kSteps; ++i) {
            const double a = 2.0 * M_PI * i / kSteps;
            const Vec3 d(0.02 * std::sin(a), 0.015 * (1.0 - std::cos(a)), 0.01 * std::sin(2.0 * a));
            const Vec3 turn(0.5 * std::sin(a), 0.0, 0.4 * (1.0 - std::cos(a)));
            const Pose now{kGrip.p_m + d, quat_from_rotation_vector(turn) * kGrip.q};
            const Wrench next = model->step(tool_at(now), at(fidelity)).wrench_world;
            const Vec3 turned = rotation_vector_rad(now.q * before.q.conjugate());
            const double dw = 0.5 * (felt.force_n + next.force_n).dot(now.p_m - before.p_m) +
                              0.5 * (felt.torque_n_m + next.torque_n_m).dot(turned);
            work_j += dw;
            size_j += std::abs(dw);
            before = now;
            felt = next;
        }
        EXPECT_GT(size_j, 1e-4);
        EXPECT_LT(std::abs(work_j), 1e-4 * size_j) << "at " << fidelity;
    }
}

TEST(Docking, the_tool_moves_the_body_by_the_scale_and_turns_it_about_its_centre_of_mass) {
    const auto model = make_model();
    model->reset(tool_at(kGrip));
    (void)model->step(tool_at(kGrip), at(0.0F));
    EXPECT_LT((model->bodies().T_model_body[0].p_m - model->home().p_m).norm(), 1e-6 * kA);
    Pose hand = kGrip;
    hand.p_m += Vec3(0.01, 0.0, -0.02);
    (void)model->step(tool_at(hand), at(0.0F));
    const Vec3 moved = model->bodies().T_model_body[0].p_m - model->home().p_m;
    EXPECT_LT((moved - Vec3(0.01, 0.0, -0.02) / scene().meta.world_per_model).norm(), 1e-6 * kA);
    const Quat turn = quat_from_rotation_vector(Vec3(0.3, -0.2, 0.9));
    hand = kGrip;
    hand.q = turn * hand.q;
    (void)model->step(tool_at(hand), at(0.0F));
    EXPECT_LT((model->bodies().T_model_body[0].p_m - model->home().p_m).norm(), 1e-6 * kA);
    EXPECT_LT(model->bodies().T_model_body[0].q.angularDistance(turn * model->home().q), 1e-9);
}

TEST(Docking, with_the_clutch_held_the_tool_moves_alone_and_the_force_makes_no_step) {
    const auto model = make_model();
    model->reset(tool_at(kGrip));
    Wrench before = model->step(tool_at(kGrip), at(1.0F)).wrench_world;
    Pose hand = kGrip;
    for (int i = 0; i < 6000; ++i) {
        const bool clutch = i >= 2000 && i < 4000;
        if (i < 1000) hand.p_m.x() += 1e-5;
        if (clutch) hand.p_m.z() -= 2e-5, hand.q = quat_from_rotation_vector(Vec3(0, 2e-4, 0)) * hand.q;
        const Pose held = model->bodies().T_model_body[0];
        const StepResult result = model->step(tool_at(hand, clutch ? 1U : 0U), at(1.0F));
        ASSERT_LT((result.wrench_world.force_n - before.force_n).norm(), 0.05) << "step " << i;
        before = result.wrench_world;
        if (i >= 1001) {
            EXPECT_LT((model->bodies().T_model_body[0].p_m - held.p_m).norm(), 1e-9 * kA);
            EXPECT_LT(model->bodies().T_model_body[0].q.angularDistance(held.q), 1e-7);
        }
        if (i == 3999) {
            EXPECT_EQ(result.wrench_world.force_n, Vec3::Zero());
        }
        if (i == 1999 || i == 5999) {
            EXPECT_GT(result.wrench_world.force_n.norm(), 0.05);
        }
    }
}

TEST(Docking, a_partial_step_recomputes_its_fraction_and_its_error_bounds_the_rest) {
    const Scene big = make_scene(4096);
    DockingModel model(big.meta, big.grid, {big.rod}, {big.codebook}, {});
    for (const float fidelity : {1.0F, 0.9F}) {  // 0.9 blends two large levels
        model.reset(tool_at(kGrip));
        Pose hand = kGrip;
        for (int i = 0; i < 600; ++i) {
            hand.p_m += Vec3(1e-5, -5e-6, 4e-6) * std::cos(0.01 * i);  // 10 mm/s at 1 kHz
            hand.q = quat_from_rotation_vector(Vec3(1e-4, 2e-4, 0)) * hand.q;
            Budget budget = at(fidelity);
            budget.work_fraction = i < 300 ? 1.0F : 0.25F;
            const StepResult r = model.step(tool_at(hand), budget);
            ASSERT_EQ(r.status, StepStatus::ok);
            if (i < 300) continue;  // the ramp
            const StepResult whole = model.evaluate(model.bodies().T_model_body[0], budget);
            EXPECT_EQ(whole.load.recomputed_fraction, 1.0F);  // evaluate() keeps no partial sums
            EXPECT_NEAR(r.load.recomputed_fraction, 0.25F, 1e-3F);
            EXPECT_EQ(r.load.items, whole.load.items);
            EXPECT_GT(r.load.error, whole.load.error);
            EXPECT_LT(r.load.error, whole.load.error + 0.1);
            EXPECT_LE((r.wrench_world.force_n - whole.wrench_world.force_n).norm(),
                      r.load.error - whole.load.error + 1e-5);
        }
    }
    ModelOrder place;
    place.kind = ModelOrder::Kind::place;
    place.body = 1;
    place.T_model_body = start_pose(model.home(), 10.0 * kA, 0.1, 1);
    ASSERT_TRUE(model.order(place));
    Budget budget = at(1.0F);
    budget.work_fraction = 0.25F;
    EXPECT_EQ(model.step(tool_at(kGrip), budget).load.recomputed_fraction,
              1.0F);  // a moved body is summed completely
}

TEST(Docking, a_model_can_be_rebuilt_while_it_is_stepped_and_gets_orders) {
    const auto model = make_model();
    model->reset(tool_at(kGrip));
    const ModelBodies then = model->bodies();
    std::unique_ptr<ForceModel> rebuilt;
    std::thread builder([&] { rebuilt = model->rebuild(then); });
    ModelOrder add, select;
    add.kind = ModelOrder::Kind::add;
    add.T_model_body = model->home();
    EXPECT_TRUE(model->order(add));
    select.body = 2;
    EXPECT_TRUE(model->order(select));
    for (int i = 0; i < 500; ++i) (void)model->step(tool_at(kGrip), at(0.5F));
    builder.join();
    ASSERT_NE(rebuilt, nullptr);
    ASSERT_TRUE(rebuilt->adopt(*model));
    EXPECT_EQ(rebuilt->bodies().count, 2U);  // orders during the rebuild are kept
    EXPECT_EQ(rebuilt->bodies().active, 1U);
    EXPECT_TRUE(rebuilt->order(add));
    EXPECT_EQ(rebuilt->bodies().id[2], 3U);
    EXPECT_FALSE(make_model()->adopt(*model));  // belongs to another scene
}

TEST(Docking, starts_with_the_given_bodies) {
    DockingSettings settings;
    const Pose place = start_pose(Pose{Vec3::Constant(kCentre), Quat::Identity()}, 9.0 * kA, 0.3, 2);
    settings.bodies = {{.structure = 0, .T_model_body = place, .fixed = true},
                       {.structure = 0, .T_model_body = place, .in_hand = true}};
    settings.more_bodies = {{}};
    settings.more_bodies[0].T_model_body = place;
    const ModelBodies bodies = make_model(settings)->bodies();
    ASSERT_EQ(bodies.count, 3U);
    EXPECT_EQ(bodies.active, 1U);
    EXPECT_EQ(bodies.flags[0], ModelBodies::kFixed);
    EXPECT_EQ(bodies.T_model_body[0].p_m, place.p_m);
    settings.bodies[0].structure = 1;
    EXPECT_THROW(make_model(settings), StartupError);
    settings.bodies[0].structure = 0;
    settings.bodies[0].T_model_body.p_m.x() = 1.0;  // 1 m away in model coordinates
    EXPECT_THROW(make_model(settings), StartupError);
    settings.bodies.resize(16);
    EXPECT_THROW(make_model(settings), StartupError);
}

TEST(Docking, start_pose_follows_the_settings_and_repeats) {
    DockingSettings settings;
    settings.start_offset_m = 15.0 * kA;
    settings.start_rotation_rad = 0.5;
    settings.seed = 42;
    const Pose a = make_model(settings)->bodies().T_model_body[0],
               b = make_model(settings)->bodies().T_model_body[0];
    EXPECT_EQ(a.p_m, b.p_m);
    EXPECT_EQ(a.q.coeffs(), b.q.coeffs());
    EXPECT_NEAR((a.p_m - Vec3::Constant(kCentre)).norm(), 15.0 * kA, 1e-9 * kA);
    EXPECT_NEAR(a.q.angularDistance(Quat::Identity()), 0.5, 1e-9);
    settings.seed = 43;
    EXPECT_NE(make_model(settings)->bodies().T_model_body[0].p_m, a.p_m);
}

TEST(Docking, force_scale_scales_force_and_torque) {
    DockingSettings settings;
    settings.force_scale = 0.25;
    const Pose body = start_pose(make_model()->home(), 6.0 * kA, 0.2, 5);
    const Wrench full = make_model()->evaluate(body, at(1.0F)).wrench_world;
    const Wrench quarter = make_model(settings)->evaluate(body, at(1.0F)).wrench_world;
    EXPECT_LT((0.25 * full.force_n - quarter.force_n).norm(), 1e-12);
    EXPECT_LT((0.25 * full.torque_n_m - quarter.torque_n_m).norm(), 1e-12);
}

TEST(Docking, refuses_broken_scenes) {
    const Scene& good = scene();
    const auto build = [](const Scene& s, std::size_t codebooks = 1) {
        return DockingModel(s.meta, s.grid, {s.rod}, std::vector<Codebook>(codebooks, s.codebook), {});
    };
    EXPECT_THROW(build(good, 2), StartupError);
    Scene s = good;
    s.meta.world_per_model = 0.0;
    EXPECT_THROW(build(s), StartupError);
    s = good;
    s.codebook.levels.clear();  // 1000 atoms and no level that always fits
    EXPECT_THROW(build(s), StartupError);
    s = good;
    std::swap(s.codebook.levels[0], s.codebook.levels[1]);
    EXPECT_THROW(build(s), StartupError);
    s = good;
    s.rod.x_m[3] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(build(s), StartupError);
    s = good;
    s.rod.mass_fraction[0] = 0.5F;
    EXPECT_THROW(build(s), StartupError);
    s = good;
    s.codebook.levels[0].weight.pop_back();
    EXPECT_THROW(build(s), StartupError);
    DockingSettings settings;
    settings.force_scale = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(make_model(settings), StartupError);
}

}  // namespace
}  // namespace tact
