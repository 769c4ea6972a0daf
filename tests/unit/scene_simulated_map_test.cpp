// The simulated map against a full sum over atoms and voxels, in double precision without cut-off.
#include "ipc/scene/density/simulated_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "ipc/base/error.hpp"

namespace tact::scene_simulated_map_test {
namespace {

constexpr double kA = 1e-10;

Structure cloud(std::size_t count, unsigned seed) {
    Structure s;
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0.0, 7.0 * kA);
    s.mass_u = 13.0 * static_cast<double>(count);
    for (std::size_t i = 0; i < count; ++i) {
        s.x_m.push_back(static_cast<float>(normal(random)));
        s.y_m.push_back(static_cast<float>(normal(random)));
        s.z_m.push_back(static_cast<float>(normal(random)));
        s.mass_fraction.push_back(1.0F / static_cast<float>(count));
        s.element.push_back(
            static_cast<std::uint8_t>(i % 3 == 0 ? 0 : 5 + i % 4));  // 0: weighted by its mass of 13 u
    }
    return s;
}

DensityGrid box_of(std::array<std::uint32_t, 3> size, const Vec3& spacing_m) {
    DensityGrid grid;
    grid.size = size;
    grid.spacing_m = spacing_m;
    grid.origin_m = Vec3(-25 * kA, -22 * kA, -18 * kA);
    return grid;
}

const Pose kTilted{Vec3(3 * kA, -2 * kA, 1 * kA), quat_from_rotation_vector(Vec3(0.4, -0.3, 0.7))};

double naive(const DensityGrid& grid, const Structure& s, const Pose& pose, double resolution_m,
             std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    const double sigma = 0.225 * resolution_m;
    const Vec3 voxel = grid.origin_m + grid.spacing_m.cwiseProduct(Vec3(x, y, z));
    double sum = 0.0;
    for (std::size_t i = 0; i < s.size(); ++i) {
        const Vec3 atom = pose * Vec3(static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]),
                                      static_cast<double>(s.z_m[i]));
        sum += (s.element[i] != 0 ? s.element[i] : 13.0) *
               std::exp(-(voxel - atom).squaredNorm() / (2.0 * sigma * sigma));
    }
    return sum;
}

TEST(SimulatedMap, is_the_sum_of_gaussians_over_all_atoms) {
    const Structure s = cloud(50, 1);
    for (const double resolution_a : {4.0, 10.0, 60.0}) {  // sigma from below a voxel to many voxels
        const DensityGrid grid = box_of({21, 19, 17}, Vec3(2.5, 2.3, 2.1) * kA);
        const PlacedStructure placed{&s, kTilted};
        const std::vector<float> map = simulated_map(grid, {&placed, 1}, resolution_a * kA);
        double most = 0.0, worst = 0.0;
        std::size_t i = 0;
        for (std::uint32_t z = 0; z < grid.size[2]; ++z) {
            for (std::uint32_t y = 0; y < grid.size[1]; ++y) {
                for (std::uint32_t x = 0; x < grid.size[0]; ++x, ++i) {
                    const double truth = naive(grid, s, kTilted, resolution_a * kA, x, y, z);
                    most = std::max(most, truth);
                    worst = std::max(worst, std::abs(static_cast<double>(map[i]) - truth));
                }
            }
        }
        EXPECT_LT(worst, 1e-3 * most)
            << resolution_a;  // the cut-off is 3e-4 of an atom's height, and atoms add up
    }
}

TEST(SimulatedMap, a_box_matches_the_whole_map_and_the_rest_is_zero) {
    const Structure s = cloud(30, 2);
    const DensityGrid grid = box_of({60, 50, 40}, Vec3(2.0, 2.0, 2.0) * kA);
    const PlacedStructure placed{&s, kTilted};
    const VoxelBox box = reached_box(grid, {&placed, 1}, 8.0 * kA);
    ASSERT_GT(box.count(), 0U);
    ASSERT_LT(box.count(), grid.count());
    std::vector<float> part(box.count(), 0.0F);
    add_simulated(grid, placed, 8.0 * kA, 1.0F, box, part);
    std::vector<float> rest = simulated_map(grid, {&placed, 1}, 8.0 * kA);
    std::size_t i = 0;
    for (std::uint32_t z = 0; z < box.size[2]; ++z) {
        for (std::uint32_t y = 0; y < box.size[1]; ++y) {
            for (std::uint32_t x = 0; x < box.size[0]; ++x, ++i) {
                float& whole =
                    rest[(std::size_t{box.first[2] + z} * grid.size[1] + box.first[1] + y) * grid.size[0] +
                         box.first[0] + x];
                ASSERT_NEAR(part[i], whole, 1e-4F);
                whole = 0.0F;
            }
        }
    }
    for (const float v : rest) ASSERT_EQ(v, 0.0F);
}

TEST(SimulatedMap, an_added_structure_can_be_subtracted_again) {
    const Structure s = cloud(30, 3);
    const DensityGrid grid = box_of({30, 30, 30}, Vec3(2.0, 2.0, 2.0) * kA);
    const PlacedStructure placed{&s, kTilted};
    std::vector<float> map(grid.count(), 1.0F);
    add_simulated(grid, placed, 8.0 * kA, 2.5F, whole_box(grid), map);
    add_simulated(grid, placed, 8.0 * kA, -2.5F, whole_box(grid), map);
    for (const float v : map) ASSERT_NEAR(v, 1.0F, 1e-4F);
}

TEST(SimulatedMap, off_the_grid_the_map_is_zero) {
    const Structure s = cloud(10, 4);
    const DensityGrid grid = box_of({10, 10, 10}, Vec3(2.0, 2.0, 2.0) * kA);
    for (const double far : {1e-6, -1e300, std::nan(""), HUGE_VAL}) {
        const PlacedStructure placed{&s, {Vec3(0, far, 0), Quat::Identity()}};
        EXPECT_EQ(reached_box(grid, {&placed, 1}, 8.0 * kA).count(), 0U);
        for (const float v : simulated_map(grid, {&placed, 1}, 8.0 * kA)) ASSERT_EQ(v, 0.0F);
    }
    EXPECT_EQ(reached_box(grid, {}, 8.0 * kA).count(), 0U);
}

TEST(SimulatedMap, an_impossible_resolution_is_refused) {
    const Structure s = cloud(3, 5);
    const DensityGrid grid = box_of({4, 4, 4}, Vec3(2.0, 2.0, 2.0) * kA);
    const PlacedStructure placed{&s, Pose{}};
    for (const double resolution_m : {0.0, -1.0, std::nan(""), HUGE_VAL})
        EXPECT_THROW((void)simulated_map(grid, {&placed, 1}, resolution_m), StartupError);
}

}  // namespace
}  // namespace tact::scene_simulated_map_test
