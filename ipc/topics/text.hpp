// Texts for people for the topics' codes: panels, tables, logs.
//
// Input    untrusted: a value without an enumerator reads as "unknown".
#pragma once

#include <string>

#include "ipc/topics/command.hpp"
#include "ipc/topics/event.hpp"
#include "ipc/topics/health.hpp"
#include "ipc/topics/levels.hpp"
#include "ipc/topics/load.hpp"

namespace tact {

[[nodiscard]] const char* run_state_text(RunState state) noexcept;     // "active"
[[nodiscard]] const char* run_reason_text(RunReason reason) noexcept;  // "hand off the device"
// What a person does before resetting the fault: "Check the device's cable and power; tact probe lists the devices."
[[nodiscard]] const char* run_reason_fix(RunReason reason) noexcept;
[[nodiscard]] const char* lines_text(LinesShown lines) noexcept;           // "waiting for re-arming"
[[nodiscard]] const char* event_code_text(EventCode code) noexcept;        // "overrun"
[[nodiscard]] const char* level_reason_text(LevelReason reason) noexcept;  // "force rate below goal"
[[nodiscard]] const char* command_kind_text(CommandKind kind) noexcept;    // "arm"
[[nodiscard]] const char* command_result_text(CommandResult result) noexcept;
[[nodiscard]] const char* frame_part_text(FramePart part) noexcept;  // "upload"

// Codes of the head topic: TrackerState and TrackerLink of hal/api/tracker.hpp.
[[nodiscard]] const char* head_state_text(std::uint8_t state) noexcept;  // "fresh"
[[nodiscard]] const char* head_link_text(std::uint8_t link) noexcept;    // "bus off"

// One line with the event's numbers and their units: "overrun: 120 us late, 3 so far".
// With the levels, a path has its own name.
[[nodiscard]] std::string event_text(const EventTopic& event, const LevelsTopic* levels = nullptr);
// For an event fault_latched: its fix, with the order in which force comes back.
[[nodiscard]] std::string fault_fix(const EventTopic& event);
// Errors on a device's bus: "checksum 3, lost 12, connected again 1"; empty: none.
[[nodiscard]] std::string bus_text(const BusCounts& counts);
// "FIFO, pinned, memory locked", or "ordinary scheduling".
[[nodiscard]] std::string schedule_text(std::uint32_t schedule_flags);

}  // namespace tact
