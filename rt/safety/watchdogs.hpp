// The watchdogs of the loop: device, age of the sample, timing, value of the force, safety inputs.
//
// Runs on   servo thread, every cycle, constant time
// Owns      the number of consecutive overruns; no other state
// Fails by  returning a reason and the measured value; rt/safety/state_machine.hpp reacts
#pragma once

#include <cstdint>

#include "ipc/base/clock.hpp"
#include "ipc/base/rt.hpp"
#include "ipc/base/run_state.hpp"

namespace tact {

struct WatchdogSettings {
    Duration sample_age_max =
        std::chrono::microseconds(3500);  // tolerates three missed samples at 1 kHz, not four
    Duration late_max = std::chrono::milliseconds(5);
    std::uint32_t overruns_warned = 3;  // consecutive
    std::uint32_t overruns_max = 5;     // consecutive
    bool timing_latches = true;         // false: lateness and overruns only cause warnings
    // A tripped watchdog of the device latches; false only for emulated devices.
    bool device_watchdog_latches = true;
};

struct WatchdogInput {
    Instant now{};
    Instant sample_taken_at{};
    Duration lateness{0};  // of this cycle
    bool overran = false;  // of the last cycle
    bool device_lost = false;
    bool device_fault = false;
    bool force_finite = true;
    RunReason lines = RunReason::none;  // stop requested by the safety inputs
    Duration lines_age{0};
    bool supervisor = false;  // the supervisor has dropped the enable line
};

struct Trip {
    RunReason reason = RunReason::none;
    double measured = 0.0;  // microseconds or a count, depending on the reason
};

class Watchdogs {
public:
    explicit Watchdogs(const WatchdogSettings& settings = {}) noexcept : settings_(settings) {}

    Trip check(const WatchdogInput& in) noexcept TACT_RT {
        overruns_in_a_row_ = in.overran ? overruns_in_a_row_ + 1 : 0;
        // A released pedal is no fault while the amplifier is off, so it must not mask another fault.
        const bool mild = in.lines == RunReason::dead_man || in.lines == RunReason::supervisor;
        if (in.lines != RunReason::none && !mild) return {in.lines, to_us(in.lines_age)};
        if (in.device_lost) return {RunReason::device_lost, 0.0};
        if (in.device_fault) return {RunReason::device_fault, 0.0};
        if (!in.force_finite) return {RunReason::force_not_finite, 0.0};
        const Duration age = in.now - in.sample_taken_at;
        if (age > settings_.sample_age_max) return {RunReason::sample_stale, to_us(age)};
        if (mild) return {in.lines, to_us(in.lines_age)};
        if (in.supervisor) return {RunReason::supervisor, to_us(in.lateness)};
        if (!settings_.timing_latches) return {};
        if (in.lateness > settings_.late_max) return {RunReason::too_late, to_us(in.lateness)};
        if (overruns_in_a_row_ >= settings_.overruns_max) {
            return {RunReason::overruns, static_cast<double>(overruns_in_a_row_)};
        }
        return {};
    }
    [[nodiscard]] bool warns() const noexcept { return overruns_in_a_row_ == settings_.overruns_warned; }
    [[nodiscard]] std::uint32_t overruns_in_a_row() const noexcept { return overruns_in_a_row_; }
    void forget() noexcept { overruns_in_a_row_ = 0; }

private:
    WatchdogSettings settings_;
    std::uint32_t overruns_in_a_row_ = 0;
};

}  // namespace tact
