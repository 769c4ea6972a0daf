// From the messages of an OpenIGTLink server to the newest pose of each sensor: one bounded round at a time.
//
// Sensors   by name: the device of a TRANSFORM, or an element of a TDATA. Other messages are ignored
// Time      the sender's time stamps, converted as those of the CAN tracker (tracker_clock.hpp); without one, the arrival
// Round     at most kRoundBytes and kReadsMax reads: a flood costs a bounded time, and kFloodPause between two rounds
// Link      gone: the server closed the connection, is unreachable or sends something else; connects again every
//           kReopenEvery
// Thread    round() on its own thread; read() and health() on another
#pragma once

#include <array>
#include <string>
#include <vector>

#include "hal/tracker/igtl_source.hpp"
#include "hal/tracker/refusals.hpp"
#include "hal/tracker/tracker_clock.hpp"
#include "hal/tracker/tracker_mailbox.hpp"
#include "ipc/igtl/stream.hpp"

namespace tact {

struct IgtlTrackerSettings {
    std::vector<std::string> names;  // of the sensors, 1 to 4
    double rate_hz = 60.0;           // of each sensor
    Duration latency{};              // from the motion to the message
    double reach_m = 1.6;
};

// The names in "HeadToTracker, StylusToTracker": between commas, without blanks around them.
[[nodiscard]] std::vector<std::string> igtl_names(const std::string& list);

// The same settings, or StartupError for impossible names, rates and latencies.
const IgtlTrackerSettings& checked(const IgtlTrackerSettings& settings);

class IgtlReader {
public:
    static constexpr std::size_t kRoundBytes = std::size_t{64} * 1024, kReadsMax = 64;
    static constexpr Duration kReopenEvery = std::chrono::milliseconds(500);
    static constexpr Duration kFloodPause = std::chrono::milliseconds(2);
    static constexpr Duration kGapMost = std::chrono::seconds(1);  // a longer one is no loss, but a pause

    // Both outlive the reader.
    IgtlReader(const IgtlTrackerSettings& settings, IgtlSource& source, Clock& clock);

    void opened() noexcept;                  // after open() of the source
    void round(Duration patience) noexcept;  // returns after about `patience` without bytes

    TrackerState read(unsigned sensor, TrackerSample& newest, Instant now) const noexcept TACT_RT;
    [[nodiscard]] TrackerHealth health() const noexcept TACT_RT;
    [[nodiscard]] const RefusalCounts& refused() const noexcept {
        return refused_;
    }  // on the thread of round() only

private:
    struct Sensor {
        TrackerClock clock;
        bool known = false;
        std::int64_t time_ns = 0;  // of the newest sample, by the sender; 0: not stated
        Instant arrived{}, taken_at{};
    };

    void drain(Instant arrived) noexcept;
    void take(Instant arrived) noexcept;
    [[nodiscard]] Refusal take(Sensor& sensor, std::uint8_t index, const IgtlPose& pose,
                               Instant arrived) noexcept;
    void count_gap(const Sensor& sensor, Instant arrived) noexcept;
    void lose_link() noexcept;

    IgtlTrackerSettings settings_;
    Duration period_;
    IgtlSource& source_;
    Clock& clock_;
    IgtlStream stream_;
    IgtlPoses poses_;
    std::vector<Sensor> sensors_;
    TrackerHealth health_;
    RefusalCounts refused_;
    Instant retry_at_{};
    TrackerMailbox mailbox_;
};

}  // namespace tact
