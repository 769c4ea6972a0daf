// Fit of residues against sums over all voxels and atoms in double precision, without boxes and cut-offs.
#include "ipc/scene/fit/residue_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ipc/base/units.hpp"

namespace tact::scene_residue_fit_test {
namespace {

constexpr double kA = kAngstromM;
constexpr double kResolutionM = 6.0 * kA;
constexpr int kResidues = 40;

// Four atoms a residue on a wide helix; two chains, the second 20 A away.
Structure two_chains() {
    Structure s;
    s.name = "two chains";
    s.chain_names = {"A", "B"};
    for (std::uint16_t chain = 0; chain < 2; ++chain)
        for (int r = 0; r < kResidues; ++r)
            for (int a = 0; a < 4; ++a) {
                const double along = r + 0.25 * a;
                s.x_m.push_back(static_cast<float>((6.0 * std::cos(0.5 * along) + 20.0 * chain) * kA));
                s.y_m.push_back(static_cast<float>(6.0 * std::sin(0.5 * along) * kA));
                s.z_m.push_back(static_cast<float>((1.2 * along - 24.0) * kA));
                s.element.push_back(a == 3 ? 8 : 6);
                s.mass_fraction.push_back(1.0F / (8 * kResidues));
                s.chain.push_back(chain);
                s.residue.push_back(r + 5 + kResidues * chain);  // no gap between the chains
                s.trace.push_back(a == 1);
            }
    s.mass_u = 12.0 * static_cast<double>(s.size());
    return s;
}

Vec3 atom_m(const Structure& s, const Pose& pose, std::size_t i) {
    return pose *
           Vec3(static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]), static_cast<double>(s.z_m[i]));
}

// Of the atoms that `of` selects, at every voxel.
template <class Of>
std::vector<double> density(const DensityGrid& grid, const Structure& s, const Pose& pose, const Of& of) {
    const double sigma_m = 0.225 * kResolutionM;
    std::vector<double> values(grid.count(), 0.0);
    for (std::size_t i = 0; i < s.size(); ++i) {
        if (!of(i)) continue;
        const Vec3 at = atom_m(s, pose, i);
        std::size_t voxel = 0;
        for (std::uint32_t z = 0; z < grid.size[2]; ++z)
            for (std::uint32_t y = 0; y < grid.size[1]; ++y)
                for (std::uint32_t x = 0; x < grid.size[0]; ++x, ++voxel) {
                    const Vec3 d =
                        (grid.origin_m + grid.spacing_m.cwiseProduct(Vec3(x, y, z)) - at) / sigma_m;
                    if (d.cwiseAbs().maxCoeff() < 4.0)
                        values[voxel] += s.element[i] * std::exp(-0.5 * d.squaredNorm());
                }
    }
    return values;
}

double reference(const DensityGrid& grid, const std::vector<double>& region,
                 const std::vector<double>& simulated) {
    const double most = *std::max_element(region.begin(), region.end());
    double n = 0, u = 0, v = 0;
    for (std::size_t i = 0; i < region.size(); ++i)
        if (region[i] > 0.05 * most) n += 1.0, u += static_cast<double>(grid.values[i]), v += simulated[i];
    u /= n, v /= n;
    double uu = 0, vv = 0, uv = 0;
    for (std::size_t i = 0; i < region.size(); ++i)
        if (region[i] > 0.05 * most) {
            const double du = static_cast<double>(grid.values[i]) - u, dv = simulated[i] - v;
            uu += du * du, vv += dv * dv, uv += du * dv;
        }
    return uv / std::sqrt(uu * vv);
}

struct Made {
    Structure structure = two_chains();
    Pose pose{Vec3(1.0, -2.0, 3.0) * kA, quat_from_rotation_vector(Vec3(0.3, 0.2, -0.4))};
    DensityGrid grid;
    FitSettings settings{.resolution_m = kResolutionM, .background = 0.5, .sigma = 2.0};
    // The map: the structure with residues 20 to 24, and the first three of chain B, moved by 5 A, on an offset of 0.5.
    Made() {
        grid.size = {40, 34, 44};
        grid.spacing_m = Vec3(1.8, 1.9, 2.0) * kA;
        grid.origin_m = Vec3(-24.0, -32.0, -44.0) * kA;
        Structure moved = structure;
        for (std::size_t i = 0; i < moved.size(); ++i)
            if ((moved.residue[i] >= 20 && moved.residue[i] <= 24) ||
                (moved.chain[i] == 1 && moved.residue[i] <= 47))
                moved.x_m[i] += static_cast<float>(5.0 * kA);
        for (const double v : density(grid, moved, pose, [](std::size_t) { return true; }))
            grid.values.push_back(static_cast<float>(0.1 * v + 0.5));
    }
};

