// Fitting without a hand: how often search and refinement find the right place, from random starts.
//
// Pair     a map, its resolution, and structures whose files hold the right places. Default: the synthetic ring of six
// Search   each structure alone in the whole map, after a random rotation and shift of its file
// Refine   from 10 A and 20 degrees, and from 20 A and 40 degrees, in random directions; where a pair has several structures,
//          without and with the others placed and subtracted
// Hand     led by the docking force from 30 A and 60 degrees for 20 s, without and with the pull towards the places of one search
// Bend     each structure into the map of its bent self (fitting_bend.hpp); right: within 1.5 A of it, root mean square over atoms
// Together all structures of a pair at once
// Right    within 3 A of the place in the file (root mean square over atoms, after refinement there), or of equal score to 0.01:
//          symmetric maps have several right places
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tact::launch {

struct FittingExperiment {
    std::filesystem::path out;
    std::vector<std::string> pairs;  // "MAP,RESOLUTION_A,MODEL[,MODEL...]"
    int starts = 20;
    std::string only;  // search, refine, hand, bend or together; empty: all
    std::uint64_t seed = 1;
    bool quick = false;
};

int reproduce_fitting(const FittingExperiment& experiment);

}  // namespace tact::launch
