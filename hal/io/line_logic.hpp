// What the safety lines mean: a function of what was read, of what a person asked and of the time.
//
// Trips     at the first look that is not as it has to be, also where the chip tells of an edge between two
//           looks
// Releases  to waiting, after everything has been well for settings.release without a break; to permitted,
//           when the re-arm count moves while it waits. A count that moves before that is used up
// Channels  that differ for longer than settings.discrepancy are a fault of their own: until both have
//           been seen open together, closing them again is not believed, as with a safety relay
// Runs on   the pump's thread; constant time, remembers what is below
#pragma once

#include "hal/api/lines.hpp"

namespace tact {

struct LineReading {
    bool good = false;         // read without an error from an adapter that is there
    std::uint8_t closed = 0;   // LineInput that are active now
    std::uint8_t touched = 0;  // LineInput with an edge since the look before
};

struct LineLogicSettings {
    std::uint8_t fitted = kLineStopA | kLineStopB;  // LineInput
    Duration release = std::chrono::milliseconds(30);
    Duration discrepancy = std::chrono::milliseconds(20);
    Duration follow = std::chrono::milliseconds(100);  // amplifier behind enable line
};

class LineLogic {
public:
    explicit LineLogic(const LineLogicSettings& settings = {}) noexcept : settings_(settings) {}

    // rearms, drops: counts that only rise. enable: the enable line as it has been driven since the look
    // before.
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
    bool well_ = false;        // since well_since_
    bool differ_ = false;      // the channels, since differ_since_
    bool disagreed_ = false;   // for too long; until both are open
    bool unfollowed_ = false;  // since unfollowed_since_
    Instant well_since_{}, differ_since_{}, unfollowed_since_{};
};

}  // namespace tact
