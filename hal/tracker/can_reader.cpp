#include "hal/tracker/can_reader.hpp"

#include <linux/can/error.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "ipc/base/error.hpp"

namespace tact {

namespace {

Duration period(const CanTrackerSettings& s) noexcept {
    return Duration(static_cast<std::int64_t>(1e9 / s.rate_hz));
}

}  // namespace

const CanTrackerSettings& checked(const CanTrackerSettings& s) {
    const auto refuse = [](const std::string& what, const std::string& fix) {
        throw StartupError("settings of the tracker", what, fix);
    };
    if (s.fix.sensors < 1 || s.fix.sensors > kTrackerSensorsMax)
        refuse(std::to_string(s.fix.sensors) + " sensors", "set tracker.sensors to 1 to 4");
    if (!(s.rate_hz >= 10.0 && s.rate_hz <= 2000.0))
        refuse("a rate of " + std::to_string(s.rate_hz) + " Hz", "set tracker.rate_hz to 10 to 2000");
    if (s.latency < Duration{0} || s.latency > std::chrono::milliseconds(100))
        refuse("a latency of " + std::to_string(to_us(s.latency) * 1e-3) + " ms",
               "set tracker.latency_ms to 0 to 100");
    if (!(s.fix.reach_m >= 0.1 && s.fix.reach_m <= 3.0))
        refuse("a reach of " + std::to_string(s.fix.reach_m) + " m", "set tracker.reach_m to 0.1 to 3");
    return s;
}

CanReader::CanReader(const CanTrackerSettings& settings, CanSource& source, Clock& clock)
    : settings_(checked(settings)),
      source_(source),
      clock_(clock),
      assembler_(settings.fix),
      clocks_{TrackerClock(period(settings)), TrackerClock(period(settings)), TrackerClock(period(settings)),
              TrackerClock(period(settings))} {}

void CanReader::opened() noexcept {
    health_.link = TrackerLink::up;
    mailbox_.publish(health_);
}

void CanReader::link_is(TrackerLink link) noexcept {
    if (link == health_.link) return;
    if (health_.link == TrackerLink::up) ++health_.link_losses;
    if (link == TrackerLink::up) assembler_.restart();
    health_.link = link;
}

void CanReader::publish(const TrackerFix& fix, Instant taken_at) noexcept {
    taken_at_[fix.sensor] = taken_at;
    TrackerSample sample;
    sample.taken_at = taken_at - settings_.latency;
    sample.sensor = fix.sensor;
    sample.T_tracker_sensor = fix.T_tracker_sensor;
    sample.quality = fix.quality;
    sample.distortion = fix.distortion;
    mailbox_.publish(sample);
    ++health_.samples;
}

void CanReader::take_error(const CanFrame& frame) noexcept {
    ++health_.bus_errors;
    if ((frame.id & CAN_ERR_BUSOFF) != 0) {
        ++counts_.bus_offs;
        link_is(TrackerLink::bus_off);
    } else if ((frame.id & CAN_ERR_RESTARTED) != 0 && health_.link == TrackerLink::bus_off) {
        link_is(TrackerLink::up);
    }
    constexpr unsigned kPassive = CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE;
    if ((frame.id & CAN_ERR_CRTL) != 0 && (frame.data[1] & kPassive) != 0) ++counts_.bus_passive;
}

void CanReader::take(const CanFrame& frame, Instant arrived) noexcept {
    ++health_.frames;
    if (frame.kind == CanKind::error) return take_error(frame);
    // Any received frame proves that the bus works.
    if (frame.kind != CanKind::malformed) link_is(TrackerLink::up);
    TrackerFix fix;
    if (!assembler_.take(frame, fix)) return;
    Instant taken_at{};
    // A frame with a shorter delay improves the clock estimate, so a stamp can fall behind the last one,
    // most likely just after the start. Such a sample is refused: time never runs backwards for a reader.
    if (clocks_[fix.sensor].stamp(fix.time_us, arrived, taken_at) && taken_at > taken_at_[fix.sensor])
        publish(fix, taken_at);
    else
        assembler_.refuse(Refusal::stale);
}

void CanReader::round(Duration patience) noexcept {
    if (health_.link == TrackerLink::gone) {
        const Instant now = clock_.now();
        if (now < retry_at_) {
            clock_.wait_until(std::min(retry_at_, now + patience));
            return;
        }
        retry_at_ = now + kReopenEvery;
        if (!source_.reopen()) return;
        ++health_.reopened;
        link_is(TrackerLink::up);
    }
    bool flood = true;
    for (std::size_t n = 0; n < kBatchesMax && flood; ++n) {
        const CanBatch batch = source_.receive(frames_, n == 0 ? patience : Duration{0});
        const Instant arrived = clock_.now();
        health_.dropped += batch.dropped;
        for (const CanFrame& frame : std::span(frames_).first(std::min(batch.count, frames_.size())))
            take(frame, arrived);
        flood = batch.count >= frames_.size() && batch.fault == CanFault::none;
        if (batch.fault == CanFault::down) link_is(TrackerLink::down);
        if (batch.fault == CanFault::gone) {
            link_is(TrackerLink::gone);
            retry_at_ = clock_.now() + kReopenEvery;
        }
    }
    if (flood) ++health_.floods;
    health_.missed = assembler_.missed();
    health_.refused = assembler_.refused().total();
    mailbox_.publish(health_);
    // During a flood, leaves the processor to other threads between the rounds.
    if (flood) clock_.wait_until(clock_.now() + kFloodPause);
}

TrackerState CanReader::read(unsigned sensor, TrackerSample& newest, Instant now) const noexcept {
    return mailbox_.read(sensor, settings_.fix.sensors, newest, now);
}

TrackerHealth CanReader::health() const noexcept { return mailbox_.health(); }

CanReaderCounts CanReader::counts() const noexcept {
    CanReaderCounts c = counts_;
    c.refused = assembler_.refused();
    for (const TrackerClock& clock : clocks_) c.clock_restarts += clock.restarts();
    return c;
}

}  // namespace tact
