#include "prep/search/place_together.hpp"

#include <algorithm>

#include "ipc/scene/density/subtracted_map.hpp"

namespace tact {
namespace {

constexpr int kRounds = 3;

DensityGrid rest_of(const DensityGrid& map, const std::vector<PlacedStructure>& placed,
                    const SearchSettings& settings) {
    return placed.empty() ? map
                          : subtract_placed(map, settings.background, placed, settings.resolution_m).grid;
}

}  // namespace

PlacedTogether place_together(const DensityGrid& map, const std::vector<Structure>& structures,
                              const SearchSettings& settings, const Progress& progress) {
    const std::size_t n = structures.size();
    const double searches = 0.5 * static_cast<double>(n) * static_cast<double>(n + 1);
    PlacedTogether result;
    result.found.resize(n);
    result.ahead.resize(n);
    std::vector<PlacedStructure> placed;
    double done = 0.0;
    for (std::size_t turn = 0; turn < n; ++turn) {
        const DensityGrid rest = rest_of(map, placed, settings);
        std::size_t next = n;
        for (std::size_t i = 0; i < n; ++i) {
            if (std::find(result.order.begin(), result.order.end(), i) != result.order.end()) continue;
            SearchResult found =
                search(rest, structures[i], settings,
                       part(progress, 0.95 * done / searches, 0.95 * (done + 1.0) / searches));
            done += 1.0;
            if (found.hits.empty()) continue;
            const double ahead = found.hits[0].score - (found.hits.size() > 1 ? found.hits[1].score : 0.0);
            if (next != n && ahead <= result.ahead[next]) continue;
            next = i;
            result.ahead[i] = ahead;
            result.found[i] = std::move(found);
        }
        if (next == n) break;
        result.order.push_back(next);
        placed.push_back({&structures[next], result.found[next].hits[0].T_model_body});
    }
    for (int round = 0; round < kRounds; ++round) {
        for (std::size_t k = 0; k < placed.size(); ++k) {
            report(progress, 0.95 + 0.05 * round / kRounds, "refining together");
            std::vector<PlacedStructure> others = placed;
            others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
            SearchHit& hit = result.found[result.order[k]].hits[0];
            const RefineResult r = refine_place(rest_of(map, others, settings), *placed[k].structure,
                                                settings, hit.T_model_body);
            hit.T_model_body = placed[k].T_model_body = r.T_model_body;
            hit.score = r.score;
        }
    }
    return result;
}

}  // namespace tact
