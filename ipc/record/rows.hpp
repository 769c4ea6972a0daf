// Tables of a recording: rows and columns. See RECORDING.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "ipc/record/hdf5_file.hpp"
#include "ipc/topics/event.hpp"
#include "ipc/topics/levels.hpp"
#include "ipc/topics/record.hpp"

namespace tact {

// A hand in one step; pose_world is computed from the device's pose.
struct HandRow {
    HandTopic t;
    double pos_world_m[3];
    double quat_world_tool_xyzw[4];
};

// The governor's levels after a change.
struct LevelsRow {
    std::int64_t taken_at_ns;
    std::uint64_t sequence;
    double goal_hz, rate_hz;
    float level[kPathsMax];  // by the names in /levels
};

// Ten times per second.
struct HealthRow {
    std::int64_t taken_at_ns;
    std::uint64_t cycle;
    double force_rate_hz;
    std::int64_t lateness_p50_ns, lateness_p99_ns, lateness_max_ns;  // of the last second
    std::int64_t cycle_cost_p50_ns, cycle_cost_max_ns;
    std::uint64_t overruns, skipped, allocations, locks, page_faults, bad_input;  // so far
    double gui_fps;
    std::uint32_t gui_vertices;
    std::uint8_t state, reason, device_state, gui_attached;
};

// A placed structure after a motion; up to fifty times per second.
struct BodyRow {
    std::int64_t taken_at_ns;
    std::uint64_t cycle;
    double pos_model_m[3];
    double quat_model_body_xyzw[4];
    std::uint32_t id;
    std::uint16_t structure, flags;
};

enum class RecordRing : std::uint32_t { cycles, hand0, hand1, mailbox, reports, events };

// Records lost because the recorder was too slow.
struct DropRow {
    std::int64_t noticed_at_ns;
    std::uint32_t ring;  // RecordRing
    std::uint32_t reserved;
    std::uint64_t records;
};

// Columns and groups of the tables; hand groups are "/hand0" and "/hand1".
[[nodiscard]] std::span<const Column> cycle_columns();
[[nodiscard]] std::span<const Column> hand_columns();
[[nodiscard]] std::span<const Column> mailbox_columns();
[[nodiscard]] std::span<const Column> report_columns();
[[nodiscard]] std::span<const Column> event_columns();
[[nodiscard]] std::span<const Column> levels_columns();
[[nodiscard]] std::span<const Column> health_columns();
[[nodiscard]] std::span<const Column> body_columns();
[[nodiscard]] std::span<const Column> drop_columns();

inline constexpr const char* kCyclesGroup = "/cycles";
inline constexpr std::array kHandGroups{"/hand0", "/hand1"};
inline constexpr const char* kMailboxGroup = "/mailbox";
inline constexpr const char* kFormerMailboxGroup = "/mail";  // before 2026-11-25
inline constexpr const char* kReportsGroup = "/reports";
inline constexpr const char* kEventsGroup = "/events";
inline constexpr const char* kLevelsGroup = "/levels";
inline constexpr const char* kHealthGroup = "/health";
inline constexpr const char* kBodiesGroup = "/bodies";
inline constexpr const char* kDropsGroup = "/drops";

// The group of the mailbox in a file, under its present or former name.
[[nodiscard]] inline const char* mailbox_group(Hdf5Id file) {
    return Hdf5Table::exists(file, kMailboxGroup) ? kMailboxGroup : kFormerMailboxGroup;
}

}  // namespace tact
