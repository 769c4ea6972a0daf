// Pull towards places found: the derivative of its energy, bounded, smooth, and as stiff as stated.
#include "rt/force/docking/basin_pull.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ipc/base/random.hpp"
#include "ipc/base/units.hpp"

namespace tact::force_basin_pull_test {
namespace {

constexpr double kScale = 5e6, kGyration_m = 22e-10;

Quat random_turn(SeededRandom& random) { return random.rotation().normalized(); }
Vec3 random_vector(SeededRandom& random, double size) { return random.within(1.7 * size); }
Pose shifted(const Pose& at, const Vec3& dx_world_m, const Vec3& turn_rad) {
    const double angle = turn_rad.norm();
    const Quat by = angle > 0.0 ? Quat(Eigen::AngleAxisd(angle, turn_rad / angle)) : Quat::Identity();
    return {at.p_m + dx_world_m / kScale, (by * at.q).normalized()};
}
// The energy as the header states it, computed anew: distances from moved points, in extended precision.
double energy_j(const std::vector<std::pair<Pose, double>>& places, const Pose& here) {
    // Six points on the axes, at a distance that gives the radius of gyration: their second moments are those of a round body.
    const double w = BasinPull::kForce_n / (BasinPull::kStiffness_n_m * kScale);
    long double sum = 0.0L;
    for (const auto& [place, worth] : places) {
        double d2 = 0.0;
        for (int axis = 0; axis < 3; ++axis)
            for (const double sign : {-1.0, 1.0}) {
                const Vec3 at = sign * kGyration_m * Vec3::Unit(axis);
                d2 += (here.p_m + here.q * at - place.p_m - place.q * at).squaredNorm() / 6.0;
            }
        sum += std::exp(-static_cast<long double>(
            (std::sqrt(d2 + w * w) - w + BasinPull::kHandicap * kGyration_m * (1.0 - worth)) / w));
    }
    return static_cast<double>(-static_cast<long double>(BasinPull::kForce_n * kScale * w) * std::log(sum));
}

struct Places {
    BasinPull pull;
    std::vector<std::pair<Pose, double>> list;
    explicit Places(std::uint64_t seed, std::size_t count = 6) {
        SeededRandom random(seed);
        for (std::size_t i = 0; i < count; ++i) {
            const Pose place{random_vector(random, 30e-10), random_turn(random)};
            list.push_back({place, i == 0 ? 1.0 : 0.7 + 0.3 * random.uniform()});
            EXPECT_TRUE(pull.add(3, place, list.back().second));
        }
    }
    [[nodiscard]] BasinPull::Pull at(const Pose& here) const { return pull.at(here, kGyration_m, kScale); }
};

TEST(BasinPull, is_the_derivative_of_the_stated_energy) {
    const Places places(1);
    SeededRandom random(2);
    for (int i = 0; i < 300; ++i) {
        const Pose here{random_vector(random, i % 3 == 0 ? 3e-10 : 40e-10), random_turn(random)};
        const BasinPull::Pull pull = places.at(here);
        EXPECT_NEAR(pull.energy_j, energy_j(places.list, here), 1e-9);
        constexpr double kStep_m = 1e-6, kStep_rad = 1e-5;
        for (int axis = 0; axis < 3; ++axis) {
            const Vec3 dx = kStep_m * Vec3::Unit(axis), turn = kStep_rad * Vec3::Unit(axis);
            const auto slope = [&](const Vec3& x, const Vec3& phi, double by) {
                return -(energy_j(places.list, shifted(here, x, phi)) -
                         energy_j(places.list, shifted(here, -x, -phi))) /
                       (2.0 * by);
            };
            EXPECT_NEAR(pull.wrench_world.force_n[axis], slope(dx, Vec3::Zero(), kStep_m), 1e-5);
            EXPECT_NEAR(pull.wrench_world.torque_n_m[axis], slope(Vec3::Zero(), turn, kStep_rad), 1e-6);
        }
    }
}

TEST(BasinPull, force_and_torque_are_bounded_and_zero_at_a_lone_place) {
    const Places one(3, 1), many(3);
    SeededRandom random(4);
    for (int i = 0; i < 2000; ++i) {
        const Pose here{random_vector(random, 60e-10), random_turn(random)};
        const Wrench w = many.at(here).wrench_world;
        EXPECT_LE(w.force_n.norm(), BasinPull::kForce_n);
        EXPECT_LE(w.torque_n_m.norm(), BasinPull::kForce_n * kScale * kGyration_m);
    }
    EXPECT_LT(one.at(one.list[0].first).wrench_world.force_n.norm(), 1e-12);
    EXPECT_LT(one.at(one.list[0].first).wrench_world.torque_n_m.norm(), 1e-12);
    const Pose far{one.list[0].first.p_m + Vec3(200e-10, 0.0, 0.0), one.list[0].first.q};
    EXPECT_NEAR(one.at(far).wrench_world.force_n.x(), -BasinPull::kForce_n, 0.02);
}

TEST(BasinPull, no_direction_is_stiffer_than_stated) {
    const Places places(5);
    const ModelStiffness stated = BasinPull::stiffness(kGyration_m, kScale);
    SeededRandom random(6);
    double most_n_m = 0.0, most_n_m_rad = 0.0;
    for (int i = 0; i < 20'000; ++i) {
        Pose here{random_vector(random, 40e-10), random_turn(random)};
        if (i % 2 == 0) {  // near a place, or between two
            const Pose& a = places.list[static_cast<std::size_t>(i / 2) % 6].first;
            here = {a.p_m + random_vector(random, 5e-10),
                    shifted(a, Vec3::Zero(), random_vector(random, 0.2)).q};
        }
        constexpr double kStep_m = 1e-5, kStep_rad = 1e-4;
        const Vec3 along = random_vector(random, 1.0).normalized();
        const Wrench a = places.at(shifted(here, -kStep_m * along, Vec3::Zero())).wrench_world,
                     b = places.at(shifted(here, kStep_m * along, Vec3::Zero())).wrench_world,
                     c = places.at(shifted(here, Vec3::Zero(), -kStep_rad * along)).wrench_world,
                     d = places.at(shifted(here, Vec3::Zero(), kStep_rad * along)).wrench_world;
        most_n_m = std::max(most_n_m, (b.force_n - a.force_n).norm() / (2.0 * kStep_m));
        most_n_m_rad = std::max(most_n_m_rad, (d.torque_n_m - c.torque_n_m).norm() / (2.0 * kStep_rad));
    }
    EXPECT_LE(most_n_m, 1.001 * stated.force_n_m);
    EXPECT_LE(most_n_m_rad, 1.001 * stated.torque_n_m_rad);
    EXPECT_GT(most_n_m, 0.8 * stated.force_n_m);
    EXPECT_GT(most_n_m_rad, 0.6 * stated.torque_n_m_rad);
}

TEST(BasinPull, closed_paths_through_all_places_give_no_energy_away) {
    const Places places(7);
    SeededRandom random(8);
    for (int path = 0; path < 5; ++path) {
        const Vec3 a = random_vector(random, 25e-10), b = random_vector(random, 25e-10),
                   turn = random_vector(random, 1.0);
        constexpr int kSteps = 20'000;
        double work_j = 0.0;
        Pose before;
        for (int i = 0; i <= kSteps; ++i) {
            const double t = 2.0 * std::numbers::pi * i / kSteps;
            const Pose here = shifted({a * std::cos(t) + b * std::sin(t), Quat::Identity()}, Vec3::Zero(),
                                      std::sin(t) * turn);
            if (i > 0) {
                const Pose middle{0.5 * (here.p_m + before.p_m), before.q.slerp(0.5, here.q)};
                const Wrench w = places.at(middle).wrench_world;
                work_j += w.force_n.dot(kScale * (here.p_m - before.p_m)) +
                          w.torque_n_m.dot(rotation_vector_rad(here.q * before.q.conjugate()));
            }
            before = here;
        }
        EXPECT_LT(std::abs(work_j), 1e-8) << path;
    }
}

TEST(BasinPull, a_better_place_pulls_from_farther_away) {
    const Vec3 x = Vec3::UnitX();
    const auto force = [&](double worth) {
        BasinPull pull;
        EXPECT_TRUE(pull.add(1, {40e-10 * x, Quat::Identity()}, 1.0));
        EXPECT_TRUE(pull.add(1, {-20e-10 * x, Quat::Identity()}, worth));
        return pull.at({}, kGyration_m, kScale).wrench_world.force_n.x();
    };
    EXPECT_LT(force(1.0), -0.4);  // to the nearer one
    EXPECT_GT(force(0.5), 0.4);   // 55 angstrom behind
}

TEST(BasinPull, belongs_to_one_body_and_is_bounded_in_number) {
    BasinPull pull;
    for (std::size_t i = 0; i < BasinPull::kMax; ++i) EXPECT_TRUE(pull.add(1, {}, 1.0));
    EXPECT_FALSE(pull.add(1, {}, 1.0));
    EXPECT_TRUE(pull.add(2, {Vec3(1e-9, 0.0, 0.0), Quat::Identity()}, 1.0));
    EXPECT_EQ(pull.count(), 1U);
    EXPECT_EQ(pull.body(), 2U);
    pull.clear();
    EXPECT_EQ(pull.count(), 0U);
}

}  // namespace
}  // namespace tact::force_basin_pull_test
