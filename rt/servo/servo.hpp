// The servo loop: runs the stages (rt/servo/stage_*.hpp) in order, at a fixed rate or as fast as the processor allows.
//
// Runs on   the servo thread; in tests and replays on any thread, with a ManualClock
// Owns      the CycleState; borrows everything in ServoParts
// Writes    the region "tact.rt" except topics of other threads; each model publishes its own topic there
// Fails by  zero force and a latched fault (rt/safety); the loop goes on
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
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
    Lines* lines = nullptr;               // null: no safety inputs
    const CycleScript* script = nullptr;  // replay only; read in every cycle
};

class Servo {
public:
    Servo(const ServoParts& parts, const ServoSettings& settings);
    Servo(const Servo&) = delete;
    Servo& operator=(const Servo&) = delete;

    // Before warm_up(): from the first regular cycle on, the law "fixed" and this level of a path. As Governor::set_level().
    void start_at_level(std::size_t path, double level) noexcept {
        if (path < start_levels_.size()) start_levels_[path] = level;
    }
    // Runs dry cycles with the gate closed, which warm caches and measure costs; then calls start().
    void warm_up() noexcept;
    // The parts of warm_up(), for replays: one dry cycle; reset of counters and state ready at `now`.
    void dry_cycle() noexcept;
    void start(Instant now) noexcept;
    void cycle() noexcept TACT_RT;
    // Runs cycles until a stop signal has led to zero force and the amplifier is off.
    void run() noexcept;

    [[nodiscard]] bool finished() const noexcept { return c_.finished; }
    [[nodiscard]] const CycleState& state() const noexcept { return c_; }
    [[nodiscard]] const Governor& governor() const noexcept { return c_.governor; }
    void set_schedule_flags(std::uint32_t flags) noexcept { c_.report.schedule_flags = flags; }
    // Publishes the last health and lateness; called by the servo thread after its last cycle.
    void publish_end(std::uint64_t page_faults) noexcept;

private:
    ServoIo io_;
    ServoSettings settings_;
    StartTopic start_topic_;  // without the start time
    std::array<std::optional<double>, Governor::kPathsMax> start_levels_{};
    CycleState c_;
};

}  // namespace tact
