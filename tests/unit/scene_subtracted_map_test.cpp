// Subtraction of placed structures from maps that are known sums of them.
#include "ipc/scene/density/subtracted_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ipc/base/error.hpp"
#include "ipc/base/random.hpp"

namespace tact::scene_subtracted_map_test {
namespace {

constexpr double kA = 1e-10, kResolutionM = 10.0 * kA;

Structure ball(std::size_t atoms, std::uint64_t seed) {
    Structure s;
    s.name = "ball";
    s.mass_u = 13.0 * static_cast<double>(atoms);
    SeededRandom random(seed);
    for (std::size_t i = 0; i < atoms; ++i) {
        const Vec3 p = 12.0 * kA * std::cbrt(random.uniform()) * random.direction();
        s.x_m.push_back(static_cast<float>(p.x()));
        s.y_m.push_back(static_cast<float>(p.y()));
        s.z_m.push_back(static_cast<float>(p.z()));
        s.mass_fraction.push_back(1.0F / static_cast<float>(atoms));
        s.element.push_back(static_cast<std::uint8_t>(6 + random.below(3)));
    }
    return s;
}

struct Scene {
    Structure left = ball(300, 1), right = ball(250, 2);
    PlacedStructure placed_left, placed_right;
    DensityGrid grid;

    explicit Scene(double apart_a, double scale = 0.25, double background = -3.0)
        : placed_left{&left, {Vec3(40.0, 40.0, 40.0) * kA, quat_from_rotation_vector(Vec3(0.3, 1.0, 0.0))}},
          placed_right{&right, {Vec3(40.0 + apart_a, 40.0, 40.0) * kA, Quat::Identity()}} {
        grid.size = {70, 40, 40};
        grid.spacing_m = Vec3::Constant(2.0 * kA);
        const PlacedStructure both[] = {placed_left, placed_right};
        grid.values = simulated_map(grid, both, kResolutionM);
        for (float& v : grid.values) {
            v = static_cast<float>(background + scale * static_cast<double>(v));
        }
    }
};

double norm_above(const DensityGrid& grid, double background) {
    double sum = 0.0;
    for (const float v : grid.values) sum += std::pow(static_cast<double>(v) - background, 2.0);
    return std::sqrt(sum);
}

TEST(SubtractedMap, of_all_contents_leaves_the_background) {
    const Scene s(30.0);
    const PlacedStructure both[] = {s.placed_left, s.placed_right};
    const SubtractedMap out = subtract_placed(s.grid, -3.0, both, kResolutionM);
    EXPECT_NEAR(out.scale, 0.25, 1e-4);
    EXPECT_NEAR(out.explained, 1.0, 1e-5);
    EXPECT_GT(out.region_voxels, 100U);
    EXPECT_LT(norm_above(out.grid, -3.0), 1e-4 * norm_above(s.grid, -3.0));
}

TEST(SubtractedMap, leaves_the_structure_that_was_not_placed) {
    const Scene s(50.0);  // without overlap
    const SubtractedMap out = subtract_placed(s.grid, -3.0, {&s.placed_left, 1}, kResolutionM);
    EXPECT_NEAR(out.scale, 0.25, 1e-3);
    const std::vector<float> rest = simulated_map(s.grid, {&s.placed_right, 1}, kResolutionM);
    const auto peak = static_cast<double>(*std::max_element(rest.begin(), rest.end()));
    for (std::size_t i = 0; i < rest.size(); ++i) {
        ASSERT_NEAR(static_cast<double>(out.grid.values[i]), -3.0 + 0.25 * static_cast<double>(rest[i]),
                    1e-3 * peak);
    }
}

TEST(SubtractedMap, an_overlapping_structure_changes_the_scale_only_slightly) {
    const Scene s(24.0);  // in contact
    const SubtractedMap out = subtract_placed(s.grid, -3.0, {&s.placed_left, 1}, kResolutionM);
    EXPECT_GT(out.scale, 0.25);
    EXPECT_LT(out.scale, 0.30);
}

TEST(SubtractedMap, never_lowers_the_map_below_the_background) {
    Scene s(50.0);
    // Half of the left structure is missing in the map, and the solvent is uneven.
    for (std::uint32_t z = 0; z < s.grid.size[2]; ++z) {
        for (std::uint32_t y = 0; y < s.grid.size[1]; ++y) {
            for (std::uint32_t x = 0; x < s.grid.size[0]; ++x) {
                float& v = s.grid.values[(std::size_t{z} * s.grid.size[1] + y) * s.grid.size[0] + x];
                if (y < 20) v = x % 2 == 0 ? -3.5F : -3.0F;
            }
        }
    }
    const SubtractedMap out = subtract_placed(s.grid, -3.0, {&s.placed_left, 1}, kResolutionM);
    for (std::size_t i = 0; i < out.grid.values.size(); ++i) {
        ASSERT_GE(out.grid.values[i], std::min(-3.0F, s.grid.values[i]));
        ASSERT_LE(out.grid.values[i], s.grid.values[i]);
    }
}

TEST(SubtractedMap, without_overlap_the_map_is_unchanged) {
    const Scene s(30.0);
    EXPECT_EQ(subtract_placed(s.grid, -3.0, {}, kResolutionM).grid.values, s.grid.values);
    PlacedStructure away = s.placed_left;
    away.T_model_body.p_m.x() = 1e-6;
    EXPECT_EQ(subtract_placed(s.grid, -3.0, {&away, 1}, kResolutionM).grid.values, s.grid.values);
    // A map that is darker at the structure gets no negative scale.
    DensityGrid dark = s.grid;
    for (float& v : dark.values) v = -6.0F - v;
    const SubtractedMap out = subtract_placed(dark, -3.0, {&s.placed_left, 1}, kResolutionM);
    EXPECT_EQ(out.scale, 0.0);
    EXPECT_EQ(out.grid.values, dark.values);
    EXPECT_THROW((void)subtract_placed(s.grid, -3.0, {&s.placed_left, 1}, 0.0), StartupError);
}

}  // namespace
}  // namespace tact::scene_subtracted_map_test
