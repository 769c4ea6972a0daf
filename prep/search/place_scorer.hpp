// The search's score of places of one structure in one map, between the voxels: with more voxels per resolution than in the search
// of positions, so that it depends less on where they are.
//
// Thread   immutable after construction
#pragma once

#include <algorithm>

#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/fit/refine.hpp"
#include "prep/search/search.hpp"
#include "prep/search/translation_search.hpp"

namespace tact {

// Scores of places by chance: what a score must exceed to mean something.
struct RandomScores {
    std::size_t places = 0;
    double mean = 0.0, deviation = 0.0, best = 0.0;
    [[nodiscard]] double z_of(double score) const { return (score - mean) / std::max(deviation, 1e-12); }
};

class PlaceScorer {
public:
    // search_m: resolution of the score, not finer than that of the map.
    PlaceScorer(const DensityGrid& map, const Structure& structure, const SearchSettings& settings,
                double search_m);

    // Moves it to the nearest optimum.
    [[nodiscard]] RefineResult from(const Pose& start, const RefineProgress& progress = {}) const;
    [[nodiscard]] double score(const Pose& place) const;
    // Of this many places with any orientation and the origin in the density, not refined. Repeats: the seed is fixed.
    [[nodiscard]] RandomScores random_scores(std::size_t places) const;

private:
    SearchMap map_;
    Structure beads_;
    DensityMap density_;
    CorrelationPoints points_;
};

}  // namespace tact
