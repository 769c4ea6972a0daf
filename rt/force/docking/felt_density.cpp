#include "rt/force/docking/felt_density.hpp"

#include <algorithm>
#include <array>

#include "rt/force/docking/start_pose.hpp"

namespace tact {

namespace {

constexpr int kCalibrationPoses = 128;
constexpr double kErrorMargin = 1.25;

// Of eight places drawn in the map the densest, turned at random.
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

// Three quarters of the poses within 15 A and 30 degrees of home, one quarter anywhere in dense parts of the
// map, turned at random. The cost is the median of nine timed sums at home.
std::vector<LevelFigures> calibrated(const DensityMap& map, const std::vector<PointSet>& levels,
                                     const Pose& home, double newtons_per_gradient) {
    std::vector<LevelFigures> figures(levels.size());
    SeededRandom random(20261120);
    for (int k = 0; k < kCalibrationPoses; ++k) {
        const Pose pose = k % 4 == 0 ? dense_pose(map, random)
                                     : start_pose(home, 15e-10 * random.uniform(), 0.5236 * random.uniform(),
                                                  random.next());
        const Vec3 exact = map.sum(levels.back().view(), pose).gradient;
        for (std::size_t l = 0; l + 1 < levels.size(); ++l) {
            const Vec3 off = map.sum(levels[l].view(), pose).gradient - exact;
            figures[l].error_n =
                std::max(figures[l].error_n, kErrorMargin * newtons_per_gradient * off.norm());
        }
    }
    // Fewer vectors may do better by luck; the knob promises that errors do not rise with it.
    for (std::size_t l = levels.size() - 1; l-- > 0;)
        figures[l].error_n = std::max(figures[l].error_n, figures[l + 1].error_n);
    for (std::size_t l = 0; l < levels.size(); ++l) {
        std::array<Duration, 9> times{};
        for (Duration& time : times) {
            const Instant begin = Monotonic::now();
            static_cast<void>(map.sum(levels[l].view(), home));
            time = Monotonic::now() - begin;
        }
        std::nth_element(times.begin(), times.begin() + 4, times.end());
        figures[l].cost = times[4];
    }
    return figures;
}

}  // namespace

std::shared_ptr<const FeltDensity> make_felt_density(const DockingParts& parts, double newtons_per_gradient,
                                                     std::uint32_t options, const ModelBodies& bodies) {
    auto felt = std::make_shared<FeltDensity>(FeltDensity{
        .map = DensityMap(parts.grid, parts.meta.map_background, parts.meta.map_sigma),
        .options = options & kFeltOptions,
        .active_id = bodies.active < bodies.count ? bodies.id[bodies.active] : 0,
        .others = bodies.others,
        .figures = {},
    });
    for (std::size_t s = 0; s < parts.structures.size(); ++s)
        felt->figures.push_back(
            calibrated(felt->map, parts.levels[s], parts.structures[s].home(), newtons_per_gradient));
    return felt;
}

}  // namespace tact
