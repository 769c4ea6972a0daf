#include "hal/tracker/igtl_reader.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/error.hpp"

namespace tact {

std::vector<std::string> igtl_names(const std::string& list) {
    std::vector<std::string> names;
    for (std::size_t at = 0; at <= list.size();) {
        const std::size_t comma = std::min(list.find(',', at), list.size());
        const std::size_t first = list.find_first_not_of(' ', at);
        const std::size_t last = comma == 0 ? std::string::npos : list.find_last_not_of(' ', comma - 1);
        if (first < comma && last != std::string::npos && last >= first)
            names.push_back(list.substr(first, last - first + 1));
        at = comma + 1;
    }
    return names;
}

const IgtlTrackerSettings& checked(const IgtlTrackerSettings& s) {
    const auto refuse = [](const std::string& what, const std::string& fix) {
        throw StartupError("settings of the tracker", what, fix);
    };
    if (s.names.empty() || s.names.size() > kTrackerSensorsMax)
        refuse(std::to_string(s.names.size()) + " names of sensors",
               "set tracker.devices to 1 to 4 names, as tact probe lists them");
    for (const std::string& name : s.names)
        if (name.empty() || name.size() > kIgtlNameMax ||
            std::count(s.names.begin(), s.names.end(), name) > 1)
            refuse("the name \"" + name + "\" is too long or given twice",
                   "set tracker.devices to different names of at most 20 letters");
    if (!(s.rate_hz >= 10.0 && s.rate_hz <= 2000.0))
        refuse("a rate of " + std::to_string(s.rate_hz) + " Hz", "set tracker.rate_hz to 10 to 2000");
    if (s.latency < Duration{0} || s.latency > std::chrono::milliseconds(100))
        refuse("a latency of " + std::to_string(to_us(s.latency) * 1e-3) + " ms",
               "set tracker.latency_ms to 0 to 100");
    if (!(s.reach_m >= 0.1 && s.reach_m <= 3.0))
        refuse("a reach of " + std::to_string(s.reach_m) + " m", "set tracker.reach_m to 0.1 to 3");
    return s;
}

IgtlReader::IgtlReader(const IgtlTrackerSettings& settings, IgtlSource& source, Clock& clock)
    : settings_(checked(settings)),
      period_(static_cast<std::int64_t>(1e9 / settings.rate_hz)),
      source_(source),
      clock_(clock),
      sensors_(settings.names.size(), Sensor{.clock = TrackerClock(period_)}) {}

void IgtlReader::opened() noexcept {
    health_.link = TrackerLink::up;
    mailbox_.publish(health_);
}

void IgtlReader::lose_link() noexcept {
    if (health_.link == TrackerLink::up) ++health_.link_losses;
    health_.link = TrackerLink::gone;
    retry_at_ = clock_.now() + kReopenEvery;
    source_.close();
    stream_.restart();
    for (Sensor& s : sensors_) s.known = false;
}

// Periods without a sample between the last one and this, by the sender's clock if it states the time.
void IgtlReader::count_gap(const Sensor& s, Instant arrived) noexcept {
    if (!s.known) return;
    const std::int64_t time_ns = stream_.header.time_ns;
    const bool stated = s.time_ns != 0 && time_ns != 0;
    const Duration gap = stated ? Duration(time_ns - s.time_ns) : arrived - s.arrived;
    if (gap <= Duration{0} || gap > kGapMost) return;
    const std::int64_t periods = std::llround(to_s(gap) * settings_.rate_hz);
    if (periods > 1) health_.missed += static_cast<std::uint64_t>(periods - 1);
}

Refusal IgtlReader::take(Sensor& s, std::uint8_t index, const IgtlPose& pose, Instant arrived) noexcept {
    const std::int64_t time_ns = stream_.header.time_ns;
    if (pose.fault == IgtlPoseFault::not_finite) return Refusal::malformed;
    if (pose.fault == IgtlPoseFault::rotation) return Refusal::norm;
    if (pose.fault == IgtlPoseFault::not_valid || pose.fault == IgtlPoseFault::identity)
        return Refusal::sensor_status;
    if (pose.T.p_m.norm() > settings_.reach_m) return Refusal::out_of_range;
    if (s.known && time_ns != 0 && time_ns == s.time_ns) return Refusal::repeated;
    Instant taken_at = arrived;
    // Differences of 32 bits of microseconds are right for steps of up to half an hour.
    if (time_ns != 0 && !s.clock.stamp(static_cast<std::uint32_t>(time_ns / 1000), arrived, taken_at))
        return Refusal::stale;
    if (taken_at <= s.taken_at) return Refusal::stale;
    count_gap(s, arrived);
    s.known = true;
    s.time_ns = time_ns;
    s.arrived = arrived;
    s.taken_at = taken_at;
    TrackerSample sample;
    sample.taken_at = taken_at - settings_.latency;
    sample.sensor = index;
    sample.T_tracker_sensor = pose.T;
    sample.quality = 1.0;  // these messages have none
    mailbox_.publish(sample);
    ++health_.samples;
    return Refusal::none;
}

void IgtlReader::take(Instant arrived) noexcept {
    switch (decode_poses(stream_.header, stream_.body, poses_)) {
        case IgtlFault::none:
            break;
        case IgtlFault::other_type:
            return;
        case IgtlFault::length:
            return refused_.add(Refusal::wrong_length);
        case IgtlFault::crc:
            return refused_.add(Refusal::crc);
    }
    for (std::size_t i = 0; i < poses_.count; ++i) {
        const IgtlPose& pose = poses_.pose[i];
        const auto name = std::find(settings_.names.begin(), settings_.names.end(), pose.name.view());
        if (name == settings_.names.end()) continue;
        const auto index = static_cast<std::size_t>(name - settings_.names.begin());
        const Refusal why = take(sensors_[index], static_cast<std::uint8_t>(index), pose, arrived);
        if (why != Refusal::none) refused_.add(why);
    }
}

void IgtlReader::drain(Instant arrived) noexcept {
    for (;;) {
        switch (stream_.next()) {
            case IgtlStream::Next::more:
                return;
            case IgtlStream::Next::skipped:
                ++health_.frames;
                break;
            case IgtlStream::Next::message:
                ++health_.frames;
                take(arrived);
                break;
            case IgtlStream::Next::lost:
                ++health_.bus_errors;
                return lose_link();
        }
    }
}

void IgtlReader::round(Duration patience) noexcept {
    if (health_.link == TrackerLink::gone) {
        const Instant now = clock_.now();
        if (now < retry_at_) {
            clock_.wait_until(std::min(retry_at_, now + patience));
            return;
        }
        if (!source_.reopen()) {
            retry_at_ = clock_.now() + kReopenEvery;
            return;
        }
        ++health_.reopened;
        health_.link = TrackerLink::up;
    }
    std::size_t bytes = 0, reads = 0;
    bool more = true;
    while (more && bytes < kRoundBytes && reads < kReadsMax && health_.link == TrackerLink::up) {
        const std::span<std::byte> room = stream_.room();
        const IgtlBatch batch = source_.receive(room, reads == 0 ? patience : Duration{0});
        ++reads;
        bytes += batch.bytes;
        more = batch.bytes > 0;
        stream_.add(batch.bytes);
        drain(clock_.now());
        if (batch.gone && health_.link == TrackerLink::up) lose_link();
    }
    const bool flood = more && health_.link == TrackerLink::up;
    if (flood) ++health_.floods;
    health_.refused = refused_.total();
    mailbox_.publish(health_);
    // During a flood, leaves the processor to other threads between the rounds.
    if (flood) clock_.wait_until(clock_.now() + kFloodPause);
}

TrackerState IgtlReader::read(unsigned sensor, TrackerSample& newest, Instant now) const noexcept {
    return mailbox_.read(sensor, static_cast<unsigned>(sensors_.size()), newest, now);
}

TrackerHealth IgtlReader::health() const noexcept { return mailbox_.health(); }

}  // namespace tact
