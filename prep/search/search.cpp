#include "prep/search/search.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <memory>
#include <thread>

#include "ipc/base/error.hpp"
#include "ipc/scene/fit/refine.hpp"
#include "prep/search/place_scorer.hpp"
#include "prep/search/rotation_set.hpp"
#include "prep/search/translation_search.hpp"

namespace tact {
namespace {

constexpr double kCoverShare = 0.5;
constexpr std::size_t kRotationsLeast = 500, kPeaksPerRotation = 6;
constexpr std::size_t kCoarseMost = 600, kFineMost = 100;
constexpr double kCoarseApart = 0.4, kFineApart = 0.15;  // resolutions

// Mean square distances of the atoms between two poses.
class Spread {
public:
    explicit Spread(const Structure& s) {
        double total = 0.0;
        for (std::size_t i = 0; i < s.size(); ++i) {
            const Vec3 at(static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]),
                          static_cast<double>(s.z_m[i]));
            moments_ += static_cast<double>(s.mass_fraction[i]) * at * at.transpose();
            total += static_cast<double>(s.mass_fraction[i]);
        }
        moments_ /= std::max(total, 1e-30);
    }
    [[nodiscard]] double gyration_m() const { return std::sqrt(moments_.trace()); }
    [[nodiscard]] double between_m(const Pose& a, const Pose& b) const {
        const Eigen::Matrix3d turn = (b.q.conjugate() * a.q).toRotationMatrix();
        const double turned = 2.0 * (moments_.trace() - (turn * moments_).trace());
        return std::sqrt((a.p_m - b.p_m).squaredNorm() + std::max(turned, 0.0));
    }

private:
    Eigen::Matrix3d moments_ = Eigen::Matrix3d::Zero();
};

// work(i, thread) for all i below count, on several threads; progress on this one.
template <class Work>
void for_all(std::size_t count, unsigned threads, const Progress& progress, const char* what,
             const Work& work) {
    std::atomic<std::size_t> next{0}, done{0};
    std::atomic<bool> stop{false};
    std::exception_ptr failed;
    std::atomic_flag taken = ATOMIC_FLAG_INIT;
    {
        std::vector<std::jthread> workers;
        for (unsigned t = 0; t < threads; ++t) {
            workers.emplace_back([&, t] {
                try {
                    for (std::size_t i = next++; i < count && !stop; i = next++) {
                        work(i, t);
                        ++done;
                    }
                } catch (...) {
                    stop = true;
                    if (!taken.test_and_set()) failed = std::current_exception();
                }
            });
        }
        try {
            while (done < count && !stop) {
                report(progress, static_cast<double>(done) / static_cast<double>(count), what);
                std::this_thread::sleep_for(std::chrono::milliseconds(20));
            }
        } catch (...) {
            stop = true;
            throw;
        }
    }
    if (failed) std::rethrow_exception(failed);
}

// The best of the sorted candidates, each apart from all better ones.
std::vector<SearchHit> thinned(std::vector<SearchHit> from, const Spread& spread, double apart_m,
                               std::size_t most) {
    std::stable_sort(from.begin(), from.end(),
                     [](const SearchHit& a, const SearchHit& b) { return a.score > b.score; });
    std::vector<SearchHit> kept;
    for (const SearchHit& hit : from) {
        if (kept.size() == most) break;
        if (std::all_of(kept.begin(), kept.end(), [&](const SearchHit& k) {
                return spread.between_m(k.T_model_body, hit.T_model_body) > apart_m;
            }))
            kept.push_back(hit);
    }
    return kept;
}

struct Sums {
    double n = 0.0, sum = 0.0, sum_2 = 0.0;
};

void refine_all(std::vector<SearchHit>& hits, const PlaceScorer& refinement, unsigned threads,
                const Progress& progress) {
    for_all(hits.size(), threads, progress, "refining", [&](std::size_t i, unsigned) {
        const RefineResult r = refinement.from(hits[i].T_model_body);
        hits[i].T_model_body = r.T_model_body;
        hits[i].score = r.score;
    });
}

}  // namespace

