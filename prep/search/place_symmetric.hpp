// Places equal copies of a structure in a map, related by a symmetry whose frame is not known.
//
// Several   symmetries may be given; the one whose copies explain the map best is taken
// Steps     1. the structure is searched in the whole map (search.hpp)
//           2. pairs of hits that an element of the symmetry relates give frames; of these, the ones that relate most hits
//           3. of those, the one whose copies together explain the map best (joint_fit.hpp)
//           4. the copies are refined in turns, and moved to the nearest symmetric place, while that explains the map better
// Thread    slow (seconds to minutes)
// Errors    as search(); StartupError if no pair of hits is related by one of the symmetries
#pragma once

#include "prep/search/search.hpp"
#include "prep/search/symmetry.hpp"

namespace tact {

struct PlacedSymmetric {
    SearchResult
        found;  // its hits are the copies, in the order of the elements; scores in what the others leave
    Symmetry symmetry;
    SymmetricPlace place;
    double correlation = 0.0;  // of all together (JointFit)
    double free_difference_m =
        0.0;  // root mean square displacement of the atoms from the copies refined without symmetry
};

PlacedSymmetric place_symmetric(const DensityGrid& map, const Structure& structure,
                                const std::vector<Symmetry>& symmetries, const SearchSettings& settings,
                                const Progress& progress = {});

}  // namespace tact
