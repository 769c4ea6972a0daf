// The docking gain on a map whose forces have a closed form.
#include "ipc/scene/density/docking_gain.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ipc/base/error.hpp"

namespace tact::scene_docking_gain_test {
namespace {

constexpr double kA = 1e-10;

// One Gaussian of 12 A in the centre of a box and one atom: the slope is at most exp(-1/2) / s and the curvature at
// most 1 / s^2, in units of the peak.
constexpr double kSigmaM = 12.0 * kA;
constexpr double kPeak = 8.0;

DensityGrid blob() {
    DensityGrid grid;
    grid.size = {50, 50, 50};
    grid.spacing_m = Vec3::Constant(3.0 * kA);
    grid.values.resize(grid.count());
    const Vec3 middle = Vec3::Constant(75.0 * kA);
    for (std::uint32_t z = 0; z < 50; ++z) {
        for (std::uint32_t y = 0; y < 50; ++y) {
            for (std::uint32_t x = 0; x < 50; ++x) {
                const double d2 = (3.0 * kA * Vec3(x, y, z) - middle).squaredNorm();
                grid.values[(std::size_t{z} * 50 + y) * 50 + x] =
                    static_cast<float>(kPeak * std::exp(-d2 / (2.0 * kSigmaM * kSigmaM)));
            }
        }
    }
    return grid;
}

Structure one_atom() {
    Structure s;
    s.name = "atom";
    s.home_com_model_m = Vec3::Constant(75.0 * kA);
    s.x_m = s.y_m = s.z_m = {0.0F};
    s.mass_fraction = {1.0F};
    return s;
}

LevelMaps map_of(const DensityGrid& grid, double background, double sigma) {
    return make_level_maps(grid, background, sigma, 0.0, {{}});
}

const std::vector<Structure> kStructures{one_atom()};
const std::vector<Codebook> kNoCodebook(1);

TEST(DockingGain, stiffness_reaches_its_limit_for_a_sharp_blob) {
    const LevelMaps map = map_of(blob(), 0.0, 1.0);
    const double scale = 0.1 / (150.0 * kA);
    GainSettings settings;
    settings.force_n = 1000.0;
    const DockingGain gain = docking_gain(map, kStructures, kNoCodebook, scale, settings);
    EXPECT_NEAR(gain.stiffness_n_m_max, 300.0, 1e-6);
    const double expected = 300.0 * scale * scale / (kPeak / (kSigmaM * kSigmaM));
    EXPECT_NEAR(gain.energy_j_per_sigma, expected, 0.05 * expected);
}

TEST(DockingGain, force_reaches_its_limit_for_a_wide_blob) {
    const LevelMaps map = map_of(blob(), 0.0, 1.0);
    const double scale = 0.1 / (150.0 * kA);
    GainSettings settings;
    settings.stiffness_n_m = 1e9;
    const DockingGain gain = docking_gain(map, kStructures, kNoCodebook, scale, settings);
    EXPECT_NEAR(gain.force_n_p99, 2.0, 1e-9);
    const double expected = 2.0 * scale / (kPeak * std::exp(-0.5) / kSigmaM);
    EXPECT_NEAR(gain.energy_j_per_sigma, expected, 0.05 * expected);
}

TEST(DockingGain, both_limits_hold) {
    const LevelMaps map = map_of(blob(), 0.0, 1.0);
    for (const double scale : {1e6, 1e7, 1e8}) {
        const DockingGain gain = docking_gain(map, kStructures, kNoCodebook, scale);
        EXPECT_LE(gain.force_n_p99, 2.0 * (1.0 + 1e-9));
        EXPECT_LE(gain.stiffness_n_m_max, 300.0 * (1.0 + 1e-9));
        EXPECT_GT(gain.energy_j_per_sigma, 0.0);
    }
}

TEST(DockingGain, does_not_depend_on_the_unit_of_the_map) {
    DensityGrid grid = blob();
    const DockingGain a = docking_gain(map_of(grid, 0.0, 1.0), kStructures, kNoCodebook, 1e7);
    for (float& v : grid.values) v = 1000.0F * v + 50.0F;
    const DockingGain b = docking_gain(map_of(grid, 50.0, 1000.0), kStructures, kNoCodebook, 1e7);
    EXPECT_NEAR(a.energy_j_per_sigma, b.energy_j_per_sigma, 1e-3 * a.energy_j_per_sigma);
}

TEST(DockingGain, an_empty_map_is_refused) {
    DensityGrid grid = blob();
    std::fill(grid.values.begin(), grid.values.end(), 0.0F);
    EXPECT_THROW(docking_gain(map_of(grid, 0.0, 1.0), kStructures, kNoCodebook, 1e7), StartupError);
    EXPECT_THROW(docking_gain(map_of(blob(), 0.0, 1.0), {}, {}, 1e7), StartupError);
}

}  // namespace
}  // namespace tact::scene_docking_gain_test
