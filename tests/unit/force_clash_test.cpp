// The clash force against the gradient of its energy; the clash field against known depths.
#include "rt/force/docking/clash_force.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "ipc/base/error.hpp"
#include "ipc/base/random.hpp"

namespace tact::force_clash_test {
namespace {

constexpr double kA = 1e-10, kScale = 6e6;
const ClashGains kGains{2.0, 150.0};

// An ellipsoid filled with atoms about 3 A apart.
Structure blob(const Vec3& radii_m, std::uint64_t seed) {
    Structure s;
    s.name = "blob";
    SeededRandom random(seed);
    const double step_m = 2.5 * kA;
    for (double x = -radii_m.x(); x <= radii_m.x(); x += step_m) {
        for (double y = -radii_m.y(); y <= radii_m.y(); y += step_m) {
            for (double z = -radii_m.z(); z <= radii_m.z(); z += step_m) {
                const Vec3 p = Vec3(x, y, z) + random.within(0.5 * kA);
                if (p.cwiseQuotient(radii_m).norm() > 1.0) continue;
                s.x_m.push_back(static_cast<float>(p.x()));
                s.y_m.push_back(static_cast<float>(p.y()));
                s.z_m.push_back(static_cast<float>(p.z()));
                s.mass_fraction.push_back(1.0F);
            }
        }
    }
    return s;
}

constexpr double kBallRadiusM = 15.0 * kA;
const Structure kBall = blob(Vec3::Constant(kBallRadiusM), 1), kEgg = blob(Vec3(22.0, 12.0, 9.0) * kA, 2);
const ClashField& ball() {
    static const ClashField field(kBall);
    return field;
}
const ClashField& egg() {
    static const ClashField field(kEgg);
    return field;
}
const ClashField& rod() {
    static const ClashField field(blob(Vec3(5.0, 5.0, 20.0) * kA, 3));
    return field;
}

// One body in the middle and two around it that touch it or nearly touch it.
struct Crowd {
    ClashBody active;
    std::array<ClashBody, 2> others;
};

Crowd crowd(std::uint64_t seed) {
    SeededRandom random(seed);
    const auto near = [&](double from_a, double to_a) {
        return Pose{Vec3(10.0, -20.0, 5.0) * kA +
                        (from_a + (to_a - from_a) * random.uniform()) * kA * random.direction(),
                    random.rotation()};
    };
    return {{&egg(), near(0.0, 1.0)},
            {ClashBody{&ball(), near(15.0, 40.0)}, ClashBody{&rod(), near(10.0, 30.0)}}};
}

ClashResult felt(const Crowd& c) { return clash_force(c.active, c.others, kScale, kGains); }

RC_GTEST_PROP(Clash, wrench_is_the_energy_gradient_over_position_and_rotation, ()) {
    const Crowd c = crowd(*rc::gen::arbitrary<std::uint64_t>());
    const ClashResult here = felt(c);
    for (int a = 0; a < 3; ++a) {
        const double step_m = 3e-5, turn_rad = 3e-3;  // motion of the hand: 0.05 A, 0.2 degrees
        Crowd fore = c, back = c;
        fore.active.T_model_body.p_m[a] += step_m / kScale;
        back.active.T_model_body.p_m[a] -= step_m / kScale;
        const double force_n = -(felt(fore).energy_j - felt(back).energy_j) / (2.0 * step_m);
        RC_ASSERT(std::abs(here.wrench_world.force_n[a] - force_n) < 2e-3 + 5e-3 * std::abs(force_n));
        fore = back = c;
        const Quat turn = quat_from_rotation_vector(turn_rad * Vec3::Unit(a));
        fore.active.T_model_body.q = turn * c.active.T_model_body.q;
        back.active.T_model_body.q = turn.conjugate() * c.active.T_model_body.q;
        const double torque_n_m = -(felt(fore).energy_j - felt(back).energy_j) / (2.0 * turn_rad);
        RC_ASSERT(std::abs(here.wrench_world.torque_n_m[a] - torque_n_m) <
                  3e-5 + 5e-3 * std::abs(torque_n_m));
    }
}

RC_GTEST_PROP(Clash, forces_on_the_two_bodies_are_opposite, ()) {
    const Crowd c = crowd(*rc::gen::arbitrary<std::uint64_t>());
    const ClashBody &a = c.active, &b = c.others[0];
    const ClashResult on_a = clash_force(a, {&b, 1}, kScale, kGains);
    const ClashResult on_b = clash_force(b, {&a, 1}, kScale, kGains);
    RC_ASSERT(std::abs(on_a.energy_j - on_b.energy_j) <= 1e-9 + 1e-5 * on_a.energy_j);
    const Vec3 sum_n = on_a.wrench_world.force_n + on_b.wrench_world.force_n;
    RC_ASSERT(sum_n.norm() <= 1e-6 + 1e-4 * on_a.wrench_world.force_n.norm());
    // About a common point the torques cancel too.
    const Vec3 arm_m = kScale * (b.T_model_body.p_m - a.T_model_body.p_m);
    const Vec3 turned =
        on_a.wrench_world.torque_n_m + on_b.wrench_world.torque_n_m + arm_m.cross(on_b.wrench_world.force_n);
    RC_ASSERT(turned.norm() <= 1e-7 + 1e-3 * on_a.wrench_world.torque_n_m.norm());
}

RC_GTEST_PROP(Clash, pushes_overlapping_bodies_apart, ()) {
    Crowd c = crowd(*rc::gen::arbitrary<std::uint64_t>());
    const ClashResult near = clash_force(c.active, {c.others.data(), 1}, kScale, kGains);
    const Vec3 away = c.active.T_model_body.p_m - c.others[0].T_model_body.p_m;
    // Both bodies are convex: the energy never rises on a straight path away from the other's centre, unless the
    // overlap reaches past that centre; then the shortest way out differs.
    if (near.depth_model_m < kBallRadiusM)
        RC_ASSERT(near.wrench_world.force_n.dot(away.normalized()) > -1e-6);
}

TEST(Clash, a_closed_path_of_the_hand_gains_no_energy) {
    const Crowd start = crowd(7);
    double work_j = 0.0, size_j = 0.0;
    constexpr int kSteps = 3000;
    Crowd before = start;
    ClashResult last = felt(before);
    for (int i = 1; i <= kSteps; ++i) {
        const double a = 2.0 * M_PI * i / kSteps;
        Crowd now = start;
        now.active.T_model_body.p_m +=
            15.0 * kA * Vec3(std::sin(a), 1.0 - std::cos(a), 0.5 * std::sin(2.0 * a));
        now.active.T_model_body.q =
            quat_from_rotation_vector(Vec3(std::sin(a), 0.0, 0.8 * (1.0 - std::cos(a)))) *
            start.active.T_model_body.q;
        const ClashResult next = felt(now);
        const Vec3 moved = kScale * (now.active.T_model_body.p_m - before.active.T_model_body.p_m);
        const Vec3 turned =
            rotation_vector_rad(now.active.T_model_body.q * before.active.T_model_body.q.conjugate());
        const double dw = 0.5 * (last.wrench_world.force_n + next.wrench_world.force_n).dot(moved) +
                          0.5 * (last.wrench_world.torque_n_m + next.wrench_world.torque_n_m).dot(turned);
        work_j += dw, size_j += std::abs(dw);
        before = now, last = next;
    }
    EXPECT_GT(size_j, 1e-4);
    EXPECT_LT(std::abs(work_j), 1e-3 * size_j);
}

// A path through contact and many voxels in steps of 0.01 A.
TEST(Clash, the_force_never_steps_and_its_slope_is_limited) {
    const std::vector<ClashField> fields = [] {
        std::vector<ClashField> made;
        made.emplace_back(kBall);
        made.emplace_back(kEgg);
        return made;
    }();
    const ClashGains gains = choose_clash_gains(fields, kScale);
    EXPECT_GT(gains.stiffness_n_m, 20.0);
    SeededRandom random(9);
    for (int path = 0; path < 4; ++path) {
        const Vec3 direction = random.direction();
        ClashBody active{&egg(), {-45.0 * kA * direction, random.rotation()}};
        const ClashBody other{&ball(), {Vec3::Zero(), random.rotation()}};
        Vec3 before = Vec3::Zero();
        double most_n = 0.0, slope_n_m = 0.0, bend = 0.0;
        Vec3 change_before = Vec3::Zero();
        const double step_m = 0.01 * kA;
        for (int i = 0; i < 4000; ++i) {
            active.T_model_body.p_m += step_m * direction;
            const Vec3 now = clash_force(active, {&other, 1}, kScale, gains).wrench_world.force_n;
            const Vec3 change = now - before;
            most_n = std::max(most_n, now.norm());
            slope_n_m = std::max(slope_n_m, change.norm() / (kScale * step_m));
            if (i > 0) bend = std::max(bend, (change - change_before).norm());
            before = now, change_before = change;
        }
        EXPECT_GT(most_n, 0.1);
        EXPECT_LT(most_n, 3.0);
        // The limit was chosen from other encounters, and these bodies are more regular than a protein.
        EXPECT_LT(slope_n_m, 1.4 * 300.0);
        // C1: the slope changes gradually, by a few percent of its maximum per step.
        EXPECT_LT(bend, 0.1 * 300.0 * kScale * step_m);
    }
}

TEST(Clash, field_is_the_fourth_power_of_the_depth) {
    Vec3 gradient;
    double before = 1e300;
    // Atoms fill a ball of 15 A, which keeps other atoms out to 17.8 A; its surface is uneven by an atom's width.
    for (const double r_a : {0.0, 5.0, 9.0, 12.0}) {
        const double v = ball().map().sample(Vec3(0.0, r_a, 0.0) * kA, gradient);
        EXPECT_LT(4.0 * std::pow(v, 0.25), 17.8 - r_a + 0.5) << r_a;
        EXPECT_GT(4.0 * std::pow(v, 0.25), 17.8 - r_a - 4.5) << r_a;
        EXPECT_LT(v, before) << r_a;
        before = v;
    }
    // One atom: a ball of 2.8 A, smoothed by a spline on 2 A voxels.
    Structure s;
    s.name = "atom";
    s.x_m = s.y_m = s.z_m = {0.0F};
    s.mass_fraction = {1.0F};
    const ClashField one(s);
    EXPECT_EQ(one.points().size(), 1U);
    EXPECT_NEAR(4.0 * std::pow(one.map().sample(Vec3::Zero(), gradient), 0.25), 1.9, 1.0);
    EXPECT_LT(std::abs(one.map().sample(Vec3(9.0, 0.0, 0.0) * kA, gradient)), 1e-6);
    SeededRandom random(3);
    for (int i = 0; i < 3000; ++i) {
        const Vec3 p = random.within(30.0 * kA);
        const double v = ball().map().sample(p, gradient);
        EXPECT_GE(v, -1e-4);
        if (p.norm() >= ball().radius_m()) {
            EXPECT_LT(std::abs(v), 1e-4);
        }
    }
}

TEST(Clash, force_is_zero_out_of_reach_or_at_a_non_finite_pose) {
    Crowd c = crowd(1);
    for (ClashBody& b : c.others) b.T_model_body.p_m += Vec3::Constant(200.0 * kA);
    EXPECT_EQ(felt(c).wrench_world.force_n, Vec3::Zero());
    EXPECT_EQ(felt(c).points, 0U);
    c = crowd(2);
    c.active.T_model_body.p_m.x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(felt(c).wrench_world.force_n, Vec3::Zero());
    c = crowd(2);
    for (ClashBody& b : c.others) b.T_model_body.p_m.x() = std::numeric_limits<double>::infinity();
    EXPECT_EQ(felt(c).wrench_world.force_n, Vec3::Zero());
    c = crowd(2);
    EXPECT_EQ(clash_force(c.active, c.others, kScale, {0.0, 0.0}).energy_j, 0.0);
    // Two bodies at exactly the same pose: the force stays bounded.
    const ClashBody same{&egg(), c.active.T_model_body};
    const ClashResult inside = clash_force(c.active, {&same, 1}, kScale, kGains);
    EXPECT_TRUE(inside.wrench_world.finite());
    EXPECT_LT(inside.wrench_world.force_n.norm(), 3.0);
    EXPECT_GT(inside.depth_model_m, 5.0 * kA);
}

TEST(Clash, refuses_structures_without_atoms_or_size) {
    EXPECT_THROW(ClashField{Structure{}}, StartupError);
    Structure far = kBall;
    far.x_m[0] = 1.0F;
    EXPECT_THROW(ClashField{far}, StartupError);
    far.x_m[0] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(ClashField{far}, StartupError);
}

}  // namespace
}  // namespace tact::force_clash_test
