// Interface of the safety I/O for the servo loop: inputs that permit force, and outputs that report the state of
// the controller. The hardware chain cuts the power without the PC; the PC only monitors it.
//
// In       emergency stop, two channels normally closed; dead-man pedal; amplifier feedback
// Out      enable of the amplifier; watchdog, toggled only while the servo runs; lamp
// Stop     at the first edge, and for anything unreadable: an error, a missing line, a broken wire.
//          Closed contacts end the stop only after a time without a bounce; then a person must
//          still re-arm
// Thread   open() at start-up; read() and write() from the servo thread alone, they only touch memory; drop()
//          from any thread; a pump owns the adapter
#pragma once

#include <cstdint>
#include <string>

#include "ipc/base/clock.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

// Bits of LinesSample::inputs. A line that is not fitted reads as its permissive state.
enum LineInput : std::uint8_t {
    kLineStopA = 1U << 0,  // closed
    kLineStopB = 1U << 1,
    kLineDeadMan = 1U << 2,    // pressed
    kLineAmplifier = 1U << 3,  // the amplifier reports that it is on
    // Tool inputs, pressed; they cause no stop. One that is not fitted or cannot be read counts as not pressed.
    kLineBurr = 1U << 4,
    kLineSuction = 1U << 5,
};
// Bits of LinesSample::outputs.
enum LineOutput : std::uint8_t {
    kLineEnable = 1U << 0,
    kLineWatchdog = 1U << 1,
    kLineLamp = 1U << 2,
};

enum class LinesState : std::uint8_t {
    stopped,    // a stop is active, or was active a moment ago
    waiting,    // all inputs permit; a person must re-arm
    permitted,  // the enable line follows the command
};

enum class LinesCause : std::uint8_t {
    none,
    lost,  // adapter, line or reading
    channels_disagree,
    emergency_stop,
    amplifier,  // its read-back does not follow the enable line
    dead_man,
    dropped,  // by drop()
};

enum class Lamp : std::uint8_t { dark, lit, blinking };

struct LinesInfo {
    std::string name;
    std::uint8_t inputs = 0;   // LineInput that are fitted
    std::uint8_t outputs = 0;  // LineOutput that are fitted
};

struct LinesSample {
    Instant taken_at{};
    std::uint64_t sequence = 0;  // rises with every poll
    std::uint64_t trips = 0;     // number of changes to stopped; a slow reader misses none
    LinesState state = LinesState::stopped;
    LinesCause cause = LinesCause::lost;  // present or last, until re-armed; none: not yet stable
    std::uint8_t inputs = 0;              // LineInput as read
    std::uint8_t outputs = 0;             // LineOutput as driven
};

struct LinesCommand {
    std::uint64_t heartbeat = 0;  // rises with every servo cycle; a change toggles the watchdog line
    std::uint64_t rearm = 0;      // rises when a person re-arms: waiting becomes permitted
    bool enable = false;
    Lamp lamp = Lamp::dark;
};

// Counters since open(); they only rise.
struct LinesHealth {
    bool up = false;  // the adapter is present
    std::uint64_t looks = 0;
    std::uint64_t errors = 0;  // of reading and writing
    std::uint64_t trips = 0;
    std::uint64_t drops = 0;    // requested by drop()
    std::uint64_t toggles = 0;  // of the watchdog line
    std::uint64_t losses = 0;   // times that the adapter vanished
    std::uint64_t reopened = 0;
};

class Lines {
public:
    virtual ~Lines() = default;
    virtual LinesInfo open() = 0;  // start-up; throws StartupError naming line, chip and fix
    // The newest sample; its age is now - taken_at. Before the first sample, returns false and leaves `newest` as is.
    virtual bool read(LinesSample& newest, Instant now) noexcept TACT_RT = 0;
    virtual void write(const LinesCommand& command, Instant now) noexcept TACT_RT = 0;
    // The enable line goes low within one poll period and stays low until re-armed.
    virtual void drop() noexcept TACT_RT = 0;
    [[nodiscard]] virtual LinesHealth health() const noexcept TACT_RT = 0;
};

}  // namespace tact
