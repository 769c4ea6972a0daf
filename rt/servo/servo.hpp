// The servo loop: one cycle of eight stages, at a fixed rate or as often as the processor allows.
//
// Runs on   the servo thread; in tests and replays on any thread, in lockstep with a ManualClock
// Owns      the arena with the CycleState, the governor, the statistics; borrows everything in ServoParts
// Writes    the region "tact.rt": it is the only writer of every topic in it
// Fails by  going to zero force and latching a fault (rt/safety); it never stops by itself
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "hal/api/haptic_device.hpp"
#include "hal/api/lines.hpp"
#include "ipc/base/arena.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/pacer.hpp"
#include "ipc/topics/regions.hpp"
#include "rt/force/force_model.hpp"
#include "rt/govern/display_watch.hpp"
#include "rt/govern/governor.hpp"
#include "rt/govern/rate_hold.hpp"
#include "rt/servo/cycle.hpp"
#include "rt/servo/mailbox.hpp"
#include "rt/servo/statistics.hpp"

namespace tact {

// What says that a tool is to be driven.
enum class Pedal : std::uint8_t {
    button,  // the second one of the stylus that holds the tool
    line,    // a foot pedal on one of the lines (hal/api/lines.hpp): on or off
    always,  // while the force is on
};

// Of drilling: the burr is in the first hand, the suction tube in the second.
struct DrivesSettings {
    double burr_rad_s = 0.0;  // while its pedal is pressed
    Pedal burr = Pedal::button;
    double irrigation_m3_s = 0.0;  // of water on the burr while it turns
    bool irrigation_always = false;
    double suction_m3_s = 0.0;
    Pedal suction = Pedal::button;
};

struct ServoSettings {
    Duration period = std::chrono::milliseconds(1);
    bool free_running = false;
    Duration model_max = std::chrono::microseconds(600);  // of the model's step; the net beneath its level
    bool model_deadline = true;                           // false with a clock that is not the machine's
    double force_scale = 1.0;
    double damping_n_s_m = 0.0;       // of the coupling, against the tool's velocity
    double hand_damping_n_s_m = 3.0;  // of hand and arm: what stiffness is stable at a delay hangs on it
    Pose T_world_dev;
    DrivesSettings drives;
    bool bone = false;  // the scene is of bone: its picture has particles
    WatchdogSettings watchdogs;
    ChainSettings chain;
    GovernorSettings governor;
    Duration governor_interval = std::chrono::milliseconds(100);
    Duration gui_silent = std::chrono::milliseconds(500);
    bool gui_silent_ramps = false;  // else it is only said
    std::uint32_t dry_cycles = 1000;
    bool emulated = false;                                   // nobody's hand is on the device
    Duration lines_age_max = std::chrono::milliseconds(20);  // of their newest look
};

struct HandParts {
    HapticDevice* device;
    ForceModel* model;
    DeviceInfo info;
};

// Of a cycle that is done again: what cannot be asked twice.
struct CycleScript {
    float level = 1.0F;                                     // of the haptic path
    std::array<std::uint32_t, kHandsMax> deadline_check{};  // that found the deadline passed; 0: none
};

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

    [[nodiscard]] bool finished() const noexcept { return finished_; }
    [[nodiscard]] const CycleState& state() const noexcept { return *c_; }
    [[nodiscard]] const Governor& governor() const noexcept { return governor_; }
    [[nodiscard]] const ServoStatistics& statistics() const noexcept { return statistics_; }
    [[nodiscard]] const Pacer& pacer() const noexcept { return pacer_; }
    void set_schedule_flags(std::uint32_t flags) noexcept { schedule_flags_ = flags; }
    // For the last health, read by the servo thread itself after its last cycle.
    void publish_end(std::uint64_t page_faults) noexcept;

    static constexpr std::size_t kMeshIndex = kDisplayPathIndex;
    static constexpr std::size_t kForceIndex = kForcePathIndex;
    static constexpr std::size_t kParticlesIndex = kParticlesPathIndex;  // settings.bone

private:
    // The stages, in order.
    void wake(CycleState& c) noexcept TACT_RT;
    void sense(CycleState& c) noexcept TACT_RT;
    void pose(CycleState& c) noexcept TACT_RT;
    void model(CycleState& c) noexcept TACT_RT;
    void shape(CycleState& c) noexcept TACT_RT;
    void safety(CycleState& c) noexcept TACT_RT;
    void actuate(CycleState& c) noexcept TACT_RT;
    void publish(CycleState& c) noexcept TACT_RT;
    void govern(CycleState& c) noexcept TACT_RT;
    void close(CycleState& c) noexcept TACT_RT;
    [[nodiscard]] Instant timestamp() noexcept TACT_RT;

    // For recordings (servo_record.cpp).
    void introduce(const ServoParts& parts) noexcept;
    void publish_cycle(const CycleState& c, bool dry) noexcept TACT_RT;
    void record_mailbox(MailboxKind kind, const ServoOrder& order) noexcept TACT_RT;

