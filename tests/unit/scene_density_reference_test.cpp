// The density sampler against an independent spline in double precision, and against the Gaussians of which a map is made.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/chain_sample.hpp"

namespace tact::scene_density_reference_test {
namespace {

using namespace chain;

constexpr double kResolutionM = 10.0 * kA, kSigmaM = 0.225 * kResolutionM;

PointsView points_of(const Structure& s) { return {s.x_m, s.y_m, s.z_m, s.mass_fraction}; }

Pose near(const Pose& home, double within_m, double within_rad, SeededRandom& random) {
    return {home.p_m + random.within(within_m),
            quat_from_rotation_vector(random.within(within_rad)) * home.q};
}

DensityMap::Options once() {
    DensityMap::Options options;
    options.windows_bytes_max = 0;
    return options;
}

TEST(DensityReference, sums_and_their_derivatives_agree_with_an_independent_spline) {
    Structure s = structure(150);
    DensityGrid grid = map_of(s, kSigmaM, kResolutionM / 3.5);
    grid.spacing_m = grid.spacing_m.cwiseProduct(Vec3(1.0, 1.1, 0.9));
    const double sigma = sigma_of(grid), background = 0.1 * sigma;
    const DensityMap fourfold(grid, background, sigma), stored_once(grid, background, sigma, once());
    const reference::Spline spline(grid_of(grid, background, sigma));
    const reference::Atoms atoms = atoms_of(s);
    SeededRandom random(3);
    for (int i = 0; i < 30; ++i) {
        const Pose pose = near(s.home(), (i % 3 == 0 ? 60.0 : 8.0) * kA, 3.0, random);
        const reference::Sums exact = sum(spline, atoms, place_of(pose));
        for (const DensityMap* map : {&fourfold, &stored_once}) {
            const DensitySums sums = map->sum(points_of(s), pose);
            const double size_m = 10.0 * kA, voxel_m = 2.5 * kA;
            EXPECT_NEAR(sums.density_sigma, exact.density, 1e-4);
            EXPECT_LT((sums.gradient - exact.gradient).norm() * voxel_m, 1e-4);
            EXPECT_LT((sums.moment - exact.moment).norm() * voxel_m / size_m, 1e-4);
            const DensityBends bends = map->bends(points_of(s), pose);
            EXPECT_LT((bends.by_shift - exact.by_shift).norm() * voxel_m * voxel_m, 2e-4);
            EXPECT_LT((bends.by_turn - exact.by_turn).norm() * std::pow(voxel_m / size_m, 2), 2e-4);
        }
    }
}

TEST(DensityReference, bends_are_the_derivatives_of_the_sums) {
    Structure s = structure(150);
    const DensityGrid grid = map_of(s, kSigmaM, kResolutionM / 3.5);
    const reference::Spline spline(grid_of(grid, 0.0, sigma_of(grid)));
    const reference::Atoms atoms = atoms_of(s);
    SeededRandom random(4);
    const Pose pose = near(s.home(), 5.0 * kA, 0.5, random);
    const reference::Sums here = sum(spline, atoms, place_of(pose));
    Eigen::Matrix3d by_shift, by_turn;
    for (int a = 0; a < 3; ++a) {
        const double step_m = 1e-3 * kA, turn_rad = 1e-5;
        Pose fore = pose, back = pose;
        fore.p_m[a] += step_m, back.p_m[a] -= step_m;
        by_shift.col(a) =
            (sum(spline, atoms, place_of(fore)).gradient - sum(spline, atoms, place_of(back)).gradient) /
            (2.0 * step_m);
        fore = back = pose;
        fore.q = quat_from_rotation_vector(turn_rad * Vec3::Unit(a)) * pose.q;
        back.q = quat_from_rotation_vector(-turn_rad * Vec3::Unit(a)) * pose.q;
        by_turn.col(a) =
            (sum(spline, atoms, place_of(fore)).moment - sum(spline, atoms, place_of(back)).moment) /
            (2.0 * turn_rad);
    }
    EXPECT_LT((by_shift - here.by_shift).norm(), 1e-5 * here.by_shift.norm());
    EXPECT_LT((0.5 * (by_turn + by_turn.transpose()) - here.by_turn).norm(), 1e-5 * here.by_turn.norm());
}

// RMS error of force and torque over poses around the answer, relative to their RMS.
struct Off {
    double force = 0.0, torque = 0.0;
};
Off off_from_gaussians(double voxels_per_resolution, bool interpolating) {
    Structure s = structure(600);
    const DensityGrid grid = map_of(s, kSigmaM, kResolutionM / voxels_per_resolution);
    DensityMap::Options options;
    options.interpolating = interpolating;
    const DensityMap map(grid, 0.0, 1.0, options);
    const reference::Atoms atoms = atoms_of(s);
    SeededRandom random(5);
    double off[2] = {}, all[2] = {};
    for (int i = 0; i < 12; ++i) {
        const Pose pose = near(s.home(), 8.0 * kA, 0.5, random);
        Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
        for (std::size_t k = 0; k < atoms.at_m.size(); ++k) {
            const Vec3 r = pose.q * atoms.at_m[k];
            const Vec3 g = atoms.weight[k] *
                           reference::gaussians(atoms, place_of(s.home()), kSigmaM, pose.p_m + r).gradient;
            force += g, torque += r.cross(g);
        }
        const DensitySums sums = map.sum(points_of(s), pose);
        off[0] += (sums.gradient - force).squaredNorm(), all[0] += force.squaredNorm();
        off[1] += (sums.moment - torque).squaredNorm(), all[1] += torque.squaredNorm();
    }
    return {std::sqrt(off[0] / all[0]), std::sqrt(off[1] / all[1])};
}

// Below four voxels per resolution the samples themselves alias; see density_map.cpp.
TEST(DensityReference, the_force_is_that_of_the_gaussians_of_the_map) {
    const Off four = off_from_gaussians(4.0, false), four_before = off_from_gaussians(4.0, true);
    EXPECT_LT(four.force, 0.01);
    EXPECT_LT(four.torque, 0.02);
    EXPECT_LT(four.force, 0.8 * four_before.force);
    const Off three = off_from_gaussians(3.0, false), three_before = off_from_gaussians(3.0, true);
    EXPECT_LT(three.force, 0.04);
    EXPECT_LT(three.force, 0.8 * three_before.force);
}

}  // namespace
}  // namespace tact::scene_density_reference_test
