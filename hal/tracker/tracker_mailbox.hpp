// Newest sample of each sensor and the counters, from the reader of a tracker to any thread.
//
// Through Latest<>: readers never wait and get whole values
// Thread   publish() on the reader's thread; read() and health() on any
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>

#include "hal/api/tracker.hpp"
#include "hal/tracker/can_layout.hpp"
#include "ipc/shm/latest.hpp"

namespace tact {

class TrackerMailbox {
public:
    TrackerMailbox() : slots_(std::make_unique<Slots>()) {}

    // taken_at: time of the measurement. state is not used; the sample gets the next sequence number.
    void publish(const TrackerSample& s) noexcept {
        Words w{};
        w.taken_at_ns = to_ns(s.taken_at);
        w.sequence = ++sequence_[s.sensor];
        for (int i = 0; i < 3; ++i) w.pos_m[i] = s.T_tracker_sensor.p_m[i];
        for (int i = 0; i < 4; ++i) w.quat_xyzw[i] = s.T_tracker_sensor.q.coeffs()[i];
        w.quality = s.quality;
        w.distortion = s.distortion;
        slots_->samples[s.sensor].publish(w);
    }
    void publish(const TrackerHealth& health) noexcept { slots_->health.publish(health); }

    // As Tracker::read(); a sensor from `sensors` on does not exist.
    TrackerState read(unsigned sensor, unsigned sensors, TrackerSample& newest,
                      Instant now) const noexcept TACT_RT {
        Words w;
        if (sensor >= sensors) return newest.state = TrackerState::lost;
        // If the writer lapped every attempt, the caller keeps its old value and its age.
        if (slots_->samples[sensor].read(w)) {
            newest.taken_at = std::min(instant_from_ns(w.taken_at_ns), now);
            newest.sequence = w.sequence;
            newest.sensor = static_cast<std::uint8_t>(sensor);
            newest.T_tracker_sensor.p_m = Vec3(w.pos_m[0], w.pos_m[1], w.pos_m[2]);
            newest.T_tracker_sensor.q = Quat(w.quat_xyzw[3], w.quat_xyzw[0], w.quat_xyzw[1], w.quat_xyzw[2]);
            newest.quality = w.quality;
            newest.distortion = w.distortion;
        }
        newest.state = newest.sequence == 0 ? TrackerState::lost : tracker_state(now - newest.taken_at);
        return newest.state;
    }
    [[nodiscard]] TrackerHealth health() const noexcept TACT_RT {
        TrackerHealth h;
        static_cast<void>(slots_->health.read(h));
        return h;
    }

private:
    struct Words {
        std::int64_t taken_at_ns;
        std::uint64_t sequence;
        double pos_m[3], quat_xyzw[4];
        double quality, distortion;
    };
    struct Slots {
        std::array<Latest<Words>, kTrackerSensorsMax> samples;
        Latest<TrackerHealth> health;
    };
    std::unique_ptr<Slots> slots_;
    std::array<std::uint64_t, kTrackerSensorsMax> sequence_{};
};

}  // namespace tact
