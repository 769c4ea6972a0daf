// The windows of a run as rates.csv holds them and the figures show them, and the worst of each part of the run.
//
// Rows   one for each sample with a whole window behind it; none is left out, so the worst row is the worst window
// Parts  start: windows that begin before the run has settled; no_load: later ones; load: windows that end while the
//        external load runs, from its first sample on
#pragma once

#include <vector>

#include "tests/reproduce/rate_samples.hpp"

namespace tact::launch {

enum class RunPart : std::uint8_t { start, no_load, load };
inline constexpr const char* kRunPartNames[] = {"start", "no_load", "load"};

struct RateRow {
    RateSample sample;
    RateWindow100 window;  // that ends at the sample
    RunPart part = RunPart::start;
};
// fast_s: as windows().
[[nodiscard]] std::vector<RateRow> rate_rows(const std::vector<RateSample>& samples, double settle_s,
                                             double fast_s = 0.0);

// All zero where the part has no rows.
struct WorstWindow {
    double rate_hz = 0.0, t_s = 0.0;  // lowest rate, and where its window ends
    double quiet_rate_hz = 0.0;       // lowest of the windows without a disturbance; 0: all had one
    double recomputed_fraction_least = 0.0;
};
[[nodiscard]] WorstWindow worst_window(const std::vector<RateRow>& rows, RunPart part);

}  // namespace tact::launch
