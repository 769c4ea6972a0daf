#include "ipc/record/rows.hpp"

#include <type_traits>

namespace tact {
namespace {

template <class T>
constexpr Number number_of() {
    using N = std::remove_all_extents_t<T>;
    if constexpr (std::is_same_v<N, double>) return Number::f64;
    if constexpr (std::is_same_v<N, float>) return Number::f32;
    if constexpr (std::is_same_v<N, std::int64_t>) return Number::i64;
    if constexpr (std::is_same_v<N, std::uint64_t>) return Number::u64;
    if constexpr (std::is_same_v<N, std::uint32_t>) return Number::u32;
    if constexpr (std::is_same_v<N, std::uint16_t>) return Number::u16;
    return Number::u8;
}

// A column for a member under its own name; an array member becomes one wide column.
#define TACT_COLUMN(Row, member, what)                                                  \
    Column {                                                                            \
#member, number_of < decltype(Row::member)>(), offsetof(Row, member),           \
            std::extent_v < decltype(Row::member)>> 0                                   \
            ? static_cast < std::uint32_t>(std::extent_v <decltype(Row::member)>) : 1U, \
            what                                                                        \
    }

constexpr std::size_t in_hand(std::size_t offset) { return offsetof(HandRow, t) + offset; }
constexpr std::size_t in_order(std::size_t offset) { return offsetof(MailboxTopic, order) + offset; }
constexpr std::size_t in_said(std::size_t offset) { return offsetof(ReportTopic, said) + offset; }

static_assert(offsetof(HandTopic, quat_dev_tool_xyzw) == offsetof(HandTopic, pos_dev_m) + 24);
static_assert(offsetof(HandTopic, angular_dev_rad_s) == offsetof(HandTopic, velocity_dev_m_s) + 24);
static_assert(offsetof(HandTopic, torque_world_n_m) == offsetof(HandTopic, force_world_n) + 24);
static_assert(offsetof(HandTopic, torque_model_world_n_m) == offsetof(HandTopic, force_model_world_n) + 24);
static_assert(offsetof(HandRow, quat_world_tool_xyzw) == offsetof(HandRow, pos_world_m) + 24);
static_assert(offsetof(BodyRow, quat_model_body_xyzw) == offsetof(BodyRow, pos_model_m) + 24);
static_assert(offsetof(ServoOrder, quat_model_body_xyzw) == offsetof(ServoOrder, pos_model_m) + 24);

constexpr std::array kCycle{
    TACT_COLUMN(
        CycleTopic, step,
        "number of the cycle from 1, including dry ones; key of /cycles, /hand0, /hand1, /mailbox, /reports"),
    TACT_COLUMN(CycleTopic, cycle, "cycle of the loop from 1; dry cycles have their own count"),
    TACT_COLUMN(CycleTopic, clock_ns, "the servo's readings of the monotonic clock"),
    TACT_COLUMN(CycleTopic, now_ns, "time that the cycle uses"),
    TACT_COLUMN(CycleTopic, lateness_ns, "lateness of the cycle's start"),
    TACT_COLUMN(CycleTopic, cost_ns, "duration of the whole cycle"),
    TACT_COLUMN(CycleTopic, model_ns, "duration of the force models' steps"),
    TACT_COLUMN(CycleTopic, level, "level of the haptic path, 0 to 1"),
    Column{"work_fraction", Number::f32, offsetof(CycleTopic, work_fraction), 1,
           "fraction of the level's work to recompute, 0 to 1", "share"},
    TACT_COLUMN(CycleTopic, lines_taken_at_ns, "time of the safety line sample; valid if flags contains 2"),
    TACT_COLUMN(CycleTopic, lines_sequence, ""),
    TACT_COLUMN(CycleTopic, lines_trips, ""),
    TACT_COLUMN(CycleTopic, lines_state, ""),
    TACT_COLUMN(CycleTopic, lines_cause, ""),
    TACT_COLUMN(CycleTopic, lines_inputs, ""),
    TACT_COLUMN(CycleTopic, lines_outputs, ""),
    TACT_COLUMN(CycleTopic, run_state, "0 off, 1 ready, 2 armed, 3 active, 4 fault"),
    TACT_COLUMN(CycleTopic, run_reason, "reason of a fault"),
    TACT_COLUMN(CycleTopic, flags, "1: dry, before the start; 2: safety inputs were read"),
    Column{"timestamps", Number::u8, offsetof(CycleTopic, timestamps), 1, "number of values in clock_ns",
           "looks"},
};

constexpr std::array kHand{
    Column{"step", Number::u64, in_hand(offsetof(HandTopic, step)), 1, "key of /cycles"},
    Column{"taken_at_ns", Number::i64, in_hand(offsetof(HandTopic, taken_at_ns)), 1,
           "time of the device's measurement"},
    Column{"sequence", Number::u64, in_hand(offsetof(HandTopic, sequence)), 1,
           "sequence number of the device's samples"},
    Column{"pose_world", Number::f64, offsetof(HandRow, pos_world_m), 7,
           "pose of the tool: x y z in m, quaternion x y z w"},
    Column{"wrench_world", Number::f64, in_hand(offsetof(HandTopic, force_world_n)), 6,
           "sent to the device, at the tool: force in N, torque in N m"},
    Column{"wrench_model", Number::f64, in_hand(offsetof(HandTopic, force_model_world_n)), 6,
           "output of the force model, world axes: force in N, torque in N m"},
    Column{"pose_dev", Number::f64, in_hand(offsetof(HandTopic, pos_dev_m)), 7,
           "pose from the device: x y z in m, quaternion x y z w"},
    Column{"twist_dev", Number::f64, in_hand(offsetof(HandTopic, velocity_dev_m_s)), 6,
           "twist from the device: m/s, rad/s"},
    Column{"delay_ns", Number::i64, in_hand(offsetof(HandTopic, delay_ns)), 1,
           "delay from sample to motor; 0: unknown"},
    Column{"model_error_n", Number::f32, in_hand(offsetof(HandTopic, model_error_n)), 1,
           "bound of the force error"},
    Column{"items", Number::u32, in_hand(offsetof(HandTopic, items)), 1, "points, blocks or moves evaluated"},
    Column{"buttons", Number::u32, in_hand(offsetof(HandTopic, buttons)), 1, "1: clutch; 2: drives the tool"},
    Column{"deadline_check", Number::u32, in_hand(offsetof(HandTopic, deadline_check)), 1,
           "number of the deadline check that found the step's deadline passed; 0: none", "deadline_look"},
    Column{"read_status", Number::u8, in_hand(offsetof(HandTopic, read_status)), 1,
           "0 ok, 1 stale, 2 lost, 3 fault"},
    Column{"write_status", Number::u8, in_hand(offsetof(HandTopic, write_status)), 1,
           "0 ok, 1 stale, 2 lost, 3 fault"},
    Column{"hand_present", Number::u8, in_hand(offsetof(HandTopic, hand_present)), 1, "0 or 1"},
    Column{"device_state", Number::u8, in_hand(offsetof(HandTopic, device_state)), 1,
           "0 closed, 1 ready, 2 powered, 3 watchdog tripped, 4 fault"},
    Column{"notice", Number::u8, in_hand(offsetof(HandTopic, notice)), 1,
           "DeviceNotice: required action, or reason of zero force"},
    Column{"step_status", Number::u8, in_hand(offsetof(HandTopic, step_status)), 1,
           "status of the model: 0 ok, 1 out of time, 2 out of range"},
    Column{"at_wall", Number::u8, in_hand(offsetof(HandTopic, at_wall)), 1,
           "1: a wall of the workspace exerts force"},
};

constexpr std::array kMailbox{
    TACT_COLUMN(MailboxTopic, step, "step in which the servo took the order"),
    TACT_COLUMN(MailboxTopic, kind,
                "1 order, 2 model taken, 3 build refused, 4 stop, 5 drops of the supervisor"),
    Column{"sequence", Number::u64, in_order(offsetof(ServoOrder, sequence)), 1,
           "sequence number of the command"},
    Column{"value", Number::f64, in_order(offsetof(ServoOrder, value)), 1, ""},
    Column{"order", Number::u32, in_order(offsetof(ServoOrder, kind)), 1, "CommandKind"},
    Column{"index", Number::u32, in_order(offsetof(ServoOrder, index)), 1, "path or law"},
    Column{"body", Number::u32, in_order(offsetof(ServoOrder, body)), 1, "id or structure"},
    Column{"pose_model", Number::f64, in_order(offsetof(ServoOrder, pos_model_m)), 7,
           "pose of the body: x y z in m, quaternion x y z w"},
};

#define TACT_SAID(member)                                             \
    Column {                                                          \
#member, number_of < decltype(HousekeepingReport::member)>(), \
            in_said(offsetof(HousekeepingReport, member)), 1, ""      \
    }
constexpr std::array kReport{
    TACT_COLUMN(ReportTopic, step, "step in which the servo took the report"),
    TACT_SAID(gui_heartbeat_ns),
    TACT_SAID(gui_generation),
    TACT_SAID(bad_input),
    TACT_SAID(page_faults),
    TACT_SAID(gui_fps),
    TACT_SAID(gui_busy_s),
    TACT_SAID(gui_frame),
    TACT_SAID(gui_levels_sequence),
    TACT_SAID(gui_taken_at_ns),
    TACT_SAID(gui_work_s),
    TACT_SAID(gui_cpu_s),
    TACT_SAID(gui_vertices),
    TACT_SAID(gui_vertices_max),
    TACT_SAID(gui_particles_max),
    TACT_SAID(gui_attached),
    TACT_SAID(gui_particles_s),
    TACT_SAID(gui_mesh_s),
    TACT_SAID(gui_volume_s),
    TACT_SAID(gui_molecules_s),
    TACT_SAID(gui_resolution_s),
    TACT_SAID(gui_molecules_max),
    TACT_SAID(gui_pixels_max),
    TACT_SAID(gui_refined),
};
#undef TACT_SAID

constexpr std::array kEvent{
    TACT_COLUMN(EventTopic, taken_at_ns, "monotonic clock"),
    TACT_COLUMN(EventTopic, cycle, "cycle of the loop"),
    TACT_COLUMN(EventTopic, code, "EventCode; names are in the attribute codes of /events"),
    TACT_COLUMN(EventTopic, a, "value; meaning depends on code"),
    TACT_COLUMN(EventTopic, b, "value; meaning depends on code"),
};

constexpr std::array kLevels{
    TACT_COLUMN(LevelsRow, taken_at_ns, "monotonic clock"),
    TACT_COLUMN(LevelsRow, sequence, "rises with every change"),
    TACT_COLUMN(LevelsRow, goal_hz, "target rate of the governor"),
    TACT_COLUMN(LevelsRow, rate_hz, "last rate that the law used"),
    TACT_COLUMN(LevelsRow, level, "level of each path, 0 to 1; names are in the attribute paths of /levels"),
};

constexpr std::array kHealth{
    TACT_COLUMN(HealthRow, taken_at_ns, "monotonic clock"),
    TACT_COLUMN(HealthRow, cycle, ""),
    TACT_COLUMN(HealthRow, force_rate_hz, ""),
    TACT_COLUMN(HealthRow, lateness_p50_ns, "median lateness in the last second"),
    TACT_COLUMN(HealthRow, lateness_p99_ns, ""),
    TACT_COLUMN(HealthRow, lateness_max_ns, ""),
    TACT_COLUMN(HealthRow, cycle_cost_p50_ns, ""),
    TACT_COLUMN(HealthRow, cycle_cost_max_ns, ""),
    TACT_COLUMN(HealthRow, overruns, "number of overruns since the start"),
    TACT_COLUMN(HealthRow, skipped, ""),
    TACT_COLUMN(HealthRow, allocations, ""),
    TACT_COLUMN(HealthRow, locks, ""),
    TACT_COLUMN(HealthRow, page_faults, ""),
    TACT_COLUMN(HealthRow, bad_input, ""),
    TACT_COLUMN(HealthRow, gui_fps, ""),
    TACT_COLUMN(HealthRow, gui_vertices, ""),
    TACT_COLUMN(HealthRow, state, "0 off, 1 ready, 2 armed, 3 active, 4 fault"),
    TACT_COLUMN(HealthRow, reason, ""),
    TACT_COLUMN(HealthRow, device_state, ""),
    TACT_COLUMN(HealthRow, gui_attached, ""),
};

constexpr std::array kBody{
    TACT_COLUMN(BodyRow, taken_at_ns, "monotonic clock"),
    TACT_COLUMN(BodyRow, cycle, ""),
    Column{"pose_model", Number::f64, offsetof(BodyRow, pos_model_m), 7,
           "pose of the centre of mass: x y z in m, quaternion x y z w"},
    TACT_COLUMN(BodyRow, id, "number from 1, never reused"),
    TACT_COLUMN(BodyRow, structure, "index in the scene"),
    TACT_COLUMN(BodyRow, flags, "1: fixed"),
};

constexpr std::array kDrop{
    TACT_COLUMN(DropRow, noticed_at_ns, "monotonic clock"),
    TACT_COLUMN(DropRow, ring, "0 cycles, 1 hand 0, 2 hand 1, 3 mailbox, 4 reports, 5 events"),
    TACT_COLUMN(DropRow, records, "number of records lost because the recorder was too slow"),
};
#undef TACT_COLUMN

}  // namespace

std::span<const Column> cycle_columns() { return kCycle; }
std::span<const Column> hand_columns() { return kHand; }
std::span<const Column> mailbox_columns() { return kMailbox; }
std::span<const Column> report_columns() { return kReport; }
std::span<const Column> event_columns() { return kEvent; }
std::span<const Column> levels_columns() { return kLevels; }
std::span<const Column> health_columns() { return kHealth; }
std::span<const Column> body_columns() { return kBody; }
std::span<const Column> drop_columns() { return kDrop; }

}  // namespace tact
