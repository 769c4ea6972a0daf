// The windows of a run, as in rates.csv and in the figures, and the worst window of each part of the run.
//
// Rows   one for each sample that ends a complete window; no window is omitted, so the worst row is the worst window
// Parts  start: windows that begin before the run has settled; no_load: later windows; load: windows that end while the
//        external load runs, beginning with the first sample under load
#pragma once

#include <vector>

#include "tests/reproduce/rate_samples.hpp"

namespace tact::launch {

enum class RunPart : std::uint8_t { start, no_load, load };
inline constexpr const char* kRunPartNames[] = {"start", "no_load", "load"};

struct RateRow {
    RateSample sample;
    RateWindow100 window;  // ends at the sample
    RunPart part = RunPart::start;
};
// fast_s: as in windows().
[[nodiscard]] std::vector<RateRow> rate_rows(const std::vector<RateSample>& samples, double settle_s,
                                             double fast_s = 0.0);

// All zero if the part has no rows.
struct WorstWindow {
    double rate_hz = 0.0, t_s = 0.0;  // lowest rate, and end of its window
    double quiet_rate_hz = 0.0;       // lowest rate of the undisturbed windows; 0: all were disturbed
    double recomputed_fraction_least = 0.0;
};
[[nodiscard]] WorstWindow worst_window(const std::vector<RateRow>& rows, RunPart part);

}  // namespace tact::launch
