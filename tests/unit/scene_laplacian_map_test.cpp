// The contour filter against Gaussians and polynomials with known Laplacians.
#include "ipc/scene/density/laplacian_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "ipc/base/error.hpp"
#include "ipc/scene/density/simulated_map.hpp"

namespace tact::scene_laplacian_map_test {
namespace {

constexpr double kA = 1e-10;

DensityGrid filled(const std::array<std::uint32_t, 3>& size, const Vec3& spacing_m,
                   const std::function<double(const Vec3&)>& density) {
    DensityGrid grid;
    grid.size = size;
    grid.spacing_m = spacing_m;
    grid.origin_m = Vec3(-3.0, 5.0, 11.0) * kA;
    for (std::uint32_t z = 0; z < size[2]; ++z) {
        for (std::uint32_t y = 0; y < size[1]; ++y) {
            for (std::uint32_t x = 0; x < size[0]; ++x) {
                grid.values.push_back(
                    static_cast<float>(density(grid.origin_m + spacing_m.cwiseProduct(Vec3(x, y, z)))));
            }
        }
    }
    return grid;
}

// A Gaussian of sigma s filtered with sigma f is a Gaussian with r^2 = s^2 + f^2 and height (s / r)^3; the Laplacian
// of g = exp(-d^2 / 2 r^2) is (d^2 / r^4 - 3 / r^2) g.
TEST(LaplacianMap, of_a_gaussian_matches_the_closed_form) {
    const double resolution_m = 20.0 * kA, f = kSigmaPerResolution * resolution_m, s = 6.0 * kA;
    const double r2 = s * s + f * f, height = std::pow(s * s / r2, 1.5);
    const std::array<std::uint32_t, 3> size{44, 40, 36};
    const Vec3 spacing_m = Vec3(2.0, 2.3, 2.6) * kA;
    const Vec3 middle = Vec3(-3.0, 5.0, 11.0) * kA + 0.5 * spacing_m.cwiseProduct(Vec3(43.0, 39.0, 35.0));
    const double background = 7.0;
    const DensityGrid grid = filled(size, spacing_m, [&](const Vec3& p) {
        return background + 3.0 * std::exp(-(p - middle).squaredNorm() / (2.0 * s * s));
    });
    const DensityGrid got = laplacian_map(grid, background, resolution_m);
    const DensityGrid exact = filled(size, spacing_m, [&](const Vec3& p) {
        const double d2 = (p - middle).squaredNorm();
        return -f * f * 3.0 * height * (d2 / (r2 * r2) - 3.0 / r2) * std::exp(-d2 / (2.0 * r2));
    });
    double peak = 0.0, worst = 0.0;
    for (std::size_t i = 0; i < got.values.size(); ++i) {
        peak = std::max(peak, std::abs(static_cast<double>(exact.values[i])));
        worst = std::max(worst,
                         std::abs(static_cast<double>(got.values[i]) - static_cast<double>(exact.values[i])));
    }
    EXPECT_LT(worst, 1e-3 * peak);
    EXPECT_EQ(got.size, grid.size);
    EXPECT_EQ(got.origin_m, grid.origin_m);
}

TEST(LaplacianMap, is_positive_on_a_hump_and_negative_around_it) {
    const auto blob = [](const Vec3& p) {
        return std::exp(-(p - Vec3::Constant(45.0 * kA)).squaredNorm() / (2.0 * 64.0 * kA * kA));
    };
    const DensityGrid got =
        laplacian_map(filled({34, 34, 34}, Vec3::Constant(3.0 * kA), blob), 0.0, 10.0 * kA);
    const auto at = [&](double offset_a) {
        Vec3 g;
        return DensityMap(got, 0.0, rms_of(got)).sample(Vec3(45.0 + offset_a, 45.0, 45.0) * kA, g);
    };
    EXPECT_GT(at(0.0), 1.0);
    EXPECT_LT(at(20.0), 0.0);
    EXPECT_NEAR(
        rms_of(got) * rms_of(got) * static_cast<double>(got.count()),
        [&] {
            double sum = 0.0;
            for (const float v : got.values) sum += static_cast<double>(v) * static_cast<double>(v);
            return sum;
        }(),
        1e-3 * static_cast<double>(got.count()));
}

TEST(LaplacianMap, of_a_quadratic_is_constant_and_of_a_linear_function_zero) {
    const double resolution_m = 12.0 * kA, f = kSigmaPerResolution * resolution_m;
    for (const double voxel_a : {0.9, 2.0, 4.0, 8.0}) {
        // Far enough from the faces of the map.
        const std::array<std::uint32_t, 3> size{45, 45, 45};
        const auto middle = [&](const DensityGrid& g) { return static_cast<double>(g.at(22, 22, 22)); };
        const double unit = voxel_a * kA;
        const DensityGrid linear = filled(size, Vec3::Constant(unit), [&](const Vec3& p) {
            return 0.5 + (p.x() - 2.0 * p.y() + 3.0 * p.z()) / (40.0 * unit);
        });
        EXPECT_NEAR(middle(laplacian_map(linear, 0.0, resolution_m)), 0.0, 2e-5) << voxel_a;
        const DensityGrid bowl = filled(size, Vec3::Constant(unit), [&](const Vec3& p) {
            return (p.x() * p.x() + 2.0 * p.y() * p.y() - 0.5 * p.z() * p.z()) / (1000.0 * unit * unit);
        });
        // A filter is at least half a voxel wide.
        const double width = std::max(f, 0.5 * unit);
        const double expected = -width * width * 5.0 / (1000.0 * unit * unit);
        EXPECT_NEAR(middle(laplacian_map(bowl, 0.0, resolution_m)), expected,
                    2e-3 * std::abs(expected) + 2e-5);
    }
}

TEST(LaplacianMap, refuses_an_invalid_resolution) {
    const DensityGrid grid = filled({8, 8, 8}, Vec3::Constant(kA), [](const Vec3&) { return 1.0; });
    for (const double bad :
         {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        EXPECT_THROW((void)laplacian_map(grid, 0.0, bad), StartupError);
    }
}

}  // namespace
}  // namespace tact::scene_laplacian_map_test
