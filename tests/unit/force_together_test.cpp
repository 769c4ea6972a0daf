// Copies that move together with the body in the hand: they keep their symmetry, the force stays that of an energy, and what moves
// along is not subtracted.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>

#include "ipc/base/random.hpp"
#include "ipc/base/units.hpp"
#include "ipc/topics/command.hpp"
#include "tests/unit/force_rod_scene.hpp"

namespace tact::force_together_test {
namespace {

using rod::kA;

Structure with_elements(Structure s) {
    s.element.assign(s.size(), 6);
    return s;
}
const Structure& rod_structure() {
    static const Structure s = with_elements(rod::scene().rod);
    return s;
}

// Element k of D2 about axes through the middle of the map.
Pose element(int k) {
    const Quat turns[] = {Quat::Identity(), Quat(0, 1, 0, 0), Quat(0, 0, 1, 0), Quat(0, 0, 0, 1)};
    const Vec3 middle_m = Vec3::Constant(rod::kCentre);
    return {middle_m - turns[k] * middle_m, turns[k]};
}
Pose first() {
    return {Vec3::Constant(rod::kCentre) + Vec3(9.0, 11.0, 7.0) * kA,
            quat_from_rotation_vector(Vec3(0.4, -0.2, 0.7))};
}

// Four copies related by D2, the first in the hand, and a fifth body of another structure.
std::unique_ptr<DockingModel> make_model(bool last_copy_fixed = false) {
    const rod::Scene& s = rod::scene();
    SceneMeta meta = s.meta;
    meta.body_count = 2;
    meta.resolution_m = 10.0 * kA;
    Structure other = rod_structure();
    other.name = "other";
    DockingSettings settings;
    for (int k = 0; k < 4; ++k)
        settings.bodies.push_back({0, element(k) * first(), last_copy_fixed && k == 3, k == 0});
    settings.bodies.push_back(
        {1, {Vec3::Constant(rod::kCentre) - Vec3(20.0, 0.0, 0.0) * kA, Quat::Identity()}, false, false});
    return std::make_unique<DockingModel>(meta, s.grid, std::vector<Structure>{rod_structure(), other},
                                          std::vector<Codebook>{s.codebook, s.codebook}, settings);
}

void turn(DockingModel& model, std::uint32_t options, bool on) {
    ASSERT_TRUE(model.set_options(options, on));
}

Pose hand(double t) {
    return {0.01 * Vec3(std::sin(3.0 * t), std::cos(5.0 * t), std::sin(2.0 * t)),
            quat_from_rotation_vector(0.4 * Vec3(std::sin(2.0 * t), std::sin(t), std::cos(3.0 * t)))};
}

void move(DockingModel& model, int steps) {
    for (int i = 0; i < steps; ++i) {
        model.drive({.step_s = 0.001});
        static_cast<void>(model.step(rod::tool_at(hand(0.001 * i)), rod::at(0.5F)));
    }
}

TEST(Together, copies_related_by_a_symmetry_stay_related_by_it) {
    const auto model = make_model();
    turn(*model, kDockingTogether, true);
    EXPECT_EQ(model->bodies().options, kDockingTogether);
    model->reset(rod::tool_at(hand(0.0)));
    const ModelBodies before = model->bodies();
    move(*model, 20'000);
    const ModelBodies after = model->bodies();
    EXPECT_GT((after.T_model_body[0].p_m - before.T_model_body[0].p_m).norm(), 1.0 * kA);
    for (int k = 1; k < 4; ++k) {
        const Pose expected = element(k) * after.T_model_body[0],
                   &is = after.T_model_body[static_cast<std::size_t>(k)];
        EXPECT_LT((is.p_m - expected.p_m).norm(), 1e-6 * kA) << k;
        EXPECT_LT(is.q.angularDistance(expected.q), 1e-8) << k;
    }
    EXPECT_EQ(after.T_model_body[4].p_m, before.T_model_body[4].p_m) << "of another structure";
    EXPECT_EQ(after.placements, before.placements);
    // The hand takes another copy: it leads then.
    ModelOrder select;
    select.body = after.id[2];
    ASSERT_TRUE(model->order(select));
    move(*model, 3000);
    const ModelBodies last = model->bodies();
    EXPECT_GT((last.T_model_body[2].p_m - after.T_model_body[2].p_m).norm(), 0.1 * kA);
    for (const int k : {0, 1, 3}) {
        const Pose expected = element(k) * element(2).inverse() * last.T_model_body[2];
        EXPECT_LT((last.T_model_body[static_cast<std::size_t>(k)].p_m - expected.p_m).norm(), 1e-6 * kA) << k;
    }
}

TEST(Together, fixed_copies_stay_and_without_the_option_all_do) {
    const auto model = make_model(true);
    model->reset(rod::tool_at(hand(0.0)));
    const ModelBodies before = model->bodies();
    move(*model, 500);
    for (std::size_t k = 1; k < 5; ++k)
        EXPECT_EQ(model->bodies().T_model_body[k].p_m, before.T_model_body[k].p_m);
    turn(*model, kDockingTogether, true);
    move(*model, 500);
    EXPECT_NE(model->bodies().T_model_body[1].p_m, before.T_model_body[1].p_m);
    EXPECT_EQ(model->bodies().T_model_body[3].p_m, before.T_model_body[3].p_m);
    // A body that is placed moves alone: undo and searches set each body by itself.
    const ModelBodies here = model->bodies();
    ModelOrder place;
    place.kind = ModelOrder::Kind::place;
    place.body = here.id[0];
    place.T_model_body = first();
    ASSERT_TRUE(model->order(place));
    EXPECT_EQ(model->bodies().T_model_body[1].p_m, here.T_model_body[1].p_m);
}

TEST(Together, copies_that_move_along_are_not_subtracted) {
    const auto model = make_model();
    const Vec3 at_copy_m = element(1) * first().p_m;
    const auto density = [](const ForceModel& m, const Vec3& p_m) {
        Vec3 gradient;
        return dynamic_cast<const DockingModel&>(m).map().sample(p_m, gradient);
    };
    const auto rebuilt = [](const ForceModel& m) {
        std::unique_ptr<ForceModel> next = m.rebuild(m.bodies());
        EXPECT_TRUE(next && next->adopt(m));
        EXPECT_FALSE(next->stale());
        return next;
    };
    turn(*model, kDockingSubtraction, true);
    const std::unique_ptr<ForceModel> alone = rebuilt(*model);
    auto& one = dynamic_cast<DockingModel&>(*alone);
    turn(one, kDockingTogether, true);
    EXPECT_TRUE(one.stale()) << "less is subtracted now";
    const std::unique_ptr<ForceModel> together = rebuilt(one);
    EXPECT_GT(density(*together, at_copy_m), density(*alone, at_copy_m) + 0.01);
    auto& both = dynamic_cast<DockingModel&>(*together);
    both.reset(rod::tool_at(hand(0.0)));
    move(both, 200);
    EXPECT_FALSE(both.stale()) << "its motion changes no density";
    ModelOrder fix;
    fix.kind = ModelOrder::Kind::fix;
    fix.body = both.bodies().id[1];
    fix.on = true;
    ASSERT_TRUE(both.order(fix));
    EXPECT_TRUE(both.stale()) << "the fixed copy is subtracted again";
}

TEST(Together, the_command_is_that_of_the_option_and_the_stiffness_of_a_clash_may_double) {
    const auto model = make_model();
    turn(*model, kDockingClash, true);
    const double alone_n_m = model->stiffness().force_n_m;
    ModelOrder order;
    order.kind = ModelOrder::Kind::setting;
    order.command = static_cast<std::uint8_t>(CommandKind::set_together);
    order.on = true;
    ASSERT_TRUE(model->order(order));
    EXPECT_EQ(model->bodies().options_asked, kDockingClash | kDockingTogether);
    EXPECT_NEAR(model->stiffness().force_n_m - alone_n_m, model->clash_gains().stiffness_n_m_max, 1e-6);
    order.on = false;
    ASSERT_TRUE(model->order(order));
    EXPECT_EQ(model->bodies().options_asked, kDockingClash);
}

constexpr double kScale = 4e6;
constexpr ClashGains kGains{2.0, 100.0, 300.0, 0.0};
const ClashField& field() {
    static const ClashField made(rod_structure());
    return made;
}
ClashResult felt(const Pose& active, std::span<const ClashBody> others) {
    return clash_force({&field(), active}, others, kScale, kGains);
}
// The others after the active body has moved.
std::vector<ClashBody> followed(std::vector<ClashBody> others, const Pose& before, const Pose& now) {
    for (ClashBody& b : others)
        if (b.moves_along) b.T_model_body = b.T_model_body * (before.inverse() * now);
    return others;
}

// Anywhere, also where the copies have no symmetry.
RC_GTEST_PROP(Together, the_clash_wrench_is_the_gradient_of_its_energy_over_the_motion_of_all, ()) {
    SeededRandom random(*rc::gen::arbitrary<std::uint64_t>());
    const auto near = [&](double from_a, double to_a) {
        return Pose{(from_a + (to_a - from_a) * random.uniform()) * kA * random.direction(),
                    random.rotation()};
    };
    const Pose active = near(0.0, 1.0);
    const std::vector<ClashBody> others{{&field(), near(4.0, 25.0), true},
                                        {&field(), near(4.0, 25.0), true},
                                        {&field(), near(4.0, 25.0), false}};
    const Wrench here = felt(active, others).wrench_world;
    const auto energy_j = [&](const Pose& now) { return felt(now, followed(others, active, now)).energy_j; };
    for (int a = 0; a < 3; ++a) {
        const double step_m = 3e-5, turn_rad = 3e-3;
        Pose fore = active, back = active;
        fore.p_m[a] += step_m / kScale;
        back.p_m[a] -= step_m / kScale;
        const double force_n = -(energy_j(fore) - energy_j(back)) / (2.0 * step_m);
        RC_ASSERT(std::abs(here.force_n[a] - force_n) < 4e-3 + 1e-2 * std::abs(force_n));
        fore = back = active;
        const Quat turned = quat_from_rotation_vector(turn_rad * Vec3::Unit(a));
        fore.q = turned * active.q;
        back.q = turned.conjugate() * active.q;
        const double torque_n_m = -(energy_j(fore) - energy_j(back)) / (2.0 * turn_rad);
        RC_ASSERT(std::abs(here.torque_n_m[a] - torque_n_m) < 1e-4 + 1e-2 * std::abs(torque_n_m));
    }
}

// A two-fold axis: the neighbour's derivative mirrors the own one.
TEST(Together, symmetric_copies_push_as_the_one_neighbour_of_each_does) {
    const Quat half_turn(0, 0, 0, 1);
    const Pose active{Vec3(7.0, 1.0, 0.0) * kA, quat_from_rotation_vector(Vec3(0.3, 0.5, -0.2))};
    const Pose copy{half_turn * active.p_m, half_turn * active.q};
    const ClashBody along{&field(), copy, true}, still{&field(), copy, false};
    const Vec3 together_n = felt(active, {&along, 1}).wrench_world.force_n,
               alone_n = felt(active, {&still, 1}).wrench_world.force_n;
    ASSERT_GT(alone_n.norm(), 0.05);
    // Across the axis the neighbour's half doubles the own one; along it both go together, without any force.
    EXPECT_GT(together_n.head<2>().dot(alone_n.head<2>()),
              0.999 * together_n.head<2>().norm() * alone_n.head<2>().norm());
    EXPECT_GT(together_n.norm(), 0.02);
    EXPECT_NEAR(together_n.z(), 0.0, 1e-3 * alone_n.norm());
}

}  // namespace
}  // namespace tact::force_together_test
