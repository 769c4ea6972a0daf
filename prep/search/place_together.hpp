// Places several structures in one map without a start: each is searched in the map that the placed ones leave, and the
// surest is placed next.
//
// Surest    the one whose best place scores the most above its second best (places apart, search.hpp)
// Then      each is refined in the map that all others leave, kRounds times
// Thread    slow (seconds per search, one search per structure and turn)
// Errors    as search()
#pragma once

#include <vector>

#include "prep/search/search.hpp"

namespace tact {

struct PlacedTogether {
    std::vector<std::size_t> order;  // of placing, indices of the structures
    std::vector<SearchResult>
        found;  // by structure, when it was placed; the first hit as refined in the last round
    std::vector<double> ahead;  // of the second best place, when it was placed
};

PlacedTogether place_together(const DensityGrid& map, const std::vector<Structure>& structures,
                              const SearchSettings& settings, const Progress& progress = {});

}  // namespace tact
