// With U = -k_E sum w rho, S = world_per_model, the force is (k_E / S) |g|, g = sum w grad rho, and the stiffness
// along a direction is (k_E / S^2) times the curvature of sum w rho, whose largest magnitude is the spectral norm of
// the second derivatives H (DensityMap::bends).
//
// Poses: half of them within 20 A and 30 degrees of home, like a structure that belongs in the map; the
// other half anywhere, with random rotation and the centre at the densest of 16 random points of the box.
// Only poses whose own mean density is above the median count, because there is no force far from any
// density.
//
// Fits: the density is most curved where the body belongs, a place that random poses hardly hit: over the ring of 1OEL in its
// map at 7 A they missed half and more of the stiffness at the answer. So some of the poses, and home, climb to their maxima: a short
// way with some hundreds of vectors, then with all atoms. Forces are also sampled within 5 A and 10 degrees of the fits.
#include "ipc/scene/density/docking_gain.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "ipc/base/error.hpp"
#include "ipc/base/random.hpp"
#include "ipc/scene/density/climb.hpp"

namespace tact {

namespace {

constexpr double kNearM = 20e-10, kNearRad = 0.5236;
constexpr double kFitM = 5e-10, kFitRad = 0.1745;
constexpr std::uint32_t kPosesPerFit = 8;
constexpr std::size_t kClimbVectors = 800;
constexpr int kClimbSums = 150, kClimbSumsAtoms = 100;

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

Pose near(const Pose& pose, double within_m, double within_rad, SeededRandom& random) {
    const Vec3 shift = random.within(within_m);
    const Quat turn = quat_from_rotation_vector(random.within(within_rad));
    return {pose.p_m + shift, (turn * pose.q).normalized()};
}

// Largest values over the poses, per model metre.
struct Steepest {
    double slope_p99 = 0.0, by_shift = 0.0, by_turn = 0.0;
    void add(const GainLevel& level, const Pose& pose) {
        const DensityBends bends = level.map->bends(level.points, pose);
        by_shift = std::max(by_shift, spectral_norm(bends.by_shift));
        by_turn = std::max(by_turn, spectral_norm(bends.by_turn));
    }
};

double p99(std::vector<double>& values) {
    if (values.empty()) return 0.0;
    std::sort(values.begin(), values.end());
    return values[(values.size() - 1) * 99 / 100];
}

void add_poses(const GainLevel& atoms, const std::vector<Pose>& poses, Steepest& steepest) {
    struct Felt {
        double density_sigma, slope;
        std::size_t pose;
    };
    std::vector<Felt> felt;
    for (std::size_t k = 0; k < poses.size(); ++k) {
        const DensitySums sums = atoms.map->sum(atoms.points, poses[k]);
        felt.push_back({sums.density_sigma, sums.gradient.norm(), k});
    }
    std::sort(felt.begin(), felt.end(),
              [](const Felt& a, const Felt& b) { return a.density_sigma > b.density_sigma; });
    felt.resize(felt.size() / 2);
    std::vector<double> slopes;
    for (const Felt& f : felt) {
        slopes.push_back(f.slope);
        steepest.add(atoms, poses[f.pose]);
    }
    steepest.slope_p99 = std::max(steepest.slope_p99, p99(slopes));
}

void add_fits(const GainBody& body, const std::vector<Pose>& starts, SeededRandom& random,
              Steepest& steepest) {
    const GainLevel& atoms = body.levels.back();
    const auto coarse = std::find_if(body.levels.begin(), body.levels.end() - 1, [](const GainLevel& level) {
        return level.points.size() >= kClimbVectors;
    });
    std::vector<double> slopes;
    for (const Pose& start : starts) {
        const Pose nearby = climbed(*coarse->map, coarse->points, start, kClimbSums);
        const Pose fit = climbed(*atoms.map, atoms.points, nearby, kClimbSumsAtoms);
        for (const GainLevel& level : body.levels) steepest.add(level, fit);
        for (std::uint32_t k = 0; k < kPosesPerFit; ++k) {
            const Pose pose = near(fit, kFitM, kFitRad, random);
            slopes.push_back(atoms.map->sum(atoms.points, pose).gradient.norm());
        }
    }
    steepest.slope_p99 = std::max(steepest.slope_p99, p99(slopes));
}

}  // namespace

DockingGain docking_gain(const LevelMaps& maps, std::span<const Structure> structures,
                         std::span<const Codebook> codebooks, double world_per_model,
                         const GainSettings& settings, const Progress& progress) {
    std::vector<GainBody> bodies;
    for (std::size_t i = 0; i < structures.size() && structures.size() == codebooks.size(); ++i) {
        const Structure& s = structures[i];
        GainBody body{{}, s.home()};
        for (std::size_t l = 0; l < codebooks[i].levels.size(); ++l)
            body.levels.push_back({&maps.maps[maps.map_of[i][l]], codebooks[i].levels[l].view()});
        body.levels.push_back({&maps.maps.front(), {s.x_m, s.y_m, s.z_m, s.mass_fraction}});
        bodies.push_back(std::move(body));
    }
    return docking_gain(bodies, world_per_model, settings, progress);
}

DockingGain docking_gain(std::span<const GainBody> bodies, double world_per_model,
                         const GainSettings& settings, const Progress& progress) {
    const std::string attempt = "choosing the gain of the docking force";
    if (bodies.empty() || !(world_per_model > 0.0)) {
        throw StartupError(attempt, "no structure with a codebook, or no scale, is given", "add a structure");
    }
    Steepest steepest;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        report(progress, static_cast<double>(i) / static_cast<double>(bodies.size()), "gain");
        SeededRandom random(settings.seed + i);
        const GainLevel& atoms = bodies[i].levels.back();
        std::vector<Pose> poses;
        for (std::uint32_t k = 0; k < std::max(settings.poses, 4U); ++k) {
            if (k % 2 == 0) {
                poses.push_back(near(bodies[i].home, kNearM, kNearRad, random));
            } else {
                const Vec3 dense_m = dense_point(*atoms.map, random);
                poses.push_back({dense_m, random.rotation()});
            }
        }
        add_poses(atoms, poses, steepest);
        std::vector<Pose> starts{bodies[i].home};
        for (std::size_t k = 1; k < settings.climbs && k < poses.size(); ++k) starts.push_back(poses[k]);
        add_fits(bodies[i], starts, random, steepest);
    }
    if (!(steepest.slope_p99 > 0.0) || !(steepest.by_shift > 0.0)) {
        throw StartupError(attempt, "no pose of the structures overlaps any density of the map",
                           "check that the map holds a molecule, and that its voxel size is right");
    }
    const double scale_2 = world_per_model * world_per_model;
    const double by_force = settings.force_n * world_per_model / steepest.slope_p99;
    const double by_stiffness = settings.stiffness_n_m * scale_2 / steepest.by_shift;
    DockingGain gain;
    gain.energy_j_per_sigma = std::min(by_force, by_stiffness);
    gain.force_n_p99 = gain.energy_j_per_sigma / world_per_model * steepest.slope_p99;
    gain.stiffness_n_m_max = gain.energy_j_per_sigma / scale_2 * steepest.by_shift;
    gain.torque_n_m_rad_max = gain.energy_j_per_sigma * steepest.by_turn;
    report(progress, 1.0, "gain");
    return gain;
}

}  // namespace tact
