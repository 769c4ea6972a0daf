// Options of the docking force besides density: clash, subtraction, contours; tested through the model.
#include <gtest/gtest.h>

#include <cmath>

#include "ipc/scene/density/docking_gain.hpp"
#include "ipc/scene/density/laplacian_map.hpp"
#include "ipc/scene/density/simulated_map.hpp"
#include "ipc/topics/command.hpp"
#include "rt/force/docking/docking_model.hpp"
#include "rt/force/docking/start_pose.hpp"

namespace tact::force_docking_options_test {
namespace {

constexpr double kA = 1e-10;

Structure cloud(const char* name, const Vec3& home_m, std::uint64_t seed) {
    Structure s;
    s.name = name;
    s.home_com_model_m = home_m;
    SeededRandom random(seed);
    constexpr std::size_t kAtoms = 400;
    s.mass_u = 13.0 * kAtoms;
    for (std::size_t i = 0; i < kAtoms; ++i) {
        const Vec3 p = std::cbrt(random.uniform()) * random.direction();
        s.x_m.push_back(static_cast<float>(16.0 * kA * p.x()));
        s.y_m.push_back(static_cast<float>(12.0 * kA * p.y()));
        s.z_m.push_back(static_cast<float>(9.0 * kA * p.z()));
        s.mass_fraction.push_back(1.0F / kAtoms);
        s.element.push_back(6);
    }
    return s;
}

// Two clouds of atoms side by side, and their common map.
struct Scene {
    SceneMeta meta{};
    DensityGrid grid;
    std::vector<Structure> structures{cloud("left", Vec3(45.0, 60.0, 60.0) * kA, 1),
                                      cloud("right", Vec3(75.0, 60.0, 60.0) * kA, 2)};
    std::vector<Codebook> codebooks{2};

