// Finds the places of a structure in a map: all positions by Fourier transforms over a set of rotations, then refinement of
// the best, and a ranked list.
//
// Steps    1. orientations spread evenly, so many that one is within a rotation that moves the atoms by kCoverShare of the
//             resolution, at most rotations_max: a larger structure is searched at a coarser resolution instead
//          2. for each, the score at every position (translation_search.hpp); its highest maxima are candidates
//          3. candidates that move the atoms by less than a part of the resolution are one; the best are refined, first at the
//             resolution of the search, then at that of the map (ipc/scene/fit/refine.hpp)
// Near     with `near`, only candidates within its limits, and the nearest optimum to the place itself, so the best hit is
//          never worse than it
// Score    correlation about the mean of the refined place, of the Laplacians of the densities: inside a large complex the
//          densities alone correlate well in many wrong places (prep/search/README.md). z: how many standard deviations it
//          is above the scores of unrefined places with the origin in the density, in all orientations of step 1
// Repeats  exactly, whatever the number of threads
// Thread   slow (seconds to minutes); starts threads of its own. Progress is reported from the calling thread
// Errors   StartupError; Cancelled when `progress` returns false
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "ipc/base/progress.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"
#include "ipc/scene/fit/refine.hpp"

namespace tact {

// Only places whose centre and orientation are near a given one.
struct SearchNear {
    Pose place;
    double within_m = 0.0, within_rad = 0.0;
};

struct SearchSettings {
    double resolution_m = 0.0;  // of the map, > 0
    double background = 0.0;
    bool laplacian = true;  // correlates the Laplacians of the densities
    std::size_t rotations_max = 4000;
    std::size_t hits_max = 20;
    unsigned threads = 0;  // 0: one per processor
    std::optional<SearchNear> near{};
};

struct SearchHit {
    Pose T_model_body;
    double score = 0.0, z = 0.0;
};

struct SearchResult {
    std::vector<SearchHit> hits;  // best first
    std::size_t rotations = 0, candidates = 0;
    double search_resolution_m = 0.0, cover_rad = 0.0;
    double random_mean = 0.0, random_deviation = 0.0;
    [[nodiscard]] double z_of(double score) const {
        return (score - random_mean) / std::max(random_deviation, 1e-12);
    }
};

SearchResult search(const DensityGrid& map, const Structure& structure, const SearchSettings& settings,
                    const Progress& progress = {});

// Moves the structure from one place to the nearest optimum of the search's score, at the resolution of the map.
RefineResult refine_place(const DensityGrid& map, const Structure& structure, const SearchSettings& settings,
                          const Pose& start, const RefineProgress& progress = {});

// The search's score of a place, at the resolution of the map.
double place_score(const DensityGrid& map, const Structure& structure, const SearchSettings& settings,
                   const Pose& place);

}  // namespace tact
