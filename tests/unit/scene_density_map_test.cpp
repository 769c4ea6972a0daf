// The density sampler against a slow reference and against its definition.
#include "ipc/scene/density/density_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "ipc/base/error.hpp"
#include "ipc/scene/density/density_kernels.hpp"

namespace tact::scene_density_map_test {
namespace {

constexpr double kVoxelM = 2.5e-10;

DensityGrid noise_grid(std::array<std::uint32_t, 3> size, unsigned seed) {
    DensityGrid grid;
    grid.size = size;
    grid.origin_m = Vec3(-3e-9, 1e-9, 20e-9);
    grid.spacing_m = Vec3(kVoxelM, 1.25 * kVoxelM, 0.75 * kVoxelM);
    grid.values.resize(grid.count());
    std::mt19937 random(seed);
    std::normal_distribution<float> normal(3.0F, 2.0F);
    for (float& v : grid.values) v = normal(random);
    return grid;
}

Vec3 in_voxels(const DensityGrid& grid, const Vec3& v) {
    return grid.origin_m + grid.spacing_m.cwiseProduct(v);
}

// Interpolation with the cardinal cubic spline (1 at one voxel, 0 at all others), whose infinite weights have a
// closed form: sum_k c_k B(t - k), c_k = (-6 z / (1 - z^2)) z^|k|. No recursion and no padding.
double cardinal(double t) {
    const double z = std::sqrt(3.0) - 2.0;
    const auto bspline = [](double u) {
        u = std::abs(u);
        if (u < 1.0) return 2.0 / 3.0 - u * u + 0.5 * u * u * u;
        return u < 2.0 ? (2.0 - u) * (2.0 - u) * (2.0 - u) / 6.0 : 0.0;
    };
    const auto middle = static_cast<int>(std::floor(t));
    double sum = 0.0;
    for (int k = middle - 2; k <= middle + 3; ++k) sum += std::pow(z, std::abs(k)) * bspline(t - k);
    return -6.0 * z / (1.0 - z * z) * sum;
}

// The same for values sharpened by 1 + (1 - cos w)^3 / 54.
double sharp_cardinal(double t) {
    double sum = cardinal(t);
    const double taps[] = {2.5, -1.875, 0.75, -0.125};
    for (int k = -3; k <= 3; ++k) sum += taps[std::abs(k)] / 54.0 * cardinal(t - k);
    return sum;
}

double reference(const DensityGrid& grid, double background, double sigma, const Vec3& point) {
    const Vec3 t = (point - grid.origin_m).cwiseQuotient(grid.spacing_m);
    double sum = 0.0;
    for (std::uint32_t z = 0; z < grid.size[2]; ++z) {
        for (std::uint32_t y = 0; y < grid.size[1]; ++y) {
            const double yz = sharp_cardinal(t.z() - z) * sharp_cardinal(t.y() - y);
            for (std::uint32_t x = 0; x < grid.size[0]; ++x) {
                sum += yz * sharp_cardinal(t.x() - x) * (static_cast<double>(grid.at(x, y, z)) - background) /
                       sigma;
            }
        }
    }
    return sum;
}

Vec3 numeric_gradient(const DensityMap& map, const Vec3& p) {
    const double h = 1e-4 * kVoxelM;
    Vec3 unused, gradient;
    for (int a = 0; a < 3; ++a) {
        gradient[a] =
            (map.sample(p + h * Vec3::Unit(a), unused) - map.sample(p - h * Vec3::Unit(a), unused)) / (2 * h);
    }
    return gradient;
}

TEST(DensityMap, passes_through_every_voxel_if_asked_to_interpolate) {
    const DensityGrid grid = noise_grid({7, 9, 8}, 1);
    DensityMap::Options options;
    options.interpolating = true;
    const DensityMap map(grid, 2.0, 1.5, options);
    Vec3 gradient;
    for (std::uint32_t z = 0; z < 8; ++z) {
        for (std::uint32_t y = 0; y < 9; ++y) {
            for (std::uint32_t x = 0; x < 7; ++x) {
                const double expected = (static_cast<double>(grid.at(x, y, z)) - 2.0) / 1.5;
                EXPECT_NEAR(map.sample(in_voxels(grid, Vec3(x, y, z)), gradient), expected, 2e-4);
            }
        }
    }
}

TEST(DensityMap, agrees_with_the_cardinal_spline_inside_at_the_border_and_outside) {
    const DensityGrid grid = noise_grid({6, 5, 7}, 2);
    const DensityMap map(grid, 2.0, 1.5);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-6.0, 12.0);
    Vec3 gradient;
    for (int i = 0; i < 300; ++i) {
        const Vec3 p = in_voxels(grid, Vec3(place(random), place(random), place(random)));
        EXPECT_NEAR(map.sample(p, gradient), reference(grid, 2.0, 1.5, p), 5e-4);
    }
}

// A wave along x, with the slope projected on that of the wave over a period in fine steps.
TEST(DensityMap, the_slope_of_waves_of_three_voxels_and_more_is_right_on_average) {
    for (const std::uint32_t voxels : {3U, 4U, 5U, 6U, 10U}) {
        DensityGrid grid = noise_grid({120, 40, 40}, 1);
        const double k = 2.0 * M_PI / voxels;
        for (std::size_t i = 0; i < grid.values.size(); ++i)
            grid.values[i] = static_cast<float>(std::cos(k * static_cast<double>(i % 120)));
        const DensityMap map(grid, 0.0, 1.0);
        double along = 0.0, whole = 0.0;
        for (int i = 0; i < 500; ++i) {
            const double x = 60.0 + voxels * (i + 0.5) / 500.0, wave = -k * std::sin(k * x);
            Vec3 gradient;
            (void)map.sample(in_voxels(grid, Vec3(x, 20.3, 19.6)), gradient);
            along += gradient.x() * grid.spacing_m.x() * wave;
            whole += wave * wave;
        }
        EXPECT_NEAR(along / whole, 1.0, 0.01) << voxels << " voxels";
    }
}

TEST(DensityMap, reproduces_a_cubic_polynomial_far_from_the_border) {
    DensityGrid grid = noise_grid({33, 33, 33}, 4);
    grid.spacing_m = Vec3::Constant(kVoxelM);
    const auto f = [](const Vec3& t) {
        const Vec3 u = (t - Vec3::Constant(16.0)) / 8.0;
        return u.x() * u.x() * u.x() - 2.0 * u.y() * u.y() + u.x() * u.y() * u.z() + 0.5 * u.z();
    };
    for (std::uint32_t z = 0; z < 33; ++z) {
        for (std::uint32_t y = 0; y < 33; ++y) {
            for (std::uint32_t x = 0; x < 33; ++x) {
                grid.values[(std::size_t{z} * 33 + y) * 33 + x] = static_cast<float>(f(Vec3(x, y, z)));
            }
        }
    }
    const DensityMap map(grid, 0.0, 1.0);
    Vec3 gradient;
    for (const Vec3& t : {Vec3(16.3, 16.9, 15.2), Vec3(14.0, 17.5, 16.01), Vec3(17.77, 13.13, 18.5)}) {
        EXPECT_NEAR(map.sample(in_voxels(grid, t), gradient), f(t), 2e-4);
    }
}

TEST(DensityMap, gradient_is_the_derivative_of_the_density_everywhere) {
    const DensityGrid grid = noise_grid({6, 6, 6}, 5);
    const DensityMap map(grid, 3.0, 2.0);
    std::mt19937 random(6);
    std::uniform_real_distribution<double> place(-10.0, 16.0);
    for (int i = 0; i < 500; ++i) {
        const Vec3 p = in_voxels(grid, Vec3(place(random), place(random), place(random)));
        Vec3 gradient;
        (void)map.sample(p, gradient);
        EXPECT_LT((gradient - numeric_gradient(map, p)).norm() * kVoxelM, 1e-4);
    }
}

TEST(DensityMap, force_is_continuous_at_voxel_faces_the_box_and_the_end_of_the_spline) {
    const DensityGrid grid = noise_grid({5, 5, 5}, 7);
    const DensityMap map(grid, 0.0, 1.0);  // not normalised: the border is steep
    for (int axis = 0; axis < 3; ++axis) {
        for (int face = -13; face <= 18; ++face) {
            Vec3 t(1.37, 2.61, 0.83), below, above;
            t[axis] = face;
            const Vec3 p = in_voxels(grid, t), step = 1e-7 * grid.spacing_m[axis] * Vec3::Unit(axis);
            const double low = map.sample(p - step, below), high = map.sample(p + step, above);
            EXPECT_NEAR(low, high, 1e-5);
            EXPECT_LT((above - below).norm() * kVoxelM, 1e-5) << "axis " << axis << " face " << face;
        }
    }
}

TEST(DensityMap, is_exactly_zero_far_outside) {
    const DensityGrid grid = noise_grid({4, 4, 4}, 8);
    const DensityMap map(grid, 0.0, 1.0);
    for (const double far : {-12.0, 15.0, 1e3, -1e9, 1e300, -std::numeric_limits<double>::infinity()}) {
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 t = Vec3::Constant(1.5), gradient;
            t[axis] = far;
            EXPECT_EQ(map.sample(in_voxels(grid, t), gradient), 0.0);
            EXPECT_EQ(gradient, Vec3::Zero());
        }
    }
}

