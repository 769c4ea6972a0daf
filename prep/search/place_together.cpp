#include "prep/search/place_together.hpp"

#include <algorithm>
#include <numeric>

#include "ipc/base/error.hpp"
#include "ipc/scene/density/subtracted_map.hpp"
#include "prep/search/joint_fit.hpp"
#include "prep/search/refine_in_turns.hpp"

namespace tact {
namespace {

constexpr std::size_t kChoices = 80;
constexpr int kRefinements = 10, kSearchesAgain = 2;

class Together {
public:
    Together(const DensityGrid& map, const std::vector<Structure>& structures, const SearchSettings& settings)
        : map_(map),
          structures_(structures),
          settings_(settings),
          joint_(search_map(map, settings.background, settings.resolution_m, settings.resolution_m,
                            settings.laplacian)) {
        wanted_hits_ = settings.hits_max;
        settings_.hits_max = std::max(settings.hits_max, kChoices);
        result_.found.resize(structures.size());
        for (const Structure& s : structures) placed_.push_back({&s, s.home()});
    }

    PlacedTogether place(const Progress& progress) {
        const double searches = static_cast<double>(structures_.size()) * (1.0 + kSearchesAgain);
        double done = 0.0;
        const auto next = [&] {
            const Progress one = part(progress, done / searches, (done + 1.0) / searches);
            done += 1.0;
            return one;
        };
        for (std::size_t i = 0; i < structures_.size(); ++i) {
            result_.found[i] = search(map_, structures_[i], settings_, next());
            if (result_.found[i].hits.empty())
                throw StartupError("placing " + structures_[i].name, "no place in the map resembles it",
                                   "check map, resolution and structure, or leave it out");
        }
        choose();
        refine_all();
        for (int again = 0; again < kSearchesAgain; ++again) {
            for (std::size_t i = 0; i < structures_.size(); ++i) search_again(i, next());
            refine_all();
        }
        result_.correlation = joint_.correlation(fields());
        for (SearchResult& r : result_.found) r.hits.resize(std::min(r.hits.size(), wanted_hits_));
        return std::move(result_);
    }

private:
    // Large structures first: they decide where the small ones have room.
    void choose() {
        std::vector<std::size_t> order(structures_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return structures_[a].mass_u > structures_[b].mass_u;
        });
        std::vector<std::vector<PlacedField>> choices;
        for (const std::size_t i : order) {
            choices.emplace_back();
            for (const SearchHit& hit : result_.found[i].hits)
                choices.back().push_back(joint_.field(structures_[i], hit.T_model_body));
        }
        const std::vector<std::size_t> chosen = joint_.best(choices);
        for (std::size_t k = 0; k < order.size(); ++k) {
            auto& hits = result_.found[order[k]].hits;
            std::rotate(hits.begin(), hits.begin() + static_cast<std::ptrdiff_t>(chosen[k]),
                        hits.begin() + static_cast<std::ptrdiff_t>(chosen[k]) + 1);
            placed_[order[k]].T_model_body = hits.front().T_model_body;
        }
    }
    [[nodiscard]] DensityGrid rest_of(std::size_t i) const {
        std::vector<PlacedStructure> others = placed_;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
        return others.empty()
                   ? map_
                   : subtract_placed(map_, settings_.background, others, settings_.resolution_m).grid;
    }
    void refine_all() {
        refine_in_turns(map_, settings_.background, settings_.resolution_m, placed_, kRefinements);
        for (std::size_t i = 0; i < structures_.size(); ++i) {
            SearchResult& found = result_.found[i];
            SearchHit& hit = found.hits.front();
            hit.T_model_body = placed_[i].T_model_body;
            hit.score = place_score(rest_of(i), structures_[i], settings_, hit.T_model_body);
            hit.z = found.z_of(hit.score);
        }
    }
    [[nodiscard]] std::vector<PlacedField> fields() const {
        std::vector<PlacedField> list;
        for (const PlacedStructure& p : placed_) list.push_back(joint_.field(*p.structure, p.T_model_body));
        return list;
    }
    void search_again(std::size_t i, const Progress& progress) {
        SearchResult found = search(rest_of(i), structures_[i], settings_, progress);
        if (found.hits.empty()) return;
        std::vector<PlacedField> all = fields();
        std::size_t best = found.hits.size();
        double most = joint_.correlation(all);
        for (std::size_t k = 0; k < found.hits.size(); ++k) {
            all[i] = joint_.field(structures_[i], found.hits[k].T_model_body);
            const double c = joint_.correlation(all);
            if (c > most) most = c, best = k;
        }
        // The present place stays first where no hit is better.
        if (best == found.hits.size()) {
            found.hits.insert(found.hits.begin(), result_.found[i].hits.front());
        } else {
            std::rotate(found.hits.begin(), found.hits.begin() + static_cast<std::ptrdiff_t>(best),
                        found.hits.begin() + static_cast<std::ptrdiff_t>(best) + 1);
        }
        placed_[i].T_model_body = found.hits.front().T_model_body;
        result_.found[i] = std::move(found);
    }

    const DensityGrid& map_;
    const std::vector<Structure>& structures_;
    SearchSettings settings_;
    JointFit joint_;
    std::vector<PlacedStructure> placed_;
    PlacedTogether result_;
    std::size_t wanted_hits_ = 0;
};

}  // namespace

PlacedTogether place_together(const DensityGrid& map, const std::vector<Structure>& structures,
                              const SearchSettings& settings, const Progress& progress) {
    return Together(map, structures, settings).place(progress);
}

}  // namespace tact