SearchResult search(const DensityGrid& map, const Structure& structure, const SearchSettings& settings,
                    const Progress& progress) {
    const std::string attempt = "searching for the place of " + structure.name;
    if (!(settings.resolution_m > 0.0) || !std::isfinite(settings.resolution_m))
        throw StartupError(attempt, "the resolution of the map is unknown", "set it with --resolution-a");
    if (structure.size() == 0) throw StartupError(attempt, "it has no atoms", "choose another structure");
    const unsigned threads =
        settings.threads > 0 ? settings.threads : std::max(1U, std::thread::hardware_concurrency());
    const Spread spread(structure);
    const double gyration_m = std::max(spread.gyration_m(), 0.1 * settings.resolution_m);

    SearchResult result;
    result.rotations = std::clamp(rotations_for_cover(kCoverShare * settings.resolution_m / gyration_m),
                                  kRotationsLeast, std::max(settings.rotations_max, kRotationsLeast));
    result.cover_rad = cover_of_rotations_rad(result.rotations);
    result.search_resolution_m = std::max(settings.resolution_m, result.cover_rad * gyration_m / kCoverShare);

    report(progress, 0.0, "preparing the map");
    const SearchMap coarse = search_map(map, settings.background, settings.resolution_m,
                                        result.search_resolution_m, settings.laplacian);
    const Structure beads = coarse_structure(structure, coarse.resolution_m / kBeadsPerResolution);
    const MapWaves waves(coarse, beads);
    std::vector<Quat> turns = rotation_set(result.rotations);
    if (settings.near) {
        // Half a cover more: the orientations that stand for the limit are beyond it.
        const double within_rad = settings.near->within_rad + 0.5 * result.cover_rad;
        std::erase_if(turns,
                      [&](const Quat& q) { return q.angularDistance(settings.near->place.q) > within_rad; });
    }
    std::vector<std::vector<SearchPeak>> peaks(turns.size());
    std::vector<Sums> random(turns.size());
    std::vector<std::unique_ptr<RotationScore>> scores(threads);
    for (auto& s : scores) s = std::make_unique<RotationScore>(waves);
    for_all(
        turns.size(), threads, part(progress, 0.0, 0.7), "searching", [&](std::size_t i, unsigned thread) {
            RotationScore& score = *scores[thread];
            if (!score.at(turns[i])) return;
            peaks[i] = settings.near
                           ? score.peaks(kPeaksPerRotation, settings.near->place.p_m, settings.near->within_m)
                           : score.peaks(kPeaksPerRotation);
            for (const auto& node : coarse.inside) {
                const auto s = static_cast<double>(score.score(node[0], node[1], node[2]));
                random[i].n += 1.0;
                random[i].sum += s;
                random[i].sum_2 += s * s;
            }
        });
    Sums all;
    std::vector<SearchHit> found;
    for (std::size_t i = 0; i < turns.size(); ++i) {
        all.n += random[i].n, all.sum += random[i].sum, all.sum_2 += random[i].sum_2;
        for (const SearchPeak& p : peaks[i]) found.push_back({{p.at_m, turns[i]}, p.score, 0.0});
    }
    result.candidates = found.size();
    result.random_mean = all.sum / std::max(all.n, 1.0);
    result.random_deviation =
        std::sqrt(std::max(all.sum_2 / std::max(all.n, 1.0) - result.random_mean * result.random_mean, 0.0));
    found = thinned(std::move(found), spread, kCoarseApart * coarse.resolution_m, kCoarseMost);

    const auto refined = [&](const PlaceScorer& refinement, double resolution_m, const Progress& part_of) {
        refine_all(found, refinement, threads, part_of);
        found = thinned(std::move(found), spread, kFineApart * resolution_m, kFineMost);
    };
    if (result.search_resolution_m > 1.05 * settings.resolution_m)
        refined(PlaceScorer(map, structure, settings, result.search_resolution_m), result.search_resolution_m,
                part(progress, 0.7, 0.85));
    const PlaceScorer fine(map, structure, settings, settings.resolution_m);
    if (settings.near) {
        // Uphill at the resolution of the map, so that nothing worse than the given place comes first.
        const RefineResult r = fine.from(settings.near->place);
        found.push_back({r.T_model_body, r.score, 0.0});
    }
    refined(fine, settings.resolution_m, part(progress, 0.85, 1.0));
    result.hits.assign(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(
                                                          std::min(found.size(), settings.hits_max)));
    for (SearchHit& hit : result.hits) hit.z = result.z_of(hit.score);
    return result;
}

RefineResult refine_place(const DensityGrid& map, const Structure& structure, const SearchSettings& settings,
                          const Pose& start, const RefineProgress& progress) {
    return PlaceScorer(map, structure, settings, settings.resolution_m).from(start, progress);
}

double place_score(const DensityGrid& map, const Structure& structure, const SearchSettings& settings,
                   const Pose& place) {
    return PlaceScorer(map, structure, settings, settings.resolution_m).score(place);
}

}  // namespace tact