TEST(DensityMap, non_finite_input_has_a_defined_result) {
    const DensityGrid grid = noise_grid({4, 4, 4}, 9);
    const DensityMap map(grid, 0.0, 1.0);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Vec3 gradient;
    EXPECT_EQ(map.sample(Vec3(nan, nan, nan), gradient), 0.0);
    EXPECT_EQ(gradient, Vec3::Zero());
    DensityGrid holes = grid;
    holes.values[21] = std::numeric_limits<float>::quiet_NaN();
    holes.values[22] = std::numeric_limits<float>::infinity();
    const DensityMap patched(holes, 0.0, 1.0);
    EXPECT_TRUE(std::isfinite(patched.sample(in_voxels(grid, Vec3(1.4, 1.4, 1.4)), gradient)));
}

TEST(DensityMap, closed_loops_cost_no_work) {
    const DensityGrid grid = noise_grid({8, 8, 8}, 10);
    const DensityMap map(grid, 3.0, 2.0);
    // A circle through faces, corners and the border of the box, on which the trapezoid rule converges fast.
    double work = 0.0, size = 0.0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
        const double a = 2.0 * M_PI * i / kSteps;
        const Vec3 t(3.5 + 5.0 * std::cos(a), 3.5 + 4.0 * std::sin(a), 3.0 + 2.0 * std::sin(2.0 * a));
        const Vec3 dt =
            2.0 * M_PI / kSteps * Vec3(-5.0 * std::sin(a), 4.0 * std::cos(a), 4.0 * std::cos(2.0 * a));
        Vec3 gradient;
        (void)map.sample(in_voxels(grid, t), gradient);
        const double dw = gradient.dot(grid.spacing_m.cwiseProduct(dt));
        work += dw;
        size += std::abs(dw);
    }
    EXPECT_GT(size, 1.0);
    EXPECT_LT(std::abs(work), 1e-5 * size);
}

TEST(DensityMap, refuses_invalid_maps) {
    DensityGrid grid = noise_grid({4, 4, 4}, 11);
    EXPECT_THROW(DensityMap(grid, 0.0, 0.0), StartupError);
    EXPECT_THROW(DensityMap(grid, 0.0, std::numeric_limits<double>::quiet_NaN()), StartupError);
    grid.values.pop_back();
    EXPECT_THROW(DensityMap(grid, 0.0, 1.0), StartupError);
    grid = noise_grid({4, 4, 4}, 11);
    grid.spacing_m.y() = 0.0;
    EXPECT_THROW(DensityMap(grid, 0.0, 1.0), StartupError);
    grid = noise_grid({4, 4, 4}, 11);
    grid.size = {0, 4, 4};
    EXPECT_THROW(DensityMap(grid, 0.0, 1.0), StartupError);
}

}  // namespace
}  // namespace tact::scene_density_map_test
