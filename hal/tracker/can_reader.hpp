// From a CAN bus to the newest pose of each sensor: one bounded round at a time.
//
// Round     at most kBatchesMax batches: a flood costs a bounded time; frames left in the kernel's queue
//           are then old, refused as stale and counted until the newest is reached
// Link      down: continues automatically; gone: reopened every kReopenEvery; bus off: flagged until a good
//           frame or the controller's "restarted". After each, counters restart.
// Thread    round() on its own thread; read() and health() on another
#pragma once

#include <array>

#include "hal/api/tracker.hpp"
#include "hal/tracker/can_source.hpp"
#include "hal/tracker/fix_assembler.hpp"
#include "hal/tracker/tracker_clock.hpp"
#include "hal/tracker/tracker_mailbox.hpp"

namespace tact {

struct CanTrackerSettings {
    FixSettings fix;
    double rate_hz = 240.0;                           // of each sensor
    Duration latency = std::chrono::milliseconds(4);  // from the motion to the frame on the bus
};

// The same settings, or StartupError for impossible numbers of sensors, rates and latencies.
const CanTrackerSettings& checked(const CanTrackerSettings& settings);

// One counter per kind, for the health panel and the log.
struct CanReaderCounts {
    RefusalCounts refused;
    std::uint64_t bus_offs = 0, bus_passive = 0, clock_restarts = 0;
};

class CanReader {
public:
    static constexpr std::size_t kBatchesMax = 4;
    static constexpr Duration kReopenEvery = std::chrono::milliseconds(500);
    static constexpr Duration kFloodPause = std::chrono::milliseconds(1);

    // Both outlive the reader.
    CanReader(const CanTrackerSettings& settings, CanSource& source, Clock& clock);

    void opened() noexcept;                  // after open() of the source
    void round(Duration patience) noexcept;  // returns after about `patience` without frames

    TrackerState read(unsigned sensor, TrackerSample& newest, Instant now) const noexcept TACT_RT;
    [[nodiscard]] TrackerHealth health() const noexcept TACT_RT;
    [[nodiscard]] CanReaderCounts counts() const noexcept;  // on the thread of round() only

private:
    void take(const CanFrame& frame, Instant arrived) noexcept;
    void take_error(const CanFrame& frame) noexcept;
    void link_is(TrackerLink link) noexcept;
    void publish(const TrackerFix& fix, Instant taken_at) noexcept;

    CanTrackerSettings settings_;
    CanSource& source_;
    Clock& clock_;
    FixAssembler assembler_;
    std::array<TrackerClock, kTrackerSensorsMax> clocks_;
    std::array<CanFrame, kCanBatch> frames_;
    TrackerHealth health_;
    CanReaderCounts counts_;
    std::array<Instant, kTrackerSensorsMax> taken_at_{};  // of the newest sample
    Instant retry_at_{};
    TrackerMailbox mailbox_;
};

}  // namespace tact
