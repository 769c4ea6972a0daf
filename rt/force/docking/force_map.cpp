#include "rt/force/docking/force_map.hpp"

#include <algorithm>
#include <array>

#include "ipc/scene/density/docking_gain.hpp"
#include "ipc/scene/density/laplacian_map.hpp"
#include "ipc/scene/density/subtracted_map.hpp"
#include "rt/force/docking/start_pose.hpp"

namespace tact {

namespace {

constexpr int kCalibrationPoses = 128;

// Draws eight points in the map; returns the densest with a random rotation.
Pose dense_pose(const DensityMap& map, SeededRandom& random) {
    Pose pose;
    double best = -1e300;
    Vec3 gradient;
    for (int draw = 0; draw < 8; ++draw) {
        Vec3 p;
        for (int a = 0; a < 3; ++a) {
            const double width = map.spacing_m()[a] * (map.size()[static_cast<std::size_t>(a)] - 1.0);
            p[a] = map.origin_m()[a] + width * random.uniform();
        }
        const double density = map.sample(p, gradient);
        if (density > best) best = density, pose.p_m = p;
    }
    pose.q = random.rotation();
    return pose;
}

// Errors: three quarters of the poses lie within 15 A and 30 degrees of home, one quarter in dense parts of the map
// with random rotations. Cost: median of nine timed sums at home.
std::vector<LevelMetrics> calibrated(const DensityMap& map, const std::vector<PointSet>& levels,
                                     const Pose& home, double newtons_per_gradient) {
    std::vector<LevelMetrics> metrics(levels.size());
    SeededRandom random(20261120);
    for (int k = 0; k < kCalibrationPoses; ++k) {
        const Pose pose = k % 4 == 0 ? dense_pose(map, random)
                                     : start_pose(home, 15e-10 * random.uniform(), 0.5236 * random.uniform(),
                                                  random.next());
        const Vec3 exact = map.sum(levels.back().view(), pose).gradient;
        for (std::size_t l = 0; l + 1 < levels.size(); ++l) {
            const Vec3 off = map.sum(levels[l].view(), pose).gradient - exact;
            metrics[l].error_n =
                std::max(metrics[l].error_n, kErrorMargin * newtons_per_gradient * off.norm());
        }
    }
    // A smaller level may have a smaller error by chance; the knob requires errors that do not rise with the level.
    for (std::size_t l = levels.size() - 1; l-- > 0;)
        metrics[l].error_n = std::max(metrics[l].error_n, metrics[l + 1].error_n);
    for (std::size_t l = 0; l < levels.size(); ++l) {
        std::array<Duration, 9> times{};
        for (Duration& time : times) {
            const Instant begin = Monotonic::now();
            static_cast<void>(map.sum(levels[l].view(), home));
            time = Monotonic::now() - begin;
        }
        std::nth_element(times.begin(), times.begin() + 4, times.end());
        metrics[l].cost = times[4];
    }
    return metrics;
}

DensityGrid without_others(const DockingParts& parts, const ModelBodies& bodies) {
    std::vector<PlacedStructure> placed;
    for (std::uint32_t i = 0; i < bodies.count && i < ModelBodies::kMax; ++i) {
        if (i == bodies.active || bodies.structure[i] >= parts.structures.size()) continue;
        placed.push_back({&parts.structures[bodies.structure[i]], bodies.T_model_body[i]});
    }
    if (placed.empty()) return parts.grid;
    return subtract_placed(parts.grid, parts.meta.map_background, placed, parts.meta.resolution_m).grid;
}

double contour_resolution_m(const DockingParts& parts) {
    return std::max(parts.meta.resolution_m, kContourResolutionM);
}

// With the unit u the energy is -k_E sum w L / u, where k_E is the scene's gain. docking_gain() gives k_L for L in
// units of its root mean square r, so u = r k_E / k_L.
double laplacian_unit(const DockingParts& parts, const DensityGrid& filtered) {
    const double rms = rms_of(filtered);
    std::vector<GainBody> bodies;
    for (std::size_t s = 0; s < parts.structures.size(); ++s) {
        std::size_t level = 0;
        while (level + 1 < parts.levels[s].size() && parts.levels[s][level].size() < kGainVectors) ++level;
        bodies.push_back({parts.levels[s][level].view(), parts.structures[s].home()});
    }
    const DockingGain gain = docking_gain(DensityMap(filtered, 0.0, rms), bodies, parts.meta.world_per_model);
    const double unit = rms * parts.meta.energy_j_per_sigma / gain.energy_j_per_sigma;
    return unit > 0.0 ? unit : rms;  // a scene without force
}

DensityMap force_map(const DockingParts& parts, std::uint32_t options, const ModelBodies& bodies) {
    const SceneMeta& meta = parts.meta;
    const bool subtracted = (options & kDockingSubtraction) != 0;
    if ((options & kDockingLaplacian) == 0) {
        return {subtracted ? without_others(parts, bodies) : parts.grid, meta.map_background, meta.map_sigma};
    }
    const auto filtered = [&](const DensityGrid& grid) {
        return laplacian_map(grid, meta.map_background, contour_resolution_m(parts));
    };
    const DensityGrid felt = filtered(subtracted ? without_others(parts, bodies) : parts.grid);
    // Half of the work of this function; independent of the body in the hand, so computed once.
    LaplacianUnit& unit = *parts.laplacian_unit;
    std::call_once(unit.once,
                   [&] { unit.value = laplacian_unit(parts, subtracted ? filtered(parts.grid) : felt); });
    return {felt, 0.0, unit.value};
}

}  // namespace

std::shared_ptr<const ForceMap> make_force_map(const DockingParts& parts, double newtons_per_gradient,
                                               std::uint32_t options, const ModelBodies& bodies) {
    auto felt = std::make_shared<ForceMap>(ForceMap{
        .map = force_map(parts, options, bodies),
        .options = options & kForceMapOptions,
        .active_id = bodies.active < bodies.count ? bodies.id[bodies.active] : 0,
        .others = bodies.others,
        .metrics = {},
    });
    for (std::size_t s = 0; s < parts.structures.size(); ++s)
        felt->metrics.push_back(
            calibrated(felt->map, parts.levels[s], parts.structures[s].home(), newtons_per_gradient));
    return felt;
}

}  // namespace tact
