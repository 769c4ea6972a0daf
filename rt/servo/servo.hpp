// The servo loop: one cycle of pure stages (rt/servo/stage_*.hpp), at a fixed rate or as often as the processor allows.
//
// Runs on   the servo thread; in tests and replays on any thread, in lockstep with a ManualClock
// Owns      the CycleState; borrows everything in ServoParts
// Writes    the region "tact.rt", but for the topics of other threads; each model publishes its own topic there
// Fails by  going to zero force and latching a fault (rt/safety); it never stops by itself
#pragma once

#include <cstdint>
#include <span>

#include "rt/servo/cycle.hpp"
#include "rt/servo/servo_io.hpp"
#include "rt/servo/servo_settings.hpp"

namespace tact {

struct ServoParts {
    Clock& clock;
    std::span<const HandParts> hands;  // 1 or 2
    RtRegion& region;
    ServoMailbox& mailbox;
    Lines* lines = nullptr;               // null: none are fitted
    const CycleScript* script = nullptr;  // of a replay, read in every cycle
};

class Servo {
public:
    Servo(const ServoParts& parts, const ServoSettings& settings);
    Servo(const Servo&) = delete;
    Servo& operator=(const Servo&) = delete;

    // Cycles with the gate closed that warm caches and pages; then counters from zero, state ready.
    void warm_up() noexcept;
    // Its parts, for a replay: one such cycle; the start at an instant.
    void dry_cycle() noexcept;
    void start(Instant now) noexcept;
    void cycle() noexcept TACT_RT;
    // Until the stop signal has led to zero force and the amplifier is off.
    void run() noexcept;

    [[nodiscard]] bool finished() const noexcept { return c_.finished; }
    [[nodiscard]] const CycleState& state() const noexcept { return c_; }
    [[nodiscard]] const Governor& governor() const noexcept { return c_.governor; }
    void set_schedule_flags(std::uint32_t flags) noexcept { c_.report.schedule_flags = flags; }
    // For the last health, read by the servo thread itself after its last cycle.
    void publish_end(std::uint64_t page_faults) noexcept;

private:
    ServoIo io_;
    ServoSettings settings_;
    StartTopic start_topic_;  // but for the instant
    CycleState c_;
};

}  // namespace tact
