// Good, worth a look, or bad, and why in words: what the panels show in colour is always said as well.
//
// Pure functions of what the controller published, so that tests can state every border.
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

// 5 % below the goal is worth a look, 15 % is bad.
[[nodiscard]] StatusText rate_status(double rate_hz, double goal_hz);
// Against the period: a tenth late at the 99th percentile is worth a look, half is bad. Free running: 1 ms
// counts.
[[nodiscard]] StatusText lateness_status(std::int64_t p99_ns, std::int64_t period_ns);
// Of a step's work, what is done anew on average: below 95 % is worth a look, below half is bad.
[[nodiscard]] StatusText recomputed_status(float mean);
// now_ns: to tell how long the last one is ago. One in a thousand cycles is bad.
[[nodiscard]] StatusText overrun_status(const HealthTopic& health, std::int64_t now_ns);
[[nodiscard]] StatusText state_status(RunState state, RunReason reason);
// What stands over the picture while something stops the force: why, and what a person is to do. No words: nothing stops it.
struct StopNotice {
    Grade grade = Grade::unknown;
    std::string why, fix;
};
[[nodiscard]] StopNotice stop_notice(const HealthTopic& health);
// Allocations, locks and page faults inside servo cycles: there should be none.
[[nodiscard]] StatusText memory_status(const HealthTopic& health);
// From a burr to a structure to keep away from: 1 mm is bad, 2 mm is worth a look, and so is being at 1 mm within a second.
[[nodiscard]] StatusText distance_status(double distance_m, double closing_m_s, bool turns);
// Of the hand on a burr; above 2 N is worth a look. excess_s: how long it was so, drilling.
[[nodiscard]] StatusText force_status(double force_n, double excess_s);
[[nodiscard]] const char* device_state_text(std::uint8_t device_state) noexcept;
// What a device asks for is worth a look, what keeps it from showing force is bad.
[[nodiscard]] Grade notice_grade(DeviceNotice notice) noexcept;
// What ever was wrong on it is worth a look; whether it still is, its notice says.
[[nodiscard]] StatusText bus_status(const BusCounts& counts);
[[nodiscard]] Grade device_grade(std::uint8_t device_state) noexcept;
// A hand's device: its state, what its last read gave, what its bus counted and what it says, the worst of them.
[[nodiscard]] StatusText device_status(const DeviceHand& device, const BusCounts& bus, DeviceNotice notice);
// From 80 % of what the motors stand for ever the force is held back, from all of it on little is left.
[[nodiscard]] StatusText motor_status(const DeviceHand& device);
[[nodiscard]] StatusText tracker_status(const TrackerTopic& tracker);
// What of a tracker's frames was wrong: "missed 3, refused 1"; empty: nothing.
[[nodiscard]] std::string tracker_counts_text(const TrackerTopic& tracker);
// 10 % below its goal is worth a look, 40 % is bad. No goal: 20 pictures a second are what an eye takes for motion.
[[nodiscard]] StatusText display_status(double fps, double goal_hz);

}  // namespace tact