TEST(ResidueFit, the_correlation_of_a_window_is_that_of_sums_over_all_voxels) {
    const Made m;
    const PlacedStructure placed{&m.structure, m.pose};
    const std::vector<ResidueFit> fit = residue_fit(m.grid, {&placed, 1}, m.settings, 7);
    ASSERT_EQ(fit.size(), 2U * kResidues);
    const std::vector<double> all = density(m.grid, m.structure, m.pose, [](std::size_t) { return true; });
    for (const std::size_t r : {std::size_t{0}, std::size_t{10}, std::size_t{17}, std::size_t{39},
                                std::size_t{40}, std::size_t{79}}) {
        const ResidueFit& f = fit[r];
        EXPECT_EQ(f.chain, r / kResidues);
        EXPECT_EQ(f.residue, static_cast<int>(r) + 5);
        EXPECT_EQ(f.atoms, 4U);
        const auto window = density(m.grid, m.structure, m.pose, [&](std::size_t i) {
            return m.structure.chain[i] == f.chain && std::abs(m.structure.residue[i] - f.residue) <= 3;
        });
        ASSERT_TRUE(f.correlation) << r;
        EXPECT_NEAR(*f.correlation, reference(m.grid, window, all), 2e-4) << r;
    }
}

TEST(ResidueFit, a_stretch_that_is_elsewhere_in_the_map_is_found_and_the_rest_is_not_blamed) {
    const Made m;
    const PlacedStructure placed{&m.structure, m.pose};
    const std::vector<ResidueFit> fit = residue_fit(m.grid, {&placed, 1}, m.settings, 5);
    double worst_right = 1.0, best_wrong = -1.0, right_sigma = 0.0, wrong_sigma = 0.0;
    for (const ResidueFit& f : fit) {
        const bool wrong = f.chain == 0 && f.residue >= 20 && f.residue <= 24;
        if (wrong) best_wrong = std::max(best_wrong, *f.correlation), wrong_sigma += f.density_sigma / 5.0;
        // Twelve residues away no atom of a window is near a moved one, and the end of chain A is not beside the start of B.
        if (f.residue > 59 || (f.chain == 0 && std::abs(f.residue - 22) > 12)) {
            worst_right = std::min(worst_right, *f.correlation);
            right_sigma = std::max(right_sigma, f.density_sigma);
        }
    }
    EXPECT_GT(worst_right, 0.97);
    EXPECT_LT(best_wrong, 0.85);
    EXPECT_GT(right_sigma, wrong_sigma);
}

TEST(ResidueFit,
     residues_off_the_map_have_none_an_unknown_unit_is_zero_and_an_unknown_resolution_is_refused) {
    Made m;
    m.pose.p_m += Vec3(0.0, 0.0, 1e-7);
    const PlacedStructure placed{&m.structure, m.pose};
    for (const ResidueFit& f : residue_fit(m.grid, {&placed, 1}, m.settings, 5)) {
        EXPECT_FALSE(f.correlation);
        EXPECT_EQ(f.density_sigma, 0.0);  // background
    }
    Made flat;
    flat.settings.sigma = 0.0;
    const PlacedStructure there{&flat.structure, flat.pose};
    for (const ResidueFit& f : residue_fit(flat.grid, {&there, 1}, flat.settings, 5))
        EXPECT_EQ(f.density_sigma, 0.0);
    m.settings.resolution_m = 0.0;
    EXPECT_THROW((void)residue_fit(m.grid, {&placed, 1}, m.settings, 5), std::runtime_error);
}

}  // namespace
}  // namespace tact::scene_residue_fit_test
