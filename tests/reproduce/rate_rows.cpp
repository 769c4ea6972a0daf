#include "tests/reproduce/rate_rows.hpp"

#include <algorithm>
#include <limits>

namespace tact::launch {

std::vector<RateRow> rate_rows(const std::vector<RateSample>& samples, double settle_s, double fast_s) {
    constexpr double kAll = std::numeric_limits<double>::infinity();
    std::vector<RateRow> rows;
    auto sample = samples.begin();
    for (const RateWindow100& w : windows(samples, -kAll, kAll, kWindow_s, fast_s)) {
        while (sample->t_s < w.t_s) ++sample;
        const bool starts = w.t_s - kWindow_s < settle_s - 1e-9;
        rows.push_back({*sample, w,
                        sample->load ? RunPart::load
                        : starts     ? RunPart::start
                                     : RunPart::no_load});
        ++sample;
    }
    return rows;
}

WorstWindow worst_window(const std::vector<RateRow>& rows, RunPart part) {
    WorstWindow worst;
    bool any = false, quiet = false;
    for (const RateRow& r : rows) {
        if (r.part != part) continue;
        const RateWindow100& w = r.window;
        if (!any || w.rate_hz < worst.rate_hz) {
            worst.rate_hz = w.rate_hz;
            worst.t_s = w.t_s;
        }
        worst.recomputed_fraction_least =
            any ? std::min(worst.recomputed_fraction_least, w.recomputed_fraction) : w.recomputed_fraction;
        any = true;
        if (w.disturbed) continue;
        worst.quiet_rate_hz = quiet ? std::min(worst.quiet_rate_hz, w.rate_hz) : w.rate_hz;
        quiet = true;
    }
    return worst;
}

}  // namespace tact::launch
