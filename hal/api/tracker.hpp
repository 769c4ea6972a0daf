// Interface of a head tracker: the newest pose of each sensor, with its time and quality.
//
// Frame    tracker: the tracker's own, right-handed, metres. Registration maps it to the screen and the device
// Time     taken_at is the time of measurement on the machine's monotonic clock; the display predicts from it
// State    follows from the age of the newest good sample alone: fresh to 50 ms; then frozen: the last pose
//          stands and the view must not move; lost from 1 s, before the first sample, and for a sensor that
//          does not exist
// Force    nothing here affects the force: a tracker that fails affects the view alone
// Thread   open() at start-up; read() and health() from any one thread, also the servo: they only touch
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
    Duration latency{};    // from the motion to the frame, already subtracted from the time of the samples
};

struct TrackerSample {
    Instant taken_at{};
    std::uint64_t sequence = 0;  // rises with every new sample of this sensor
    std::uint8_t sensor = 0;
    Pose T_tracker_sensor;
    double quality = 0.0;     // 0 to 1, as the tracker reports it
    double distortion = 0.0;  // 0 to 1, from metal in the field
    TrackerState state = TrackerState::lost;
};

enum class TrackerLink : std::uint8_t {
    closed,
    up,
    down,     // the interface is down; continues when it is up again
    bus_off,  // the CAN controller left the bus after errors; continues when it is restarted
    gone,     // the interface vanished or fails; reopened about twice a second
};

// Counters since open(); they only rise.
struct TrackerHealth {
    TrackerLink link = TrackerLink::closed;
    std::uint64_t frames = 0;       // received from the bus
    std::uint64_t samples = 0;      // complete valid poses
    std::uint64_t missed = 0;       // sample periods without a sample
    std::uint64_t refused = 0;      // rejected frames and poses
    std::uint64_t dropped = 0;      // by the kernel: arrived faster than they were read
    std::uint64_t floods = 0;       // reader rounds that reached their limit with frames left
    std::uint64_t bus_errors = 0;   // error frames
    std::uint64_t link_losses = 0;  // times that the link left the state up
    std::uint64_t reopened = 0;
};

class Tracker {
public:
    virtual ~Tracker() = default;
    virtual TrackerInfo open() = 0;  // start-up; throws StartupError with the fix
    // The newest sample of a sensor as of now; the return value equals newest.state. Before the first sample the
    // state is lost and the pose the identity.
    virtual TrackerState read(unsigned sensor, TrackerSample& newest, Instant now) noexcept TACT_RT = 0;
    [[nodiscard]] virtual TrackerHealth health() const noexcept TACT_RT = 0;
};

}  // namespace tact
