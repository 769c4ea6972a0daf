// Status grades (good, watch, bad) with a reason in text, so that no panel relies on colour alone.
//
// Pure functions of what the controller published, so that tests can check every threshold.
#pragma once

#include <cstdint>
#include <string>

#include "ipc/base/device_notice.hpp"
#include "ipc/topics/device.hpp"
#include "ipc/topics/head.hpp"
#include "ipc/topics/health.hpp"

namespace tact {

enum class Grade : std::uint8_t { unknown, good, watch, bad };

struct StatusText {
    Grade grade = Grade::unknown;
    std::string text;
};

[[nodiscard]] std::string ago_text(double seconds);          // "12 s ago", "3 min ago"
[[nodiscard]] const char* grade_text(Grade grade) noexcept;  // "good", "watch", "bad", "unknown"

// Watch from 0.25 % below the goal, so a single late cycle of a few periods shows; bad from 15 %.
[[nodiscard]] StatusText rate_status(double rate_hz, double goal_hz);
// Relative to the period: watch from a tenth at the 99th percentile, bad from half. Free running: relative to 1 ms.
[[nodiscard]] StatusText lateness_status(std::int64_t p99_ns, std::int64_t period_ns);
// Mean recomputed fraction of a step's work: watch below 95 %, bad below half.
[[nodiscard]] StatusText recomputed_status(float mean);
// now_ns gives the age of the last overrun. Bad from one in a thousand cycles.
[[nodiscard]] StatusText overrun_status(const HealthTopic& health, std::int64_t now_ns);
// Of the force model's steps.
[[nodiscard]] StatusText deadline_status(const HealthTopic& health, std::int64_t now_ns);
[[nodiscard]] StatusText state_status(RunState state, RunReason reason);
// Notice over the 3D view while something stops the force: the cause and the fix. Empty texts: nothing stops it.
struct StopNotice {
    Grade grade = Grade::unknown;
    std::string why, fix;
};
[[nodiscard]] StopNotice stop_notice(const HealthTopic& health);
// Allocations, locks and page faults inside servo cycles: there should be none.
[[nodiscard]] StatusText memory_status(const HealthTopic& health);
// Burr to critical structure: bad below 1 mm; watch below 2 mm, or if it will be at 1 mm within a second.
[[nodiscard]] StatusText distance_status(double distance_m, double closing_m_s, bool turns);
// Hand force on a burr; watch above 2 N. excess_s: time above it while drilling.
[[nodiscard]] StatusText force_status(double force_n, double excess_s);
[[nodiscard]] const char* device_state_text(std::uint8_t device_state) noexcept;
// Watch if a device needs attention, bad if it cannot produce force.
[[nodiscard]] Grade notice_grade(DeviceNotice notice) noexcept;
// Watch if there was ever an error; the device notice shows whether it persists.
[[nodiscard]] StatusText bus_status(const BusCounts& counts);
[[nodiscard]] Grade device_grade(std::uint8_t device_state) noexcept;
// The worst of a device's state, last read, bus counters and notice.
[[nodiscard]] StatusText device_status(const DeviceHand& device, const BusCounts& bus, DeviceNotice notice);
// From 80 % of the motors' continuous limit the force is reduced; from 100 % little of it remains.
[[nodiscard]] StatusText motor_status(const DeviceHand& device);
[[nodiscard]] StatusText tracker_status(const TrackerTopic& tracker);
// Errors in a tracker's frames: "missed 3, refused 1"; empty: none.
[[nodiscard]] std::string tracker_counts_text(const TrackerTopic& tracker);
// Watch from 10 % below the goal, bad from 40 %. Without a goal: 20 frames a second, the least that appears as
// motion.
[[nodiscard]] StatusText display_status(double fps, double goal_hz);

}  // namespace tact
