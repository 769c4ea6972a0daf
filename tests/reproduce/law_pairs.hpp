// Two laws under the same load, compared in pairs of runs one right after the other: a machine whose speed changes from minute to
// minute disturbs both runs of a pair alike.
//
// Order   the laws take turns to run first
// Error   standard error of the mean of the pairs' differences; with it a difference is judged, not with the spread of the runs
// Thread  any
#pragma once

#include <utility>
#include <vector>

#include "tests/reproduce/shared_core.hpp"
#include "tests/reproduce/summary.hpp"

namespace tact::launch {

struct LawPair {
    Run own, published;  // laws under comparison
};

struct PairedMean {
    double first = 0.0, second = 0.0;                 // means
    double difference = 0.0, difference_error = 0.0;  // first minus second; error 0 with fewer than two pairs
};
[[nodiscard]] PairedMean paired_mean(const std::vector<std::pair<double, double>>& pairs);

// One row per column: mean rate, worst windows, vertices and their deviation, changes of the level, recomputed part. Empty with fewer
// than two pairs.
[[nodiscard]] std::vector<SummaryRow> summary_of(const std::vector<LawPair>& pairs);

}  // namespace tact::launch
