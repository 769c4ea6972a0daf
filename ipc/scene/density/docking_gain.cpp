// With U = -k_E sum w rho and S = world_per_model, the force is (k_E / S) |g|, g = sum w grad rho, and the
// stiffness along a direction is (k_E / S^2) times the curvature of sum w rho, whose largest magnitude is
// the spectral norm of the Hessian H. H is computed from differences of g over a quarter of a voxel, on
// which the spline is smooth.
//
// Poses: half of them within 20 A and 30 degrees of home, like a structure that belongs in the map; the
// other half anywhere, with random rotation and the centre at the densest of 16 random points of the box.
// Only poses whose own mean density is above the median count, because there is no force far from any
// density.
#include "ipc/scene/density/docking_gain.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "ipc/base/error.hpp"
#include "ipc/base/random.hpp"

namespace tact {

namespace {

constexpr double kNearM = 20e-10, kNearRad = 0.5236;

PointsView points_of(const Structure& structure, const Codebook& codebook) {
    for (const Codebook::Level& level : codebook.levels) {
        if (level.size() >= kGainVectors) return level.view();
    }
    return {structure.x_m, structure.y_m, structure.z_m, structure.mass_fraction};
}

Vec3 dense_point(const DensityMap& map, SeededRandom& random) {
    Vec3 best = map.origin_m(), gradient;
    double most = -1e300;
    for (int draw = 0; draw < 16; ++draw) {
        Vec3 p;
        for (int a = 0; a < 3; ++a) {
            const double width = map.spacing_m()[a] * (map.size()[static_cast<std::size_t>(a)] - 1.0);
            p[a] = map.origin_m()[a] + width * random.uniform();
        }
        const double density = map.sample(p, gradient);
        if (density > most) most = density, best = p;
    }
    return best;
}

struct Felt {
    double density_sigma, slope, curvature;  // sigma, sigma / m, sigma / m^2, per model metre
};

Felt feel(const DensityMap& map, const PointsView& points, const Pose& pose) {
    const DensitySums here = map.sum(points, pose);
    Eigen::Matrix3d hessian;
    for (int a = 0; a < 3; ++a) {
        const double h = 0.25 * map.spacing_m()[a];
        Pose fore = pose, back = pose;
        fore.p_m[a] += h;
        back.p_m[a] -= h;
        hessian.col(a) = (map.sum(points, fore).gradient - map.sum(points, back).gradient) / (2.0 * h);
    }
    const Eigen::Matrix3d symmetric = 0.5 * (hessian + hessian.transpose());
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(symmetric, Eigen::EigenvaluesOnly);
    return {here.density_sigma, here.gradient.norm(), solver.eigenvalues().cwiseAbs().maxCoeff()};
}

}  // namespace

DockingGain docking_gain(const DensityMap& map, std::span<const Structure> structures,
                         std::span<const Codebook> codebooks, double world_per_model,
                         const GainSettings& settings, const Progress& progress) {
    std::vector<GainBody> bodies;
    for (std::size_t i = 0; i < structures.size() && structures.size() == codebooks.size(); ++i) {
        bodies.push_back({points_of(structures[i], codebooks[i]), structures[i].home()});
    }
    return docking_gain(map, bodies, world_per_model, settings, progress);
}

DockingGain docking_gain(const DensityMap& map, std::span<const GainBody> bodies, double world_per_model,
                         const GainSettings& settings, const Progress& progress) {
    const std::string attempt = "choosing the gain of the docking force";
    if (bodies.empty() || !(world_per_model > 0.0)) {
        throw StartupError(attempt, "no structure with a codebook, or no scale, is given", "add a structure");
    }
    double slope_p99 = 0.0, curvature_max = 0.0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        report(progress, static_cast<double>(i) / static_cast<double>(bodies.size()), "gain");
        SeededRandom random(settings.seed + i);
        const PointsView& points = bodies[i].points;
        std::vector<Felt> felt;
        for (std::uint32_t k = 0; k < std::max(settings.poses, 4U); ++k) {
            Pose pose = bodies[i].home;
            if (k % 2 == 0) {
                pose.p_m += kNearM * random.uniform() * random.direction();
                pose.q = quat_from_rotation_vector(kNearRad * random.uniform() * random.direction());
            } else {
                pose = {dense_point(map, random), random.rotation()};
            }
            felt.push_back(feel(map, points, pose));
        }
        std::sort(felt.begin(), felt.end(),
                  [](const Felt& a, const Felt& b) { return a.density_sigma > b.density_sigma; });
        felt.resize(felt.size() / 2);
        for (const Felt& f : felt) curvature_max = std::max(curvature_max, f.curvature);
        std::sort(felt.begin(), felt.end(), [](const Felt& a, const Felt& b) { return a.slope < b.slope; });
        slope_p99 = std::max(slope_p99, felt[(felt.size() - 1) * 99 / 100].slope);
    }
    if (!(slope_p99 > 0.0) || !(curvature_max > 0.0)) {
        throw StartupError(attempt, "no pose of the structures overlaps any density of the map",
                           "check that the map holds a molecule, and that its voxel size is right");
    }
    const double by_force = settings.force_n * world_per_model / slope_p99;
    const double by_stiffness = settings.stiffness_n_m * world_per_model * world_per_model / curvature_max;
    DockingGain gain;
    gain.energy_j_per_sigma = std::min(by_force, by_stiffness);
    gain.force_n_p99 = gain.energy_j_per_sigma / world_per_model * slope_p99;
    gain.stiffness_n_m_max = gain.energy_j_per_sigma / (world_per_model * world_per_model) * curvature_max;
    report(progress, 1.0, "gain");
    return gain;
}

}  // namespace tact
