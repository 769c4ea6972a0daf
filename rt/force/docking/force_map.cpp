#include "rt/force/docking/force_map.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "ipc/scene/density/climb.hpp"
#include "ipc/scene/density/docking_gain.hpp"
#include "ipc/scene/density/laplacian_map.hpp"
#include "ipc/scene/density/level_maps.hpp"
#include "ipc/scene/density/subtracted_map.hpp"
#include "rt/force/docking/docking_bodies.hpp"
#include "rt/force/docking/partial_sums.hpp"
#include "rt/force/docking/start_pose.hpp"

namespace tact {

namespace {

constexpr int kCalibrationPoses = 128;
constexpr int kPosesPerBend = 3;  // of these, one has its stiffness measured
constexpr double kNearHomeM = 15e-10, kNearHomeRad = 0.5236;
constexpr int kPosesAtMaximum = 8;
constexpr double kAtMaximumM = 3e-10, kAtMaximumRad = 0.1;
constexpr int kClimbs = 6, kClimbSums = 150, kClimbSumsAtoms = 60;
constexpr std::size_t kClimbVectors = 800;

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

// One structure and its levels in their maps.
struct Felt {
    const std::vector<DensityMap>& maps;
    const std::vector<PointSet>& levels;
    std::vector<LevelMetrics>& metrics;

