// The synthetic pair: it repeats, its subunits match the map, and only the known pose fits the map.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "ipc/scene/density/density_map.hpp"
#include "prep/map/map_statistics.hpp"
#include "prep/synthetic/ring.hpp"

namespace tact::prep_synthetic_test {
namespace {

constexpr double kA = 1e-10;

class Ring : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        ring_ = new SyntheticRing(make_ring());
        const MapStatistics s = map_statistics(ring_->grid);
        map_ = new DensityMap(ring_->grid, s.background, s.sigma);
    }
    static void TearDownTestSuite() {
        delete map_;
        delete ring_;
    }
    static DensitySums sum(const Structure& s, const Pose& pose) {
        return map_->sum({s.x_m, s.y_m, s.z_m, s.mass_fraction}, pose);
    }

    // Gradient ascent with steps that shrink on overshoot, like a hand that follows the force.
    static Pose climbed(const Structure& s, Pose pose) {
        const double lever_m = 20.0 * kA;
        double step_m = 1.0 * kA;
        DensitySums at = sum(s, pose);
        for (int i = 0; i < 2000 && step_m > 0.002 * kA; ++i) {
            const Vec3 turn = at.moment / lever_m;
            const double size = std::hypot(at.gradient.norm(), turn.norm());
            const Pose next{
                pose.p_m + step_m / size * at.gradient,
                (quat_from_rotation_vector(step_m / size / lever_m * turn) * pose.q).normalized()};
            const DensitySums there = sum(s, next);
            if (there.density_sigma > at.density_sigma) {
                pose = next;
                at = there;
                step_m *= 1.1;
            } else {
                step_m *= 0.5;
            }
        }
        return pose;
    }
    static inline SyntheticRing* ring_ = nullptr;
    static inline DensityMap* map_ = nullptr;
};

TEST_F(Ring, repeats_and_depends_on_the_seed) {
    EXPECT_EQ(make_ring().grid.values, ring_->grid.values);
    EXPECT_NE(make_ring(2).grid.values, ring_->grid.values);
}

TEST_F(Ring, has_six_equal_subunits_with_their_own_chains) {
    ASSERT_EQ(ring_->subunits.size(), 6U);
    for (std::size_t k = 0; k < 6; ++k) {
        const Structure& s = ring_->subunits[k];
        EXPECT_EQ(s.chain_names, std::vector<std::string>{std::string(1, static_cast<char>('A' + k))});
        EXPECT_GT(s.size(), 600U);
        EXPECT_LT(s.size(), 1200U);
        const Vec3& at = s.home_com_model_m;
        const Vec3& next = ring_->subunits[(k + 1) % 6].home_com_model_m;
        EXPECT_NEAR(std::atan2(at.cross(next).z(), at.head<2>().dot(next.head<2>())), M_PI / 3.0, 1e-6);
        EXPECT_NEAR(at.z(), next.z(), 1e-15);
    }
}

TEST_F(Ring, adjacent_subunits_do_not_intersect) {
    const Structure &a = ring_->subunits[0], &b = ring_->subunits[1];
    double nearest = 1.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t j = 0; j < b.size(); ++j) {
            const Vec3 d = a.home_com_model_m + Vec3(a.x_m[i], a.y_m[i], a.z_m[i]) - b.home_com_model_m -
                           Vec3(b.x_m[j], b.y_m[j], b.z_m[j]);
            nearest = std::min(nearest, d.norm());
        }
    }
    EXPECT_GT(nearest, 3.0 * kA);
    EXPECT_LT(nearest, 15.0 * kA);
}

TEST_F(Ring, the_contour_of_the_map_contains_the_atoms) {
    const MapStatistics statistics = map_statistics(ring_->grid);
    const double contour =
        (choose_contour(ring_->grid, statistics).level - statistics.background) / statistics.sigma;
    for (const Structure& s : ring_->subunits) {
        std::size_t inside = 0;
        for (std::size_t i = 0; i < s.size(); ++i) {
            Vec3 gradient;
            if (map_->sample(s.home_com_model_m + Vec3(s.x_m[i], s.y_m[i], s.z_m[i]), gradient) > contour)
                ++inside;
        }
        EXPECT_GT(static_cast<double>(inside), 0.95 * static_cast<double>(s.size()));
    }
}

TEST_F(Ring, following_the_force_from_15_angstrom_and_30_degrees_leads_home) {
    const Structure& s = ring_->subunits[0];
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    int home = 0;
    for (int trial = 0; trial < 20; ++trial) {
        const Vec3 offset = Vec3(normal(random), normal(random), normal(random)).normalized() * 15.0 * kA;
        const Vec3 axis = Vec3(normal(random), normal(random), normal(random)).normalized();
        const Pose end =
            climbed(s, {s.home_com_model_m + offset, quat_from_rotation_vector(axis * M_PI / 6.0)});
        const double away_a = (end.p_m - s.home_com_model_m).norm() / kA,
                     turned_deg = rotation_vector_rad(end.q).norm() * 180.0 / M_PI;
        if (away_a < 3.0 && turned_deg < 5.0) ++home;
    }
    EXPECT_GE(home, 19);
    const Pose stays = climbed(s, s.home());
    EXPECT_LT((stays.p_m - s.home_com_model_m).norm(), 1.5 * kA);
    EXPECT_LT(rotation_vector_rad(stays.q).norm(), 3.0 * M_PI / 180.0);
}

TEST_F(Ring, no_other_rotation_fits_the_map_as_well) {
    const Structure& s = ring_->subunits[0];
    const double at_home = sum(s, s.home()).density_sigma;
    std::mt19937_64 random(11);
    std::normal_distribution<double> normal;
    for (int trial = 0; trial < 300; ++trial) {
        const Quat q = Quat(normal(random), normal(random), normal(random), normal(random)).normalized();
        if (rotation_vector_rad(q).norm() < 20.0 * M_PI / 180.0) continue;
        EXPECT_LT(sum(s, {s.home_com_model_m, q}).density_sigma, 0.97 * at_home);
    }
}

}  // namespace
}  // namespace tact::prep_synthetic_test
