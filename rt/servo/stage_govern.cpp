#include "rt/servo/stage_govern.hpp"

#include <algorithm>
#include <array>

#include "rt/servo/fit_level.hpp"
#include "rt/servo/publish_levels.hpp"
#include "rt/servo/report.hpp"

namespace tact::servo {

namespace {

// A step that was asked for at most so much of its work, and did more than this, cannot do less.
constexpr double kAskedMost = 0.8, kDoneMost = 0.9;

// Copy of all levels, to detect changes.
using Levels = std::array<float, Governor::kPathsMax>;

Levels levels_of(const Governor& governor) noexcept {
    Levels levels{};
    const auto paths = governor.paths();
    for (std::size_t i = 0; i < paths.size(); ++i) levels[i] = paths[i].level;
    return levels;
}

void report_levels(CycleState& c, const ServoSettings& settings, RtRegion& region, const Levels& before,
                   bool changed) noexcept {
    const auto paths = c.governor.paths();
    if (changed) ++c.report.levels_sequence;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        if (paths[i].level == before[i]) continue;
        c.report.level_changed_at_ns[i] = to_ns(c.now);
        report(c, region, EventCode::level_changed, static_cast<double>(i),
               static_cast<double>(paths[i].level), static_cast<std::uint16_t>(paths[i].reason));
        if (!paths[i].knob.haptic) c.govern.display.asked(c.report.levels_sequence, c.now);
    }
    publish_levels(c, settings, region);
}

// True: a frame has changed a level or its reason.
bool sample_display(CycleState& c, const ServoSettings& settings) noexcept {
    const HousekeepingReport& h = c.housekeeping;
    c.governor.set_display_resting(h.gui_attached != 0 && h.gui_refined == 1);
    if (h.gui_attached == 0) return false;
    auto sample = c.govern.display.take({.frame = h.gui_frame,
                                         .levels_sequence = h.gui_levels_sequence,
                                         .taken_at_ns = h.gui_taken_at_ns,
                                         .work_s = h.gui_work_s,
                                         .cpu_s = h.gui_cpu_s,
                                         .drawn = h.gui_vertices > 0,
                                         .refined = h.gui_refined != 0});
    if (!sample) return false;
    for (std::size_t i = 0; i < settings.visual_paths.size(); ++i)
        sample->path_s[visual_index(i)] = h.*settings.visual_paths[i].cost_s;
    return c.governor.update(*sample);
}

// A slow update that takes longer than kSlowUpdateFraction of its period makes the force's data lag the hand. The law
// then gets a proportionally lower rate, so levels stop rising and then fall.
double rate_kept_up(const CycleState& c, double rate_hz) noexcept {
    const double slow_update_s = c.hand[0].model->slow_update_s();
    if (!(slow_update_s > 0.0)) return rate_hz;
    return std::min(rate_hz, c.governor.settings().goal_hz * kSlowUpdateFraction * to_s(kSlowUpdatePeriod) /
                                 slow_update_s);
}

// Rate with which the law can detect spare time.
// Fixed rate: the measured rate never exceeds the loop's rate, so the law gets the rate that the cost of the cycles
// would have allowed, at most 1.1 times the goal, so that levels return by a few percent per step.
// Free running: rate_hold keeps the measured rate near the goal, so the law gets the rate that whole steps without
// sleep would have reached. It counts work instead of time, because a preempted step would weigh too much.
// Recovered deficits and sleep cancel, so the law's mean rate is at the goal when the mean rate is.
double rate_for_law(const CycleState& c, const ServoSettings& settings, Duration interval) noexcept {
    const GovernCycle& g = c.govern;
    const double measured_hz = static_cast<double>(g.cycles) / std::max(to_s(interval), 1e-9);
    if (settings.free_running) {
        const double given_up = 1.0 - g.recomputed / static_cast<double>(g.cycles);
        const double part = g.whole_cost_s > 0.0 ? g.whole_model_s / g.whole_cost_s : 1.0;
        const double awake = std::max(1.0 - to_s(g.rest) / to_s(interval), 0.1);
        return measured_hz * (1.0 - part * given_up) / awake;
    }
    if (g.overruns > 0 || g.cost.count() <= 0) return measured_hz;
    const double possible_hz = static_cast<double>(g.cycles) / to_s(g.cost);
    return std::max(measured_hz, std::min(possible_hz, 1.1 * c.governor.settings().goal_hz));
}

bool resized(const CycleState& c, const ServoSettings& settings) noexcept {
    bool differs = false;
    for (std::size_t i = 0; i < settings.visual_paths.size(); ++i)
        differs = differs || c.report.items_max[i] != c.housekeeping.*settings.visual_paths[i].items_max;
    return differs;
}

}  // namespace

void start_interval(CycleState& c, Instant now) noexcept {
    GovernCycle& g = c.govern;
    g.begun_at = now;
    g.cycles = g.overruns = 0;
    g.cost = g.model_cost = g.rest = Duration{0};
    g.recomputed = g.asked = 0.0;
}

void set_display_present(CycleState& c, const ServoSettings& settings, bool present) noexcept {
    for (std::size_t i = 0; i < settings.visual_paths.size(); ++i)
        c.governor.set_present(visual_index(i), present);
}

void govern(CycleState& c, const ServoSettings& settings, RtRegion& region) noexcept {
    GovernCycle& g = c.govern;
    ++g.cycles;
    g.model_cost += c.model_cost;
    g.recomputed += c.recomputed_fraction;
    g.asked += static_cast<double>(c.budget.work_fraction);
    if (c.dry) return calibrate_level(c, settings);
    Levels before = levels_of(c.governor);
    if (fit_level(c, settings)) {
        report_levels(c, settings, region, before, true);
        before = levels_of(c.governor);
    }

    const bool pending = c.housekeeping.gui_attached != 0 && g.display.pending(c.now);
    if (sample_display(c, settings)) {
        report_levels(c, settings, region, before, true);
        return start_interval(c, c.now);
    }
    // Rates measured before the display applies the levels do not describe them.
    if (pending && c.governor.settings().law == Law::elastic) {
        if (!g.display.pending(c.now)) start_interval(c, c.now);
        return;
    }
    const Duration interval = c.now - g.begun_at;
    if (interval < settings.governor_interval) return;
    g.law_rate_hz = rate_kept_up(c, rate_for_law(c, settings, interval));
    g.model_cost_s = to_s(g.model_cost) / static_cast<double>(g.cycles);
    set_display_present(c, settings, c.housekeeping.gui_attached != 0);
    const auto cycles = static_cast<double>(g.cycles);
    if (g.asked < kAskedMost * cycles) c.governor.set_held(g.recomputed < kDoneMost * cycles);
    limit_by_slow_update(c);
    const bool changed = c.governor.step(g.law_rate_hz, interval);
    report_levels(c, settings, region, before, changed || resized(c, settings));
    start_interval(c, c.now);
}

}  // namespace tact::servo