    // Parts of stages: mail in and out (servo_mailbox.cpp), safety lines (servo_lines.cpp), topics out
    // (servo_publish.cpp), bounds by the delay (servo_shape.cpp).
    void take_model(CycleState& c) noexcept TACT_RT;
    void ask_for_model(CycleState& c) noexcept TACT_RT;
    void read_mailbox(CycleState& c) noexcept TACT_RT;
    void apply(CycleState& c, const ServoOrder& order) noexcept TACT_RT;
    [[nodiscard]] bool order_bodies(CycleState& c, const ServoOrder& order) noexcept TACT_RT;
    void tell_bodies(CycleState& c, const ModelBodies& before) noexcept TACT_RT;
    void acknowledge(const ServoOrder& order, CommandResult result) noexcept TACT_RT;
    void answer_state_order(CycleState& c, RunState before) noexcept TACT_RT;
    void check_lines(CycleState& c) noexcept TACT_RT;
    [[nodiscard]] RunReason lines_stop(const CycleState& c) const noexcept TACT_RT;
    [[nodiscard]] bool supervisor_dropped(CycleState& c) noexcept TACT_RT;
    void rearm_lines(CycleState& c, RunState before) noexcept TACT_RT;
    void drive_lines(CycleState& c) noexcept TACT_RT;
    void note_fault(const CycleState& c) noexcept TACT_RT;
    void report(EventCode code, double a, double b, std::uint16_t detail = 0) noexcept TACT_RT;
    void report_limits(CycleState& c, HandCycle& h) noexcept TACT_RT;
    void bound_by_delay() noexcept TACT_RT;
    void smooth_gains(HandCycle& h, double dt_s) noexcept TACT_RT;
    void report_notice(HandCycle& h, std::uint32_t hand) noexcept TACT_RT;
    void publish_touch(const CycleState& c) noexcept TACT_RT;
    void publish_drill(const CycleState& c) noexcept TACT_RT;
    void publish_tools(const CycleState& c) noexcept TACT_RT;
    void publish_health(const CycleState& c) noexcept TACT_RT;
    void publish_devices(CycleState& c) noexcept TACT_RT;
    void publish_lateness(const CycleState& c) noexcept TACT_RT;
    void publish_levels(const CycleState& c) noexcept TACT_RT;
    void publish_trace(const CycleState& c) noexcept TACT_RT;
    [[nodiscard]] double rate_for_law(Duration interval) const noexcept TACT_RT;
    [[nodiscard]] double rate_kept_up(const CycleState& c, double rate_hz) const noexcept TACT_RT;
    void read_pedals(CycleState& c) noexcept TACT_RT;
    [[nodiscard]] bool pressed(const CycleState& c, Pedal pedal, std::uint32_t hand,
                               LineInput line) const noexcept TACT_RT;
    [[nodiscard]] bool holds_rate() const noexcept TACT_RT;
    [[nodiscard]] Instant rest() noexcept TACT_RT;
    [[nodiscard]] double work_fraction_of_step(const CycleState& c) noexcept TACT_RT;
    void count_work(const CycleState& c) noexcept TACT_RT;
    [[nodiscard]] bool sample_display(const CycleState& c) noexcept TACT_RT;
    void report_levels(const CycleState& c, std::span<const float> before, bool changed) noexcept TACT_RT;
    void start_interval(Instant now) noexcept TACT_RT;
    void set_display_present(bool present) noexcept TACT_RT;

    Clock& clock_;
    RtRegion& region_;
    ServoMailbox& mailbox_;
    Lines* lines_;
    const CycleScript* script_;
    ServoSettings settings_;
    Arena arena_;
    CycleState* c_;
    Pacer pacer_;
    Watchdogs watchdogs_;
    Governor governor_;
    ServoStatistics statistics_;

    RingCursor orders_;
    CommandResult last_result_ = CommandResult::none;
    std::uint64_t last_sequence_ = 0;
    std::uint64_t events_reported_ = 0;
    std::uint64_t housekeeping_seen_ = 0;
    std::uint64_t gui_generation_ = 0;
    bool gui_attached_ = false, gui_silent_ = false;
    bool health_due_ = false;
    bool stopping_ = false, finished_ = false, dry_ = false;
    Instant health_at_{}, overrun_reported_at_{};
    std::int64_t overrun_at_ns_ = 0;        // the last one
    bool building_ = false;                 // a model is being built aside
    std::uint16_t governed_structure_ = 0;  // whose knob the governor has
    std::uint64_t page_faults_ = 0;
    StartTopic begun_{};  // but for the instant
    std::uint32_t schedule_flags_ = 0;

    // Of the governor's running interval.
    Instant governed_at_{};
    std::uint64_t interval_cycles_ = 0, interval_overruns_ = 0;
    Duration interval_cost_{0}, interval_model_cost_{0};
    Duration interval_rest_{0};
    double interval_recomputed_ = 0.0;  // updates, each by how much of its model's work it did anew
    double law_rate_hz_ = 0.0;
    double model_cost_s_ = 0.0;
    std::uint64_t levels_sequence_ = 0;
    DisplayWatch display_;
    std::uint32_t levels_vertices_max_ = 0, levels_particles_max_ = 0;

    // At the delay of the last second.
    double stiffness_n_m_max_ = 0.0, damping_n_s_m_max_ = 0.0;

    // Beneath the governor, where the loop runs freely.
    RateHold hold_;
    double whole_model_s_ = 0.0, whole_cost_s_ = 0.0;  // of steps that did all of their work, lately
};

}  // namespace tact
