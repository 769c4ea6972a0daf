// Sums over many points: every kernel against sample(), point by point in double precision.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <random>

#include "ipc/scene/density/density_kernels.hpp"
#include "ipc/scene/density/density_map.hpp"

namespace tact::scene_density_sum_test {
namespace {

struct Points {
    std::vector<float> x, y, z, w;
    [[nodiscard]] PointsView view() const { return {x, y, z, w}; }
};

Points random_points(std::size_t count, double radius_m, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0.0, radius_m);
    std::uniform_real_distribution<double> weight(0.5, 1.5);
    Points p;
    double total = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        p.x.push_back(static_cast<float>(normal(random)));
        p.y.push_back(static_cast<float>(normal(random)));
        p.z.push_back(static_cast<float>(normal(random)));
        p.w.push_back(static_cast<float>(weight(random)));
        total += static_cast<double>(p.w.back());
    }
    for (float& w : p.w) w = static_cast<float>(static_cast<double>(w) / total);
    return p;
}

DensityGrid noise_grid(std::array<std::uint32_t, 3> size) {
    DensityGrid grid;
    grid.size = size;
    grid.origin_m = Vec3(-3e-9, 1e-9, 20e-9);
    grid.spacing_m = Vec3(2.0e-10, 2.5e-10, 3.0e-10);
    grid.values.resize(grid.count());
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    for (float& v : grid.values) v = normal(random);
    return grid;
}

DensitySums reference(const DensityMap& map, const Points& p, const Pose& T) {
    DensitySums sums;
    for (std::size_t i = 0; i < p.x.size(); ++i) {
        const Vec3 r =
            T.q * Vec3(static_cast<double>(p.x[i]), static_cast<double>(p.y[i]), static_cast<double>(p.z[i]));
        Vec3 gradient;
        const auto w = static_cast<double>(p.w[i]);
        sums.density_sigma += w * map.sample(T.p_m + r, gradient);
        sums.gradient += w * gradient;
        sums.moment += w * r.cross(gradient);
    }
    return sums;
}

// Tolerances relative to the contribution of a single point; contributions sum to about one.
void expect_close(const DensitySums& a, const DensitySums& b, double radius_m, const char* kernel) {
    EXPECT_NEAR(a.density_sigma, b.density_sigma, 3e-5) << kernel;
    EXPECT_LT((a.gradient - b.gradient).norm() * 2e-10, 3e-5) << kernel;
    EXPECT_LT((a.moment - b.moment).norm() * 2e-10 / radius_m, 1e-4) << kernel;
}

Pose pose_in(const DensityGrid& grid, const Vec3& t, const Quat& q) {
    return {grid.origin_m + grid.spacing_m.cwiseProduct(t), q.normalized()};
}

class DensitySum : public testing::TestWithParam<std::size_t> {
protected:
    void SetUp() override {
        if (!kernel().runs_here()) GTEST_SKIP() << "this processor does not support " << kernel().name;
    }
    [[nodiscard]] static DensityMap::Options options() {
        DensityMap::Options o;
        o.kernel = &kernel();
        return o;
    }
    [[nodiscard]] static DensityMap::Options stored_once() {
        DensityMap::Options o = options();
        o.windows_bytes_max = 0;
        return o;
    }
    [[nodiscard]] static const DensityKernel& kernel() { return kDensityKernels[GetParam()]; }
};

TEST_P(DensitySum, agrees_with_sample_for_every_count_of_points) {
    const DensityGrid grid = noise_grid({24, 20, 16});
    const DensityMap map(grid, 0.0, 1.0, options());
    EXPECT_STREQ(map.kernel_name(), kernel().name);
    const Pose T = pose_in(grid, Vec3(11.3, 9.1, 8.7), Quat(0.6, -0.3, 0.5, 0.2));
    for (const std::size_t count : {0, 1, 2, 7, 8, 9, 15, 16, 17, 31, 200, 511, 512, 513, 3000}) {
        const Points p = random_points(count, 8e-10, static_cast<unsigned>(count));
        expect_close(map.sum(p.view(), T), reference(map, p, T), 8e-10, kernel().name);
    }
}

