#include "rt/servo/stage_govern.hpp"

#include <algorithm>
#include <array>

#include "rt/servo/fit_level.hpp"
#include "rt/servo/publish_levels.hpp"
#include "rt/servo/report.hpp"

namespace tact::servo {

namespace {

// The levels as they are, to see which ones change.
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
bool sample_display(CycleState& c) noexcept {
    const HousekeepingReport& h = c.housekeeping;
    if (h.gui_attached == 0) return false;
    const auto sample = c.govern.display.take({.frame = h.gui_frame,
                                               .levels_sequence = h.gui_levels_sequence,
                                               .taken_at_ns = h.gui_taken_at_ns,
                                               .work_s = h.gui_work_s,
                                               .cpu_s = h.gui_cpu_s,
                                               .drawn = h.gui_vertices > 0});
    return sample && c.governor.update(*sample);
}

// A slow update that takes longer than its period falls behind the hand, and with it what the force is computed on: to
// the law that is a rate too low, in proportion. From kSlowUpdateFraction of a period on no level rises any more.
double rate_kept_up(const CycleState& c, double rate_hz) noexcept {
    const double slow_update_s = c.hand[0].model->slow_update_s();
    if (!(slow_update_s > 0.0)) return rate_hz;
    return std::min(rate_hz, c.governor.settings().goal_hz * kSlowUpdateFraction * to_s(kSlowUpdatePeriod) /
                                 slow_update_s);
}

// A loop of fixed rate never shows more than its rate. The law needs to know whether there is time to spare: the rate
// that the cycles of this interval would have allowed. It is cut at a tenth above the goal, so that levels come back
// by a few percent a step and not in one leap.
// A freely running loop that is held near its goal shows little else: the law needs the rate that whole steps without
// rests would have made of the same time. Work is counted, not time: a step that lost its processor in the middle would
// weigh too much. Dips that were lifted and peaks that were cut even out, so the mean of what the law gets is at the
// goal where the mean rate is.
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
    g.recomputed = 0.0;
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
    if (c.dry) return calibrate_level(c);
    Levels before = levels_of(c.governor);
    if (fit_level(c, settings)) {
        report_levels(c, settings, region, before, true);
        before = levels_of(c.governor);
    }

    const bool pending = c.housekeeping.gui_attached != 0 && g.display.pending(c.now);
    if (sample_display(c)) {
        report_levels(c, settings, region, before, true);
        return start_interval(c, c.now);
    }
    // A measurement from before the display applied the levels tells nothing about them.
    if (pending && c.governor.settings().law == Law::elastic) {
        if (!g.display.pending(c.now)) start_interval(c, c.now);
        return;
    }
    const Duration interval = c.now - g.begun_at;
    if (interval < settings.governor_interval) return;
    g.law_rate_hz = rate_kept_up(c, rate_for_law(c, settings, interval));
    g.model_cost_s = to_s(g.model_cost) / static_cast<double>(g.cycles);
    set_display_present(c, settings, c.housekeeping.gui_attached != 0);
    limit_by_slow_update(c);
    const bool changed = c.governor.step(g.law_rate_hz, interval);
    report_levels(c, settings, region, before, changed || resized(c, settings));
    start_interval(c, c.now);
}

}  // namespace tact::servo
