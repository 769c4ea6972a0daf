#include "rt/servo/stage_wake.hpp"

#include "rt/servo/rate_keeping.hpp"

namespace tact::servo {

void wake(CycleState& c, const ServoSettings& settings, Clock& clock) noexcept {
    ++c.step;
    c.timestamps = 0;
    if (settings.free_running || c.dry) {
        c.now = c.planned = rest(c, settings, clock);
        c.lateness = Duration{0};
    } else {
        c.planned = c.pacer.planned();
        clock.wait_until(c.planned);
        c.now = timestamp(c, clock);
        c.lateness = c.now - c.planned;
        c.statistics.late(c.lateness);
    }
    c.dt = c.cycle == 0 ? Duration{0} : c.now - c.before;
    c.before = c.now;
    ++c.cycle;
    if (!(c.dry && settings.emulated) || c.cycle == 1) c.device_now = c.now;
}

}  // namespace tact::servo
