// A head tracker, as the rest of Tact sees it: the newest pose of each sensor, with its time and its worth.
//
// Frame    tracker: the tracker's own, right-handed, metres. Registration takes it to the screen and the
// device. Time     a sample's is when the tracker measured, on the machine's monotonic clock: display
// predicts from there State    follows from the age of the newest good sample alone: fresh to 50 ms; then
// frozen: the last pose stands
//          and the view must not move; lost from 1 s, before the first sample, and for a sensor there is not
// Force    nothing here reaches the force: a tracker that fails costs the view, never the hand
// Thread   open() at start-up; read() and health() from any one thread, the servo's too: they only touch
//          memory
#pragma once

#include <cstdint>
#include <string>

#include "ipc/base/clock.hpp"
#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

enum class TrackerState : std::uint8_t { lost, frozen, fresh };

inline constexpr Duration kTrackerFrozenAfter = std::chrono::milliseconds(50);
inline constexpr Duration kTrackerLostAfter = std::chrono::seconds(1);

[[nodiscard]] constexpr TrackerState tracker_state(Duration age) noexcept {
    if (age > kTrackerLostAfter) return TrackerState::lost;
    return age > kTrackerFrozenAfter ? TrackerState::frozen : TrackerState::fresh;
}

struct TrackerInfo {
    std::string name;
    unsigned sensors = 0;
    double rate_hz = 0.0;  // of each sensor
    Duration latency{};    // from the motion to the frame, already taken off the samples' time
};

struct TrackerSample {
    Instant taken_at{};
    std::uint64_t sequence = 0;  // rises with every new sample of this sensor
    std::uint8_t sensor = 0;
    Pose T_tracker_sensor;
    double quality = 0.0;     // 0 to 1, as the tracker judges itself
    double distortion = 0.0;  // 0 to 1, metal in the field
    TrackerState state = TrackerState::lost;
};

enum class TrackerLink : std::uint8_t {
    closed,
    up,
    down,     // the interface is down; goes on by itself when it is up again
    bus_off,  // the controller has left the bus after errors; goes on when it is restarted
    gone,     // the interface vanished or fails; reopened about twice a second
};

// Counters since open(); they only rise.
struct TrackerHealth {
    TrackerLink link = TrackerLink::closed;
    std::uint64_t frames = 0;       // taken from the bus
    std::uint64_t samples = 0;      // whole good poses
    std::uint64_t missed = 0;       // periods that never came
    std::uint64_t refused = 0;      // frames and poses that were not believed
    std::uint64_t dropped = 0;      // by the kernel: came faster than they were taken
    std::uint64_t floods = 0;       // rounds that ended at their bound with more to take
    std::uint64_t bus_errors = 0;   // error frames
    std::uint64_t link_losses = 0;  // times that the link went from up
    std::uint64_t reopened = 0;
};

class Tracker {
public:
    virtual ~Tracker() = default;
    virtual TrackerInfo open() = 0;  // start-up; throws StartupError with the fix
    // The newest sample of a sensor as of now; what it returns is also newest.state. Lost before the first
    // sample leaves the pose at the identity.
    virtual TrackerState read(unsigned sensor, TrackerSample& newest, Instant now) noexcept TACT_RT = 0;
    [[nodiscard]] virtual TrackerHealth health() const noexcept TACT_RT = 0;
};

}  // namespace tact