// All widths modulo four, because the coefficients are stored in rows of four.
TEST_P(DensitySum, agrees_with_sample_in_maps_too_large_for_fourfold_storage) {
    for (const std::uint32_t width : {21U, 22U, 23U, 24U}) {
        const DensityGrid grid = noise_grid({width, 20, 16});
        const DensityMap fourfold(grid, 0.0, 1.0, options()), once(grid, 0.0, 1.0, stored_once());
        EXPECT_LT(once.bytes(), fourfold.bytes());
        const Pose T = pose_in(grid, Vec3(11.3, 9.1, 8.7), Quat(0.6, -0.3, 0.5, 0.2));
        for (const std::size_t count : {1, 13, 1000}) {
            const Points p = random_points(count, 20e-10, static_cast<unsigned>(count));
            expect_close(once.sum(p.view(), T), reference(once, p, T), 20e-10, kernel().name);
        }
    }
}

TEST_P(DensitySum, gives_the_gradient_of_each_point) {
    const DensityGrid grid = noise_grid({23, 20, 16});
    const DensityMap fourfold(grid, 0.0, 1.0, options()), once(grid, 0.0, 1.0, stored_once());
    const Pose T = pose_in(grid, Vec3(11.3, 9.1, 8.7), Quat(0.6, -0.3, 0.5, 0.2));
    for (const std::size_t count : {1, 7, 8, 16, 17, 600}) {
        const Points p = random_points(count, 15e-10, static_cast<unsigned>(count));
        for (const DensityMap* map : {&once, &fourfold}) {
            // One more than points, which must stay as it is.
            std::vector<float> x(count + 1, 7.0F), y = x, z = x;
            const PointGradients each{x, y, z};
            const DensitySums with = map->sum(p.view(), T, &each), without = map->sum(p.view(), T);
            EXPECT_EQ(with.gradient, without.gradient);
            EXPECT_EQ(with.moment, without.moment);
            for (std::size_t i = 0; i < count; ++i) {
                Vec3 gradient;
                static_cast<void>(
                    map->sample(T * Eigen::Vector3f(p.x[i], p.y[i], p.z[i]).cast<double>(), gradient));
                const Vec3 found = Eigen::Vector3f(x[i], y[i], z[i]).cast<double>();
                const auto w = static_cast<double>(p.w[i]);
                EXPECT_LT((found - w * gradient).norm() * 2e-10, 3e-5 * w)
                    << kernel().name << ", point " << i;
            }
            EXPECT_EQ(x[count], 7.0F);
            EXPECT_EQ(z[count], 7.0F);
        }
    }
}

// The corners to which points are clamped, next to the last rows of the coefficients.
TEST_P(DensitySum, is_zero_in_the_farthest_corners) {
    const DensityGrid grid = noise_grid({8, 8, 8});
    const DensityMap fourfold(grid, 0.0, 1.0, options()), once(grid, 0.0, 1.0, stored_once());
    const Points p = random_points(16, 1e-12, 4);
    for (const double x : {-40.0, 40.0}) {
        const Pose T = pose_in(grid, Vec3(x, x, x), Quat::Identity());
        for (const DensityMap* map : {&once, &fourfold}) EXPECT_EQ(map->sum(p.view(), T).density_sigma, 0.0);
    }
}

TEST_P(DensitySum, agrees_with_sample_where_points_leave_the_box) {
    const DensityGrid grid = noise_grid({10, 12, 8});
    const DensityMap map(grid, 0.0, 1.0, options());
    const Points p = random_points(300, 40e-10, 5);
    for (const double x : {-30.0, -11.0, 0.0, 5.0, 9.0, 17.5, 40.0}) {
        const Pose T = pose_in(grid, Vec3(x, 0.4 * x, 6.0 - x), Quat(0.1, 0.8, 0.3, -0.5));
        expect_close(map.sum(p.view(), T), reference(map, p, T), 40e-10, kernel().name);
    }
}