    Scene() {
        meta.kind = SceneKind::docking;
        meta.body_count = 2;
        meta.world_per_model = 0.16 / (120.0 * kA);
        for (double& c : meta.centre_model_m) c = 60.0 * kA;
        meta.map_background = 0.0;
        meta.resolution_m = 12.0 * kA;
        grid.size = {41, 41, 41};
        grid.spacing_m = Vec3::Constant(3.0 * kA);
        const PlacedStructure both[] = {{&structures[0], structures[0].home()},
                                        {&structures[1], structures[1].home()}};
        grid.values = simulated_map(grid, both, meta.resolution_m);
        meta.map_sigma = rms_of(grid);
        meta.energy_j_per_sigma =
            docking_gain(make_level_maps(grid, 0.0, meta.map_sigma, meta.resolution_m,
                                         level_smoothings_m(structures, codebooks, meta.resolution_m)),
                         structures, codebooks, meta.world_per_model)
                .energy_j_per_sigma;
    }
};

const Scene& scene() {
    static const Scene made;
    return made;
}

std::unique_ptr<DockingModel> make_model(const DockingSettings& settings = {}) {
    const Scene& s = scene();
    return std::make_unique<DockingModel>(s.meta, s.grid, s.structures, s.codebooks, settings);
}

bool set_option(ForceModel& model, std::uint32_t option, bool on) {
    return dynamic_cast<DockingModel&>(model).set_options(option, on);
}

// A copy with the requested options, built separately and adopted.
std::unique_ptr<ForceModel> rebuilt(const ForceModel& model) {
    std::unique_ptr<ForceModel> next = model.rebuild(model.bodies());
    EXPECT_TRUE(next && next->adopt(model));
    return next;
}

double density_at(const ForceModel& model, const Vec3& p_m) {
    Vec3 gradient;
    return dynamic_cast<const DockingModel&>(model).map().sample(p_m, gradient);
}

Wrench force_at(const ForceModel& model, const Pose& pose) {
    return dynamic_cast<const DockingModel&>(model).evaluate(pose, Budget{}).wrench_world;
}

TEST(DockingOptions, subtraction_removes_the_density_of_the_other_body_only) {
    const auto model = make_model();
    const Vec3 own = scene().structures[0].home_com_model_m, other = scene().structures[1].home_com_model_m;
    const double own_before = density_at(*model, own), other_before = density_at(*model, other);
    ASSERT_TRUE(set_option(*model, kDockingSubtraction, true));
    EXPECT_TRUE(model->stale());
    EXPECT_EQ(model->bodies().options, 0U);
    const auto next = rebuilt(*model);
    EXPECT_FALSE(next->stale());
    EXPECT_EQ(next->bodies().options, kDockingSubtraction);
    EXPECT_LT(std::abs(density_at(*next, other)), 0.05 * other_before);
    EXPECT_NEAR(density_at(*next, own), own_before, 0.05 * own_before);
    // A body at the other body's position is pulled home, not deeper in.
    Pose between = scene().structures[0].home();
    between.p_m.x() += 14.0 * kA;
    EXPECT_LT(force_at(*next, between).force_n.x(), -0.1);
    EXPECT_GT(force_at(*next, between).force_n.norm(), force_at(*model, between).force_n.norm());
    // Switching off takes effect at once, without a rebuild.
    ASSERT_TRUE(set_option(*next, kDockingSubtraction, false));
    EXPECT_FALSE(next->stale());
    EXPECT_NEAR(density_at(*next, other), other_before, 1e-6 * other_before);
}

TEST(DockingOptions, contours_make_forces_as_large_as_the_density) {
    const auto model = make_model();
    ASSERT_TRUE(set_option(*model, kDockingLaplacian, true));
    const auto next = rebuilt(*model);
    EXPECT_EQ(next->bodies().options, kDockingLaplacian);
    SeededRandom random(4);
    const Structure& left = scene().structures[0];
    double most_n = 0.0;
    for (int i = 0; i < 300; ++i) {
        const Pose pose =
            start_pose(left.home(), 20.0 * kA * random.uniform(), 0.5 * random.uniform(), random.next());
        const Vec3 force_n = force_at(*next, pose).force_n;
        most_n = std::max(most_n, force_n.norm());
        Pose fore = pose, back = pose;
        const int a = i % 3;
        fore.p_m[a] += 0.5 * kA, back.p_m[a] -= 0.5 * kA;
        const double stiffness_n_m = (force_at(*next, fore).force_n - force_at(*next, back).force_n).norm() /
                                     (kA * scene().meta.world_per_model);
        ASSERT_LT(stiffness_n_m, 330.0);
    }
    EXPECT_LT(most_n, 3.3);
    EXPECT_GT(most_n, 0.3);
    // At its own position the body is at rest; from beside it is pulled back.
    Pose away = left.home();
    away.p_m.z() += 6.0 * kA;
    EXPECT_LT(force_at(*next, away).force_n.z(), -0.05);
}

TEST(DockingOptions, both_options_give_the_contours_of_the_remaining_density) {
    const auto model = make_model();
    ASSERT_TRUE(set_option(*model, kDockingLaplacian | kDockingSubtraction, true));
    const auto next = rebuilt(*model);
    EXPECT_EQ(next->bodies().options, kDockingLaplacian | kDockingSubtraction);
    const Vec3 other = scene().structures[1].home_com_model_m, own = scene().structures[0].home_com_model_m;
    EXPECT_GT(density_at(*next, own), 0.0);
    EXPECT_LT(std::abs(density_at(*next, other)), 0.2 * density_at(*next, own));
}

TEST(DockingOptions, the_contour_scale_does_not_depend_on_the_order_of_the_options) {
    const Vec3 own = scene().structures[0].home_com_model_m;
    const auto both = make_model();
    ASSERT_TRUE(set_option(*both, kDockingLaplacian | kDockingSubtraction, true));
    const auto at_once = rebuilt(*both);
    const auto model = make_model();
    ASSERT_TRUE(set_option(*model, kDockingLaplacian, true));
    const auto whole = rebuilt(*model);
    ASSERT_TRUE(set_option(*whole, kDockingSubtraction, true));
    const auto after = rebuilt(*whole);
    EXPECT_EQ(density_at(*after, own), density_at(*at_once, own));
    ASSERT_TRUE(set_option(*after, kDockingSubtraction, false));
    EXPECT_EQ(density_at(*rebuilt(*after), own), density_at(*whole, own));
    EXPECT_EQ(density_at(*make_model(), own), density_at(*model, own));
}

TEST(DockingOptions, a_clash_acts_at_once_without_a_force_step) {
    const auto model = make_model();
    Pose overlapping = scene().structures[1].home();
    overlapping.p_m.x() -= 18.0 * kA;
    ModelOrder place;
    place.kind = ModelOrder::Kind::place;
    place.body = model->bodies().id[0];
    place.T_model_body = overlapping;
    ASSERT_TRUE(model->order(place));
    ToolState tool;
    model->reset(tool);
    Vec3 before = Vec3::Zero();
    const auto steps = [&] {
        double most = 0.0;
        for (int i = 0; i < 1000; ++i) {
            const StepResult now = model->step(tool, Budget{});
            most = std::max(most, (now.wrench_world.force_n - before).norm());
            before = now.wrench_world.force_n;
        }
        return most;
    };
    EXPECT_LT(steps(), 0.06);
    const Wrench without = force_at(*model, overlapping);
    ASSERT_TRUE(set_option(*model, kDockingClash, true));
    EXPECT_FALSE(model->stale());
    EXPECT_EQ(model->bodies().options, kDockingClash);
    const Wrench with = force_at(*model, overlapping);
    const ClashField left(scene().structures[0]), right(scene().structures[1]);
    const ClashBody other{&right, model->bodies().T_model_body[1]};
    const Wrench clash =
        clash_force({&left, overlapping}, {&other, 1}, scene().meta.world_per_model, model->clash_gains())
            .wrench_world;
    EXPECT_LT(clash.force_n.x(), -0.1);
    EXPECT_LT((with.force_n - without.force_n - clash.force_n).norm(), 1e-9);
    EXPECT_LT((with.torque_n_m - without.torque_n_m - clash.torque_n_m).norm(), 1e-10);
    EXPECT_LT(steps(), 0.06);
    EXPECT_LT((before - with.force_n).norm(), 1e-6);
    // The option survives a rebuild, and a failed rebuild.
    ASSERT_TRUE(set_option(*model, kDockingLaplacian, true));
    EXPECT_EQ(rebuilt(*model)->bodies().options, kDockingClash | kDockingLaplacian);
    model->give_up();
    EXPECT_EQ(model->bodies().options, kDockingClash);
    EXPECT_FALSE(model->stale());
    ASSERT_TRUE(set_option(*model, kDockingClash, false));
    EXPECT_LT((force_at(*model, overlapping).force_n - without.force_n).norm(), 1e-9);
}

TEST(DockingOptions, an_order_between_adopt_and_step_does_not_interrupt_the_force) {
    DockingSettings settings;
    settings.start_offset_m = 6.0 * kA;
    const auto model = make_model(settings);
    ToolState tool;
    model->reset(tool);
    StepResult before;
    for (int i = 0; i < 2 * ForceFade::ramp_steps(1e-3); ++i) before = model->step(tool, Budget{});
    ASSERT_GT(before.wrench_world.force_n.norm(), 0.1);
    ASSERT_TRUE(set_option(*model, kDockingLaplacian, true));
    const auto next = rebuilt(*model);
    ASSERT_TRUE(set_option(*next, kDockingClash, true));
    const StepResult after = next->step(tool, Budget{});
    EXPECT_LT((after.wrench_world.force_n - before.wrench_world.force_n).norm(), 0.05);
}

bool add_place(ForceModel& model, std::uint32_t body, const Pose& place, double worth = 1.0) {
    ModelOrder order;
    order.kind = ModelOrder::Kind::setting;
    order.command = static_cast<std::uint8_t>(CommandKind::add_found_place);
    order.body = body;
    order.T_model_body = place;
    order.value = worth;
    return model.order(order);
}

Pose beside_home(double x_a) {
    Pose place = scene().structures[0].home();
    place.p_m.y() += x_a * kA;
    return place;
}

TEST(DockingOptions, places_found_pull_their_own_body_gently_and_begin_smoothly) {
    const auto model = make_model();
    ToolState tool;
    model->reset(tool);
    Vec3 before = Vec3::Zero();
    const auto steps = [&] {
        double most = 0.0;
        for (int i = 0; i < 2 * ForceFade::ramp_steps(1e-3); ++i) {
            const Vec3 f = model->step(tool, Budget{}).wrench_world.force_n;
            most = std::max(most, (f - before).norm());
            before = f;
        }
        return most;
    };
    (void)steps();
    const Pose here = model->bodies().T_model_body[0];
    const Wrench without = force_at(*model, here);
    const ModelStiffness stiffness = model->stiffness();
    ASSERT_TRUE(set_option(*model, kDockingPull, true));
    EXPECT_FALSE(model->stale());
    EXPECT_EQ(model->bodies().options, kDockingPull);
    EXPECT_EQ(force_at(*model, here).force_n, without.force_n);  // no place yet
    ASSERT_TRUE(add_place(*model, 1, beside_home(-60.0)));
    ASSERT_TRUE(add_place(*model, 1, beside_home(30.0)));
    EXPECT_EQ(model->bodies().places, 2U);
    EXPECT_LT(steps(), 0.06);  // as any change of the force, without a jump
    const Vec3 pull = force_at(*model, here).force_n - without.force_n;
    EXPECT_GT(pull.y(), 0.3);  // to the nearer one
    EXPECT_LE(pull.norm(), BasinPull::kForce_n);
    EXPECT_EQ(model->bodies().place, 1U);
    EXPECT_NEAR(model->bodies().pull_n, pull.norm(), 1e-9);
    EXPECT_LT((before - without.force_n - pull).norm(), 1e-6);
    EXPECT_NEAR(model->stiffness().force_n_m - stiffness.force_n_m, BasinPull::kStiffness_n_m, 1e-6);
    EXPECT_GT(model->stiffness().torque_n_m_rad, stiffness.torque_n_m_rad);

    // It survives a rebuild and a failed rebuild.
    ASSERT_TRUE(set_option(*model, kDockingLaplacian, true));
    const auto next = rebuilt(*model);
    EXPECT_EQ(next->bodies().options, kDockingPull | kDockingLaplacian);
    EXPECT_EQ(next->bodies().places, 2U);
    model->give_up();
    EXPECT_EQ(model->bodies().options, kDockingPull);

    // Another body is not pulled, until it has places of its own.
    ModelOrder select;
    select.body = 2;
    ASSERT_TRUE(model->order(select));
    EXPECT_EQ(model->bodies().places, 0U);
    const Pose other = model->bodies().T_model_body[1];
    const auto plain = make_model();
    ASSERT_TRUE(plain->order(select));
    EXPECT_EQ(force_at(*model, other).force_n, force_at(*plain, other).force_n);
    ASSERT_TRUE(add_place(*model, 2, beside_home(30.0)));
    EXPECT_EQ(model->bodies().places, 1U);
    EXPECT_NE(force_at(*model, other).force_n, force_at(*plain, other).force_n);
    ASSERT_TRUE(set_option(*model, kDockingPull, false));
    EXPECT_EQ(force_at(*model, other).force_n, force_at(*plain, other).force_n);
}

// Far from any other change, which would fade too.
TEST(DockingOptions, places_that_come_and_go_change_the_force_smoothly) {
    const auto model = make_model();
    ToolState tool;
    model->reset(tool);
    const Pose here = model->bodies().T_model_body[0];
    Vec3 before = Vec3::Zero();
    const auto steps = [&] {
        double most = 0.0;
        for (int i = 0; i < 4 * ForceFade::ramp_steps(1e-3); ++i) {
            const Vec3 f = model->step(tool, Budget{}).wrench_world.force_n;
            most = std::max(most, (f - before).norm());
            before = f;
        }
        return most;
    };
    ASSERT_TRUE(set_option(*model, kDockingPull, true));
    (void)steps();
    const Vec3 without = force_at(*model, here).force_n;
    ASSERT_TRUE(add_place(*model, 1, beside_home(30.0)));
    EXPECT_GT((force_at(*model, here).force_n - without).norm(), 0.3);
    EXPECT_LT(steps(), 0.06);
    ModelOrder clear;
    clear.command = static_cast<std::uint8_t>(CommandKind::clear_found_places);
    clear.kind = ModelOrder::Kind::setting;
    ASSERT_TRUE(model->order(clear));
    EXPECT_LT(steps(), 0.06);
    EXPECT_LT((before - without).norm(), 1e-6);
}

TEST(DockingOptions, impossible_places_are_refused) {
    const auto model = make_model();
    EXPECT_FALSE(add_place(*model, 9, beside_home(0.0)));
    Pose far = beside_home(0.0);
    far.p_m.x() = 1.0;
    EXPECT_FALSE(add_place(*model, 1, far));
    far.p_m.x() = std::nan("");
    EXPECT_FALSE(add_place(*model, 1, far));
    for (const double worth : {-0.1, 1.1, std::nan("")})
        EXPECT_FALSE(add_place(*model, 1, beside_home(0.0), worth));
    EXPECT_EQ(model->bodies().places, 0U);
    for (std::size_t i = 0; i < BasinPull::kMax; ++i) EXPECT_TRUE(add_place(*model, 1, beside_home(0.0)));
    EXPECT_FALSE(add_place(*model, 1, beside_home(0.0)));
    EXPECT_EQ(model->bodies().places, BasinPull::kMax);
    ModelOrder clear;
    clear.kind = ModelOrder::Kind::setting;
    clear.command = static_cast<std::uint8_t>(CommandKind::clear_found_places);
    EXPECT_TRUE(model->order(clear));
    EXPECT_EQ(model->bodies().places, 0U);
}

TEST(DockingOptions, force_scale_scales_the_clash_too) {
    DockingSettings settings;
    settings.force_scale = 0.5;
    const auto full = make_model(), half = make_model(settings);
    Pose overlapping = scene().structures[1].home();
    overlapping.p_m.x() -= 18.0 * kA;
    for (DockingModel* model : {full.get(), half.get()}) ASSERT_TRUE(set_option(*model, kDockingClash, true));
    EXPECT_LT((0.5 * force_at(*full, overlapping).force_n - force_at(*half, overlapping).force_n).norm(),
              1e-9);
}

TEST(DockingOptions, a_command_turns_its_option_on_and_off) {
    const auto model = make_model();
    ModelOrder order;
    order.kind = ModelOrder::Kind::setting;
    for (const auto& [command, option] : {std::pair(CommandKind::set_clash, kDockingClash),
                                          std::pair(CommandKind::set_subtraction, kDockingSubtraction),
                                          std::pair(CommandKind::set_laplacian, kDockingLaplacian),
                                          std::pair(CommandKind::set_pull, kDockingPull),
                                          std::pair(CommandKind::set_flexible, kDockingFlexible),
                                          std::pair(CommandKind::set_together, kDockingTogether)}) {
        order.command = static_cast<std::uint8_t>(command);
        order.on = true;
        ASSERT_TRUE(model->order(order));
        EXPECT_EQ(model->bodies().options_asked, option);
        order.on = false;
        ASSERT_TRUE(model->order(order));
        EXPECT_EQ(model->bodies().options_asked, 0U);
    }
    order.command = static_cast<std::uint8_t>(CommandKind::set_detail_filter);  // belongs to another system
    EXPECT_FALSE(model->order(order));
}

TEST(DockingOptions, unknown_options_are_refused) {
    const auto model = make_model();
    EXPECT_FALSE(set_option(*model, 0, true));
    EXPECT_FALSE(set_option(*model, 1U << 9, true));
    EXPECT_FALSE(set_option(*model, kDockingClash | (1U << 9), true));
    EXPECT_EQ(model->bodies().options_asked, 0U);
}

}  // namespace
}  // namespace tact::force_docking_options_test
