#include "rt/servo/rate_keeping.hpp"

#include <algorithm>

namespace tact::servo {

namespace {

constexpr double kMemory_s = 1.0;  // of the costs of whole steps

bool holds_rate(const CycleState& c, const ServoSettings& settings) noexcept {
    return settings.free_running && !c.dry && c.governor.settings().law != Law::fixed;
}

}  // namespace

Instant timestamp(CycleState& c, Clock& clock) noexcept {
    const Instant now = clock.now();
    if (c.timestamps < c.timestamp.size()) c.timestamp[c.timestamps++] = now;
    return now;
}

Instant rest(CycleState& c, const ServoSettings& settings, Clock& clock) noexcept {
    const Instant now = timestamp(c, clock);
    const auto paths = c.governor.paths();
    const bool wanted = std::any_of(paths.begin(), paths.end(), [](const GovernedPath& p) {
        return p.present && !p.knob.haptic && p.level < 1.0F;
    });
    if (!holds_rate(c, settings) || !wanted) return now;
    const double rest_s = c.govern.hold.rest_s(now, c.governor.settings().goal_hz);
    if (rest_s <= 0.0) return now;
    clock.wait_until(now + Duration{static_cast<std::int64_t>(1e9 * rest_s)});
    const Instant end = timestamp(c, clock);
    c.govern.rest += end - now;
    c.statistics.work.rested(end - now);
    return end;
}

double work_fraction(CycleState& c, const ServoSettings& settings) noexcept {
    if (holds_rate(c, settings)) return c.govern.hold.work_fraction(c.now, c.governor.settings().goal_hz);
    c.govern.hold.restart();
    return 1.0;
}

void count_work(CycleState& c) noexcept {
    if (c.recomputed_fraction < 1.0) return;
    GovernCycle& g = c.govern;
    g.whole_model_s += to_s(c.model_cost);
    g.whole_cost_s += to_s(c.cost);
    if (g.whole_cost_s < kMemory_s) return;
    g.whole_model_s *= 0.5;
    g.whole_cost_s *= 0.5;
}

}  // namespace tact::servo
