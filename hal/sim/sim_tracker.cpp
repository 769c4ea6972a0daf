#include "hal/sim/sim_tracker.hpp"

#include <algorithm>

namespace tact {

SimTracker::SimTracker(const SimHeadSettings& settings)
    : settings_(settings), bus_(settings, clock_), reader_(settings.can, bus_, clock_) {}

TrackerInfo SimTracker::open() {
    opened_ = true;
    reader_.opened();
    TrackerInfo info;
    info.name = "emulated tracker";
    info.sensors = settings_.can.fix.sensors;
    info.rate_hz = settings_.can.rate_hz;
    info.latency = settings_.can.latency;
    return info;
}

TrackerState SimTracker::read(unsigned sensor, TrackerSample& newest, Instant now) noexcept {
    if (opened_) {
        clock_.set(std::max(now, clock_.now()));
        if (!started_) bus_.open();  // the bus's time starts with the first poll
        started_ = true;
        reader_.round(Duration{0});
    }
    return reader_.read(sensor, newest, now);
}

TrackerHealth SimTracker::health() const noexcept { return reader_.health(); }

}  // namespace tact