TEST_P(DensitySum, invalid_poses_give_zero) {
    const DensityGrid grid = noise_grid({10, 12, 8});
    const DensityMap map(grid, 0.0, 1.0, options());
    const Points p = random_points(37, 10e-10, 6);
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
    const Pose middle = pose_in(grid, Vec3(5, 6, 4), Quat::Identity());
    std::vector<Pose> poses(8, middle);
    poses[0].p_m.x() = nan;
    poses[1].p_m = Vec3::Constant(inf);
    poses[2].p_m.z() = 1e300;
    poses[3].p_m.y() = -1.0;
    poses[4].q = Quat(nan, 0, 0, 0);
    poses[5].q = Quat(0, 0, 0, 0);
    poses[6].q = Quat(1e200, 0, 0, 0);
    poses[7].p_m.y() = 1e-3;
    for (const Pose& T : poses) {
        const DensitySums sums = map.sum(p.view(), T);
        EXPECT_EQ(sums.density_sigma, 0.0);
        EXPECT_EQ(sums.gradient, Vec3::Zero());
        EXPECT_EQ(sums.moment, Vec3::Zero());
    }
}

TEST_P(DensitySum, invalid_points_give_finite_sums) {
    const DensityGrid grid = noise_grid({10, 12, 8});
    const DensityMap map(grid, 0.0, 1.0, options());
    const Pose middle = pose_in(grid, Vec3(5, 6, 4), Quat(0.5, 0.5, 0.5, 0.5));
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 3e38F, -1.0F}) {
        Points p = random_points(37, 10e-10, 7);
        p.y[20] = bad;
        const DensitySums sums = map.sum(p.view(), middle);
        EXPECT_TRUE(std::isfinite(sums.density_sigma) && sums.gradient.allFinite() &&
                    sums.moment.allFinite());
    }
}

TEST_P(DensitySum, any_pose_and_any_points_agree_with_sample) {
    const DensityGrid grid = noise_grid({9, 7, 11});
    const DensityMap fourfold(grid, 0.0, 1.0, options()), once(grid, 0.0, 1.0, stored_once());
    const DensityKernel& used = kernel();
    EXPECT_TRUE(rc::check(std::string("kernel ") + used.name + " agrees with sample", [&] {
        const auto count = *rc::gen::inRange<std::size_t>(0, 70);
        const auto seed = *rc::gen::inRange<unsigned>(0, 1000000);
        const Points p = random_points(count, 12e-10, seed);
        std::mt19937 random(seed + 1);
        std::uniform_real_distribution<double> place(-14.0, 24.0), turn(-1.0, 1.0);
        const Pose T = pose_in(grid, Vec3(place(random), place(random), place(random)),
                               Quat(turn(random), turn(random), turn(random), turn(random) + 1e-3));
        const DensitySums b = reference(once, p, T);
        for (const DensityMap* map : {&once, &fourfold}) {
            const DensitySums a = map->sum(p.view(), T);
            RC_ASSERT(std::abs(a.density_sigma - b.density_sigma) < 3e-5);
            RC_ASSERT((a.gradient - b.gradient).norm() * 2e-10 < 3e-5);
            RC_ASSERT((a.moment - b.moment).norm() * 2e-10 / 12e-10 < 1e-4);
        }
    }));
}

INSTANTIATE_TEST_SUITE_P(Kernels, DensitySum, testing::Range(std::size_t{0}, kDensityKernelCount),
                         [](const auto& tested) { return std::string(kDensityKernels[tested.param].name); });

}  // namespace
}  // namespace tact::scene_density_sum_test
