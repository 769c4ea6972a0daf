// The best of several codebooks of one structure, and how much they differ.
//
// Neural gas ends in a local optimum that depends on its draws. Restarts show how good that optimum is: where
// the errors of all of them lie within a percent of each other, another seed would not be better.
//
// Choice   the one whose errors, each divided by the mean error of its level, have the smallest mean.
// Repeats  exactly, for the same atoms and seed: the number of restarts depends on the atoms alone.
// Time     bounded by fewer restarts for larger structures; all run beside each other on the cores there are.
#pragma once

#include <cstdint>
#include <vector>

#include "prep/codebook/neural_gas.hpp"

namespace tact {

struct LevelQuality {
    double rms_error_m = 0.0;                             // of the one chosen
    double rms_error_mean_m = 0.0, rms_error_sd_m = 0.0;  // over restarts; sd 0 of a single one
};

struct BestCodebook {
    Codebook codebook;
    std::uint32_t restarts = 0;
    std::vector<LevelQuality> quality;  // of each level
};

// 4 up to 50 000 atoms, 2 up to 200 000, else 1.
[[nodiscard]] std::uint32_t codebook_restarts(std::size_t atoms);

BestCodebook best_codebook(const Structure& structure, const CodebookSettings& settings = {},
                           const Progress& progress = {});

}  // namespace tact
