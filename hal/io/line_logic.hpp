// Evaluates the safety inputs: a function of the reading, the operator's requests and the time.
//
// Trips     at the first reading that does not permit, also when the chip reports an edge between two
//           readings
// Releases  to waiting, after all inputs have permitted for settings.release without a break; to permitted,
//           when the re-arm count changes in that state. A change before that is discarded
// Channels  that differ for longer than settings.discrepancy are a separate fault: their closing is not
//           accepted until both have been read open together, as with a safety relay
// Runs on   the pump's thread; constant time, keeps the state below
#pragma once

#include "hal/api/lines.hpp"

namespace tact {

struct LineReading {
    bool good = false;         // read without an error from an adapter that is present
    std::uint8_t closed = 0;   // LineInput that are active now
    std::uint8_t touched = 0;  // LineInput with an edge since the previous reading
};

struct LineLogicSettings {
    std::uint8_t fitted = kLineStopA | kLineStopB;  // LineInput
    Duration release = std::chrono::milliseconds(30);
    Duration discrepancy = std::chrono::milliseconds(20);
    Duration follow = std::chrono::milliseconds(100);  // from the enable line to the amplifier's read-back
};

class LineLogic {
public:
    explicit LineLogic(const LineLogicSettings& settings = {}) noexcept : settings_(settings) {}

    // rearms, drops: counts that only rise. enable: the enable line as driven since the previous reading.
    void look(const LineReading& in, std::uint64_t rearms, std::uint64_t drops, bool enable,
              Instant now) noexcept;

    [[nodiscard]] LinesState state() const noexcept { return state_; }
    [[nodiscard]] LinesCause cause() const noexcept { return cause_; }
    [[nodiscard]] std::uint64_t trips() const noexcept { return trips_; }

private:
    [[nodiscard]] LinesCause judge(const LineReading& in, bool enable, Instant now) noexcept;

    LineLogicSettings settings_;
    LinesState state_ = LinesState::stopped;
    LinesCause cause_ = LinesCause::none;
    std::uint64_t trips_ = 0, rearms_ = 0, drops_ = 0;
    bool well_ = false;        // all inputs permit, since well_since_
    bool differ_ = false;      // the channels, since differ_since_
    bool disagreed_ = false;   // for too long; until both are open
    bool unfollowed_ = false;  // since unfollowed_since_
    Instant well_since_{}, differ_since_{}, unfollowed_since_{};
};

}  // namespace tact
