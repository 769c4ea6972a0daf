#include "tests/reproduce/rate_samples.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tact::launch {
namespace {

std::vector<RateSample> within(const std::vector<RateSample>& samples, double from_s, double to_s) {
    std::vector<RateSample> in;
    std::copy_if(samples.begin(), samples.end(), std::back_inserter(in),
                 [&](const RateSample& s) { return s.t_s >= from_s && s.t_s <= to_s; });
    return in;
}

double seconds_of(const RateSample& a, const RateSample& b) { return b.t_s - a.t_s; }

double rate_of(const RateSample& a, const RateSample& b) {
    const double s = seconds_of(a, b);
    return s > 0.0 ? static_cast<double>(b.cycle - a.cycle) / s : 0.0;
}

double foreign_of(const RateSample& a, const RateSample& b) {
    const double s = b.t_s - a.t_s;
    if (s <= 0.0) return 0.0;
    double used = 0.0;
    for (std::size_t i = 0; i < kParties; ++i) used += std::max(b.used_s[i] - a.used_s[i], 0.0);
    return std::clamp(1.0 - used / s, 0.0, 1.0);
}

// Increments from an instant in [a, b] to c.
struct Between {
    double cycles, controller_s, given_up, foreign_share;
};
Between between(const RateSample& a, const RateSample& b, double from_s, const RateSample& c) {
    const double f = (from_s - a.t_s) / std::max(b.t_s - a.t_s, 1e-12);
    const auto since = [f](double at_a, double at_b, double at_c) { return at_c - std::lerp(at_a, at_b, f); };
    Between r{since(static_cast<double>(a.cycle), static_cast<double>(b.cycle), static_cast<double>(c.cycle)),
              since(a.used_s[0], b.used_s[0], c.used_s[0]), since(a.given_up, b.given_up, c.given_up), 0.0};
    double used = 0.0;
    for (std::size_t i = 0; i < kParties; ++i)
        used += std::max(since(a.used_s[i], b.used_s[i], c.used_s[i]), 0.0);
    const double wall_s = since(a.t_s, b.t_s, c.t_s);
    r.foreign_share = wall_s > 0.0 ? std::clamp(1.0 - used / wall_s, 0.0, 1.0) : 0.0;
    return r;
}

}  // namespace

std::vector<RateWindow100> windows(const std::vector<RateSample>& samples, double from_s, double to_s,
                                   double window_s, double fast_s) {
    const std::vector<RateSample> in = within(samples, from_s, to_s);
    std::vector<RateWindow100> all;
    for (std::size_t a = 0, b = 0; b < in.size(); ++b) {
        const double window_from_s = in[b].t_s - window_s;
        while (a + 1 < b && in[a + 1].t_s <= window_from_s + 1e-9) ++a;
        if (b == 0 || in[a].t_s > window_from_s + 1e-9) continue;
        const Between w = between(in[a], in[a + 1], window_from_s, in[b]);
        RateWindow100 window{
            .t_s = in[b].t_s, .rate_hz = w.cycles / window_s, .foreign_share = w.foreign_share};
        if (w.cycles > 0.0) {
            window.recomputed_fraction = std::clamp(1.0 - w.given_up / w.cycles, 0.0, 1.0);
            window.update_s =
                w.controller_s / (w.cycles * (kFixedPart + (1.0 - kFixedPart) * window.recomputed_fraction));
        }
        all.push_back(window);
    }
    if (fast_s <= 0.0) fast_s = fast_update_s(all);
    for (RateWindow100& w : all)
        w.disturbed = w.foreign_share > kForeignShareMax || w.update_s > kSlowerMax * fast_s;
    return all;
}

double fast_update_s(const std::vector<RateWindow100>& windows) {
    if (windows.empty()) return 0.0;
    std::vector<double> costs;
    costs.reserve(windows.size());
    for (const RateWindow100& w : windows) costs.push_back(w.update_s);
    const auto quarter = costs.begin() + static_cast<std::ptrdiff_t>(costs.size() / 4);
    std::nth_element(costs.begin(), quarter, costs.end());
    return *quarter;
}

RateSummary summarize(const std::vector<RateSample>& samples, double from_s, double to_s, double goal_hz,
                      double fast_s) {
    RateSummary r;
    const std::vector<RateSample> in = within(samples, from_s, to_s);
    if (in.size() < 2) return r;
    r.seconds = seconds_of(in.front(), in.back());
    r.rate_mean_hz = r.rate_worst_1s_hz = r.rate_worst_100ms_hz = rate_of(in.front(), in.back());
    r.foreign_share = foreign_of(in.front(), in.back());
    const double wall_s = in.back().t_s - in.front().t_s;
    for (std::size_t i = 0; i < kParties; ++i)
        r.used_share[i] = wall_s > 0.0 ? (in.back().used_s[i] - in.front().used_s[i]) / wall_s : 0.0;
    for (const RateWindow100& w : windows(samples, from_s, to_s, 1.0))
        r.rate_worst_1s_hz = std::min(r.rate_worst_1s_hz, w.rate_hz);
    std::size_t all = 0, quiet = 0, below = 0;
    const auto cycles = static_cast<double>(in.back().cycle - in.front().cycle);
    if (cycles > 0.0) r.recomputed_fraction_mean = 1.0 - (in.back().given_up - in.front().given_up) / cycles;
    for (const RateWindow100& w : windows(samples, from_s, to_s, kWindow_s, fast_s)) {
        ++all;
        r.recomputed_fraction_least = std::min(r.recomputed_fraction_least, w.recomputed_fraction);
        r.rate_worst_100ms_hz = std::min(r.rate_worst_100ms_hz, w.rate_hz);
        if (w.disturbed) continue;
        r.rate_worst_quiet_hz = quiet == 0 ? w.rate_hz : std::min(r.rate_worst_quiet_hz, w.rate_hz);
        ++quiet;
        if (w.rate_hz < kLowestOfGoal * goal_hz) ++below;
    }
    if (quiet > 0) r.share_below_percent = 100.0 * static_cast<double>(below) / static_cast<double>(quiet);
    if (all > 0) r.disturbed_percent = 100.0 * static_cast<double>(all - quiet) / static_cast<double>(all);
    r.level_force_min = 1.0;
    for (const RateSample& s : in) {
        r.vertices_mean += static_cast<double>(s.vertices) / static_cast<double>(in.size());
        r.structures_mean += s.structures / static_cast<double>(in.size());
        r.pixels_mean += s.pixels / static_cast<double>(in.size());
        r.fps_mean += s.fps / static_cast<double>(in.size());
        r.level_force_min = std::min(r.level_force_min, s.level_force);
    }
    double square = 0.0, level = in.front().level_mesh;
    for (const RateSample& s : in) {
        square += std::pow(static_cast<double>(s.vertices) - r.vertices_mean, 2);
        if (std::abs(s.level_mesh - level) <= kLevelChange * level) continue;
        level = s.level_mesh;
        ++r.level_changes;
    }
    r.vertices_sd = std::sqrt(square / static_cast<double>(in.size()));
    return r;
}

double settling_s(const std::vector<RateSample>& samples, double from_s, double to_s, double goal_hz) {
    double since = -1.0;
    for (const RateWindow100& w : windows(samples, from_s, to_s)) {
        if (w.rate_hz < kLowestOfGoal * goal_hz)
            since = -1.0;
        else if (since < 0.0)
            since = w.t_s;
        else if (w.t_s - since >= 1.0)
            return since - from_s;
    }
    return -1.0;
}

}  // namespace tact::launch
