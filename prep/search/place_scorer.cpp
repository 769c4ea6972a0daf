#include "prep/search/place_scorer.hpp"

#include <cmath>

#include "ipc/base/random.hpp"

namespace tact {
namespace {

constexpr double kFineVoxelsPerResolution = 5.0;
constexpr std::uint64_t kRandomSeed = 20261127;

}  // namespace

PlaceScorer::PlaceScorer(const DensityGrid& map, const Structure& structure, const SearchSettings& settings,
                         double search_m)
    : map_(search_map(map, settings.background, settings.resolution_m, search_m, settings.laplacian,
                      kFineVoxelsPerResolution)),
      beads_(coarse_structure(structure, map_.resolution_m / kBeadsPerResolution)),
      density_(map_.grid, 0.0, 1.0),
      points_(search_points(beads_, map_)) {}

RefineResult PlaceScorer::from(const Pose& start, const RefineProgress& progress) const {
    RefineSettings by;
    by.goal = RefineGoal::correlation_mean;
    by.points = &points_;
    by.step_m_max = 0.2 * map_.resolution_m;
    by.iterations_max = 100;
    return refine(density_, beads_, start, by, progress);
}

double PlaceScorer::score(const Pose& place) const {
    return from(place, [](std::uint32_t, double) { return false; }).score_start;
}

RandomScores PlaceScorer::random_scores(std::size_t places) const {
    RandomScores out;
    if (map_.inside.empty()) return out;
    SeededRandom random(kRandomSeed);
    double sum = 0.0, sum_2 = 0.0;
    for (; out.places < places; ++out.places) {
        const auto last = static_cast<double>(map_.inside.size());
        const auto& voxel =
            map_.inside[std::min(static_cast<std::size_t>(random.uniform() * last), map_.inside.size() - 1)];
        const Vec3 at_m =
            map_.grid.origin_m + map_.grid.spacing_m.cwiseProduct(Vec3(voxel[0], voxel[1], voxel[2]));
        const double s = score({at_m, random.rotation()});
        sum += s;
        sum_2 += s * s;
        out.best = out.places == 0 ? s : std::max(out.best, s);
    }
    const double n = std::max(static_cast<double>(out.places), 1.0);
    out.mean = sum / n;
    out.deviation = std::sqrt(std::max(sum_2 / n - out.mean * out.mean, 0.0));
    return out;
}

}  // namespace tact
