// Partial sums over slices against the sum over all points.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "rt/force/docking/partial_sums.hpp"

namespace tact::force_partial_sums_test {
namespace {

constexpr double kA = 1e-10;
constexpr std::size_t kPoints = 2403;  // not a multiple of the slice count: slices differ in size

DensityMap make_map() {
    DensityGrid grid;
    grid.size = {24, 24, 24};
    grid.spacing_m = Vec3::Constant(2.0 * kA);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(8.0 * kA, 38.0 * kA);
    std::vector<Vec3> blobs(25);
    for (Vec3& b : blobs) b = Vec3(place(random), place(random), place(random));
    for (std::uint32_t z = 0; z < 24; ++z)
        for (std::uint32_t y = 0; y < 24; ++y)
            for (std::uint32_t x = 0; x < 24; ++x) {
                double v = 0.0;
                for (const Vec3& b : blobs)
                    v += std::exp(-(2.0 * kA * Vec3(x, y, z) - b).squaredNorm() / (18.0 * kA * kA));
                grid.values.push_back(static_cast<float>(v));
            }
    return {grid, 0.1, 0.4};
}

const DensityMap& map() {
    static const DensityMap made = make_map();
    return made;
}

const PointSet& points() {
    static const PointSet made = [] {
        std::mt19937 random(6);
        std::normal_distribution<double> place(0.0, 6.0 * kA);
        std::vector<float> x, y, z, w(kPoints, 1.0F / static_cast<float>(kPoints));
        for (std::size_t i = 0; i < kPoints; ++i) {
            x.push_back(static_cast<float>(place(random)));
            y.push_back(static_cast<float>(place(random)));
            z.push_back(static_cast<float>(place(random)));
        }
        return make_point_set({x, y, z, w}, "cloud");
    }();
    return made;
}

// Pose of a smoothly moving body at step i: up to 0.05 A and 2 mrad per step.
Pose on_the_way(int i) {
    const double t = 0.01 * i;
    return {Vec3(23 + 4 * std::sin(t), 22 + 5 * std::sin(0.7 * t + 1), 24 + 3 * std::cos(1.3 * t)) * kA,
            quat_from_rotation_vector(Vec3(0.2 * std::sin(t), 0.1 * t, 0.1 * std::cos(0.5 * t)))};
}

PartialSums::Result step(PartialSums& partial, const Pose& pose, double share) {
    return partial.step(map(), points(), pose, share, Instant::max());
}

DensitySums whole(const Pose& pose) { return map().sum(points().view(), pose); }

// Rounding: the weights sum to one, so each sum is accurate to about 1e-6 of one point's largest contribution.
constexpr double kRounding = 3e-6;
void expect_equal(const DensitySums& a, const DensitySums& b) {
    EXPECT_NEAR(a.density_sigma, b.density_sigma, kRounding);
    EXPECT_LT((a.gradient - b.gradient).norm() * kA, kRounding);
    EXPECT_LT((a.moment - b.moment).norm(), 20.0 * kRounding);
}

TEST(PartialSums, work_fraction_one_sums_all_points) {
    PartialSums partial;
    for (int i = 0; i < 50; ++i) {
        const PartialSums::Result r = step(partial, on_the_way(3 * i), 1.0);
        EXPECT_EQ(r.recomputed_fraction, 1.0F);
        EXPECT_EQ(r.stale, 0.0);
        EXPECT_TRUE(r.complete);
        expect_equal(r.sums, whole(on_the_way(3 * i)));
    }
}

TEST(PartialSums, an_invalid_work_fraction_makes_a_full_step) {
    for (const double share : {0.0, -1.0, 1.5, std::nan(""), HUGE_VAL}) {
        PartialSums partial;
        (void)step(partial, on_the_way(0), 1.0);
        EXPECT_EQ(step(partial, on_the_way(1), share).recomputed_fraction, 1.0F) << share;
    }
}

TEST(PartialSums, work_is_proportional_to_the_work_fraction) {
    PartialSums partial;
    for (int i = 0; i < 3; ++i) (void)step(partial, on_the_way(i), 1.0);
    for (int eighths = 1; eighths < 8; ++eighths) {
        const float fresh = step(partial, on_the_way(3), 0.125 * eighths).recomputed_fraction;
        EXPECT_NEAR(static_cast<double>(fresh), 0.125 * eighths, 8.0 / kPoints);
        EXPECT_NEAR(
            static_cast<double>(step(partial, on_the_way(3), 0.125 * eighths - 0.1).recomputed_fraction),
            0.125 * eighths, 8.0 / kPoints);  // rounded up
    }
}

TEST(PartialSums, a_resting_body_is_summed_completely_within_one_round_of_slices) {
    for (const double share : {0.01, 0.125, 0.3, 0.6, 0.99}) {
        PartialSums partial;
        for (int i = 0; i < 20; ++i) (void)step(partial, on_the_way(i), share);
        PartialSums::Result r;
        for (std::size_t i = 0; i < PartialSums::kSlices; ++i) r = step(partial, on_the_way(20), share);
        expect_equal(r.sums, whole(on_the_way(20)));
        EXPECT_EQ(r.stale, 0.0) << share;
    }
}

// The error bound holds for smooth motion and any work fractions.
RC_GTEST_PROP(PartialSums, the_error_of_a_moving_body_is_below_its_bound, ()) {
    PartialSums partial;
    const int from = *rc::gen::inRange(0, 2000);
    double stale_most = 0.0;
    for (int i = 0; i < 60; ++i) {
        const double share = 0.125 * *rc::gen::inRange(1, 9);
        const Pose pose = on_the_way(from + i);
        const PartialSums::Result r = step(partial, pose, share);
        RC_ASSERT((r.sums.gradient - whole(pose).gradient).norm() <= r.stale + kRounding / kA);
        stale_most = std::max(stale_most, r.stale);
    }
    // The bound is useful: below a tenth of the largest force on one point here.
    RC_ASSERT(stale_most * kA < 0.1);
}

// For any work fractions, a step changes the sum by no more than all slices change together in kSlices steps.
TEST(PartialSums, varying_work_fractions_change_the_sum_no_more_than_the_body_motion) {
    constexpr int kSteps = 600;
    const std::size_t slices = PartialSums::kSlices;
    std::vector<std::array<Vec3, PartialSums::kSlices>> part(kSteps);
    for (int i = 0; i < kSteps; ++i)
        for (std::size_t k = 0; k < slices; ++k) {
            const std::size_t begin = k * kPoints / slices, end = (k + 1) * kPoints / slices;
            part[static_cast<std::size_t>(i)][k] =
                map().sum(points().view(begin, end - begin), on_the_way(i)).gradient;
        }
    double most = 0.0;
    for (std::size_t i = slices; i < kSteps; ++i) {
        double sum = 0.0;
        for (std::size_t k = 0; k < slices; ++k) {
            double far = 0.0;
            for (std::size_t back = 1; back <= slices; ++back)
                far = std::max(far, (part[i][k] - part[i - back][k]).norm());
            sum += far;
        }
        most = std::max(most, sum);
    }
    PartialSums partial;
    std::mt19937 random(8);
    std::uniform_real_distribution<double> any(0.01, 1.3);
    Vec3 before = step(partial, on_the_way(0), 1.0).sums.gradient;
    double biggest = 0.0;
    for (int i = 1; i < kSteps; ++i) {
        const Vec3 now = step(partial, on_the_way(i), any(random)).sums.gradient;
        biggest = std::max(biggest, (now - before).norm());
        before = now;
    }
    EXPECT_GT(biggest, 0.0);
    EXPECT_LE(biggest, most + kRounding / kA);
}

TEST(PartialSums, a_jump_of_the_body_is_summed_completely) {
    PartialSums partial;
    for (int i = 0; i < 5; ++i) (void)step(partial, on_the_way(i), 0.25);
    Pose far = on_the_way(5);
    far.p_m.x() += 3.0 * kA;
    const PartialSums::Result r = step(partial, far, 0.125);
    EXPECT_EQ(r.recomputed_fraction, 1.0F);
    expect_equal(r.sums, whole(far));
    Pose turned = far;
    turned.q = quat_from_rotation_vector(Vec3(0.0, 0.5, 0.0)) * turned.q;
    EXPECT_EQ(step(partial, turned, 0.125).recomputed_fraction, 1.0F);
    turned.q.coeffs() *= -1.0;  // the same rotation
    EXPECT_NEAR(static_cast<double>(step(partial, turned, 0.125).recomputed_fraction), 0.125, 8.0 / kPoints);
}

TEST(PartialSums, another_density_and_other_points_are_summed_completely) {
    const DensityMap other = make_map();
    const PointSet fewer = make_point_set(points().view(), "again");
    PartialSums partial;
    const auto settled = [&] {
        for (int i = 0; i < 3; ++i) (void)step(partial, on_the_way(i), 1.0);
        return step(partial, on_the_way(3), 0.125).recomputed_fraction;
    };
    EXPECT_LT(settled(), 0.2F);
    EXPECT_EQ(partial.step(other, points(), on_the_way(3), 0.125, Instant::max()).recomputed_fraction, 1.0F);
    EXPECT_LT(settled(), 0.2F);
    EXPECT_EQ(partial.step(map(), fewer, on_the_way(3), 0.125, Instant::max()).recomputed_fraction, 1.0F);
}

TEST(PartialSums, after_the_deadline_older_sums_are_used_and_their_staleness_is_reported) {
    PartialSums partial;
    for (int i = 0; i < 3; ++i) (void)step(partial, on_the_way(i), 1.0);
    const PartialSums::Result late = partial.step(map(), points(), on_the_way(3), 0.5, Monotonic::now());
    EXPECT_TRUE(late.late);
    EXPECT_TRUE(late.complete);
    EXPECT_EQ(late.recomputed_fraction, 0.0F);
    EXPECT_GE(late.stale, (whole(on_the_way(3)).gradient - late.sums.gradient).norm());
    EXPECT_GT(late.stale, 0.0);
    expect_equal(late.sums, whole(on_the_way(2)));
    expect_equal(step(partial, on_the_way(3), 1.0).sums, whole(on_the_way(3)));
}

TEST(PartialSums, without_older_sums_nearby_a_passed_deadline_leaves_the_step_incomplete) {
    PartialSums partial;
    EXPECT_FALSE(partial.step(map(), points(), on_the_way(0), 1.0, Monotonic::now()).complete);
    (void)step(partial, on_the_way(0), 1.0);
    Pose far = on_the_way(0);
    far.p_m += Vec3::Constant(2.0 * map().spacing_m().minCoeff());
    const PartialSums::Result late = partial.step(map(), points(), far, 1.0, Monotonic::now());
    EXPECT_TRUE(late.late);
    EXPECT_FALSE(late.complete);
}

}  // namespace
}  // namespace tact::force_partial_sums_test