    [[nodiscard]] const DensityMap& map_of(std::size_t level) const { return maps[metrics[level].map]; }
    void add_bends(const Pose& pose) {
        for (std::size_t l = 0; l < levels.size(); ++l) {
            const DensityBends bends = map_of(l).bends(levels[l].view(), pose);
            BendNorms& most = metrics[l].bends;
            most.by_shift = std::max(most.by_shift, kStiffnessMargin * spectral_norm(bends.by_shift));
            most.by_turn = std::max(most.by_turn, kStiffnessMargin * spectral_norm(bends.by_turn));
        }
    }
    // Where a start ends that follows its force: some hundreds of vectors first, then all atoms.
    [[nodiscard]] Pose fit(const Pose& start) const {
        std::size_t coarse = 0;
        while (coarse + 1 < levels.size() && levels[coarse].size() < kClimbVectors) ++coarse;
        const Pose nearby = climbed(map_of(coarse), levels[coarse].view(), start, kClimbSums);
        return climbed(maps.front(), levels.back().view(), nearby, kClimbSumsAtoms);
    }
};

// Errors: three quarters of the poses lie within 15 A and 30 degrees of home, one quarter in dense parts of the map
// with random rotations; then some around each maximum, where the slopes of fine maps are largest. Cost: median of nine timed
// sums at home.
void calibrate(Felt felt, const Pose& home, double newtons_per_gradient) {
    const std::vector<PointSet>& levels = felt.levels;
    std::vector<LevelMetrics>& metrics = felt.metrics;
    SeededRandom random(20261120);
    std::vector<Pose> starts{home};
    const auto near = [&](const Pose& pose, double offset_max_m, double turn_max_rad) {
        const std::uint64_t seed = random.next();
        const double turn_rad = turn_max_rad * random.uniform(), offset_m = offset_max_m * random.uniform();
        return start_pose(pose, offset_m, turn_rad, seed);
    };
    const auto add_errors = [&](const Pose& pose) {
        const Vec3 exact = felt.maps.front().sum(levels.back().view(), pose).gradient;
        for (std::size_t l = 0; l + 1 < levels.size(); ++l) {
            const Vec3 off = felt.map_of(l).sum(levels[l].view(), pose).gradient - exact;
            metrics[l].error_n =
                std::max(metrics[l].error_n, kErrorMargin * newtons_per_gradient * off.norm());
        }
    };
    for (int k = 0; k < kCalibrationPoses; ++k) {
        const Pose pose =
            k % 4 == 0 ? dense_pose(felt.maps.front(), random) : near(home, kNearHomeM, kNearHomeRad);
        if (starts.size() < kClimbs) starts.push_back(pose);
        add_errors(pose);
        if (k % kPosesPerBend == 0) felt.add_bends(pose);
    }
    for (const Pose& start : starts) {
        const Pose maximum = felt.fit(start);
        felt.add_bends(maximum);
        for (int k = 0; k < kPosesAtMaximum; ++k) add_errors(near(maximum, kAtMaximumM, kAtMaximumRad));
    }
    // A smaller level may have a smaller error by chance; the knob requires errors that do not rise with the level.
    for (std::size_t l = levels.size() - 1; l-- > 0;)
        metrics[l].error_n = std::max(metrics[l].error_n, metrics[l + 1].error_n);
    for (std::size_t l = 0; l < levels.size(); ++l) {
        const DensityMap& map = felt.map_of(l);
        PartialSums kept;
        std::array<Duration, 9> times{};
        for (Duration& time : times) {
            const Instant begin = Monotonic::now();
            static_cast<void>(sum_of_step(map, levels[l], home, 1.0, Deadline(), &kept));
            time = Monotonic::now() - begin;
        }
        std::nth_element(times.begin(), times.begin() + 4, times.end());
        metrics[l].cost = times[4];
    }
}

DensityGrid without_others(const DockingParts& parts, const ModelBodies& bodies) {
    std::vector<PlacedStructure> placed;
    for (std::uint32_t i = 0; i < bodies.count && i < ModelBodies::kMax; ++i) {
        if (i == bodies.active || bodies.structure[i] >= parts.structures.size()) continue;
        if (moves_along_with_active(bodies, i)) continue;
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
    const DensityMap map(filtered, 0.0, rms);
    std::vector<GainBody> bodies;
    for (std::size_t s = 0; s < parts.structures.size(); ++s)
        bodies.push_back({{{&map, parts.levels[s].back().view()}}, parts.structures[s].home()});
    GainSettings settings;
    settings.climbs = kClimbs;
    const DockingGain gain = docking_gain(bodies, parts.meta.world_per_model, settings);
    const double unit = rms * parts.meta.energy_j_per_sigma / gain.energy_j_per_sigma;
    return unit > 0.0 ? unit : rms;  // a scene without force
}

// The density of all atoms, as options and bodies demand, and what turns it into a map.
struct FeltGrid {
    DensityGrid grid;
    double background, sigma, resolution_m;
};

FeltGrid summed_grid(const DockingParts& parts, std::uint32_t options, const ModelBodies& bodies) {
    const SceneMeta& meta = parts.meta;
    const bool subtracted = (options & kDockingSubtraction) != 0;
    if ((options & kDockingLaplacian) == 0) {
        return {subtracted ? without_others(parts, bodies) : parts.grid, meta.map_background, meta.map_sigma,
                meta.resolution_m};
    }
    const auto filtered = [&](const DensityGrid& grid) {
        return laplacian_map(grid, meta.map_background, contour_resolution_m(parts));
    };
    const DensityGrid felt = filtered(subtracted ? without_others(parts, bodies) : parts.grid);
    // Half of the work of this function; independent of the body in the hand, so computed once.
    LaplacianUnit& unit = *parts.laplacian_unit;
    std::call_once(unit.once,
                   [&] { unit.value = laplacian_unit(parts, subtracted ? filtered(parts.grid) : felt); });
    return {felt, 0.0, unit.value, contour_resolution_m(parts)};
}

}  // namespace

std::shared_ptr<const ForceMap> make_force_map(const DockingParts& parts, double newtons_per_gradient,
                                               std::uint32_t options, const ModelBodies& bodies) {
    const FeltGrid felt = summed_grid(parts, options, bodies);
    std::vector<std::vector<double>> smoothing_m;
    for (const std::vector<PointSet>& levels : parts.levels) {
        smoothing_m.emplace_back();
        for (std::size_t l = 0; l + 1 < levels.size(); ++l)
            smoothing_m.back().push_back(
                level_smoothing_m(levels[l].view(), levels.back().view(), felt.resolution_m));
    }
    LevelMaps maps = make_level_maps(felt.grid, felt.background, felt.sigma, felt.resolution_m, smoothing_m);
    auto made = std::make_shared<ForceMap>(ForceMap{
        .maps = std::move(maps.maps),
        .options = options & kForceMapOptions,
        .active_id = bodies.active < bodies.count ? bodies.id[bodies.active] : 0,
        .others = bodies.others,
        .metrics = {},
    });
    for (std::size_t s = 0; s < parts.structures.size(); ++s) {
        std::vector<LevelMetrics> metrics(parts.levels[s].size());
        for (std::size_t l = 0; l + 1 < metrics.size(); ++l) metrics[l].map = maps.map_of[s][l];
        calibrate({made->maps, parts.levels[s], metrics}, parts.structures[s].home(), newtons_per_gradient);
        made->metrics.push_back(std::move(metrics));
    }
    return made;
}

}  // namespace tact
