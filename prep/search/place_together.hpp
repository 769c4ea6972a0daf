// Places several structures in one map without a start.
//
// Steps     1. each structure is searched in the whole map (search.hpp)
//           2. of their hits, the combination that together explains the map best (joint_fit.hpp)
//           3. each is refined in the map that all others leave, in turns
//           4. each is searched again in what the others leave, and moves where that explains the map better; then 3.
// Found     by structure, the hits of its last search, with the chosen place first
// Thread    slow (seconds per search; three searches per structure)
// Errors    as search()
#pragma once

#include <vector>

#include "prep/search/search.hpp"

namespace tact {

struct PlacedTogether {
    std::vector<SearchResult> found;  // by structure
    double correlation = 0.0;         // of all together (JointFit)
};

PlacedTogether place_together(const DensityGrid& map, const std::vector<Structure>& structures,
                              const SearchSettings& settings, const Progress& progress = {});

}  // namespace tact
