// The best of several codebooks of one structure, and the spread of their errors.
//
// Neural gas ends in a local optimum that depends on its random draws. Restarts show how good that optimum is: if all
// errors lie within a percent of each other, another seed would not be better.
//
// Choice   the codebook whose errors, each divided by the mean error of its level, have the smallest mean.
// Repeats  exactly, for the same atoms and seed: the number of restarts depends on the atoms alone.
// Time     larger structures get fewer restarts; the restarts run in parallel on the available cores.
#pragma once

#include <cstdint>
#include <vector>

#include "prep/codebook/neural_gas.hpp"

namespace tact {

struct LevelQuality {
    double rms_error_m = 0.0;                             // of the chosen codebook
    double rms_error_mean_m = 0.0, rms_error_sd_m = 0.0;  // over all restarts; sd is 0 for a single one
};

struct BestCodebook {
    Codebook codebook;
    std::uint32_t restarts = 0;
    std::vector<LevelQuality> quality;  // one per level
};

// 4 up to 50 000 atoms, 2 up to 200 000, else 1.
[[nodiscard]] std::uint32_t codebook_restarts(std::size_t atoms);

BestCodebook best_codebook(const Structure& structure, const CodebookSettings& settings = {},
                           const Progress& progress = {});

}  // namespace tact
