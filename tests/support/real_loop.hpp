// The servo loop on the machine's own clock, with its thread and the threads of supervisor and safety inputs; only
// device and adapter are emulated. A test can stop its servo in the middle of a cycle.
//
// Limits   that a busy host could exceed are large (the device's watchdog, the age of the lines' sample, lateness),
//          so that only the supervisor's limit of silence, which the test sets, acts.
#pragma once

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

#include "hal/io/pumped_lines.hpp"
#include "hal/sim/sim_device.hpp"
#include "hal/sim/sim_lines.hpp"
#include "ipc/base/servo_clock.hpp"
#include "ipc/topics/regions.hpp"
#include "rt/servo/servo.hpp"
#include "rt/start/visual_paths.hpp"
#include "rt/threads/supervisor.hpp"
#include "tests/support/spring_model.hpp"

namespace tact {

enum class Stand : int { none, asleep, spinning };

class StandingModel final : public ForceModel {
public:
    std::atomic<Stand> stand{Stand::none};
    StandingModel() { spring_.stiffness_n_m = 2.0; }

    [[nodiscard]] KnobSpec knob() const noexcept override { return spring_.knob(); }
    [[nodiscard]] std::uint32_t items(float fidelity) const noexcept override {
        return spring_.items(fidelity);
    }
    void reset(const ToolState& tool) noexcept override { spring_.reset(tool); }
    [[nodiscard]] ModelBodies bodies() const noexcept override { return spring_.bodies(); }
    StepResult step(const ToolState& tool, const Budget& budget) noexcept override {
        for (Stand now = stand.load(); now != Stand::none; now = stand.load())
            if (now == Stand::asleep) usleep(1000);
        return spring_.step(tool, budget);
    }

private:
    SpringModel spring_;
};

class RealLoop {
public:
    // priority: of the servo thread, FIFO if permitted; 0: ordinary scheduling.
    explicit RealLoop(Duration silence_max, int priority = 0)
        : region_(new RtRegion{}),
          device_({.hand = {}, .watchdog = kLong}),
          lines_({}, std::make_unique<BoardPort>(board_), std::chrono::milliseconds(1)),
          supervisor_(mailbox_.pulse, silence_max, [this] { lines_.drop(); }) {
        static_cast<void>(lines_.open());
        hand_ = {&device_, &model_, device_.open()};
        std::atomic<int> thread_id{0};
        thread_ = std::thread([this, priority, &thread_id] {
            static_cast<void>(raise_to_fifo(pthread_self(), "the servo", priority));
            Servo servo({clock_, {&hand_, 1}, *region_, mailbox_, &lines_}, settings());
            servo.warm_up();
            thread_id.store(gettid());
            servo.run();
        });
        while (thread_id.load() == 0) usleep(1000);
        supervisor_.start(thread_id.load());
    }
    ~RealLoop() {
        model_.stand.store(Stand::none);
        mailbox_.stop_signal.store(15);
        thread_.join();
    }
    RealLoop(const RealLoop&) = delete;
    RealLoop& operator=(const RealLoop&) = delete;

    std::uint64_t order(CommandKind kind) {
        mailbox_.orders.push({++sequence_, 0.0, static_cast<std::uint32_t>(kind), 0});
        return sequence_;
    }
    // Resets and arms as needed, as a person does. True once the amplifier is enabled.
    bool brought_up() {
        const HealthTopic h = health();
        if (h.command_sequence == sequence_ && state() == RunState::fault) order(CommandKind::reset_fault);
        if (h.command_sequence == sequence_ && state() == RunState::ready) order(CommandKind::arm);
        return state() == RunState::active && enabled();
    }
    void stand(Stand how) { model_.stand.store(how); }
    [[nodiscard]] HealthTopic health() const {
        HealthTopic h{};
        while (!region_->health.read(h)) usleep(100);
        return h;
    }
    [[nodiscard]] RunState state() const { return static_cast<RunState>(health().state); }
    [[nodiscard]] std::uint64_t drops() const { return mailbox_.pulse.drops.load(); }
    [[nodiscard]] Instant beat() const { return instant_from_ns(mailbox_.pulse.beat_ns.load()); }
    // As measured at the adapter.
    [[nodiscard]] bool enabled() const { return (board_.driven() & kLineEnable) != 0; }
    [[nodiscard]] LinesHealth lines() const { return lines_.health(); }
    [[nodiscard]] const RtRegion& region() const { return *region_; }
    [[nodiscard]] ServoMailbox& mailbox() { return mailbox_; }

private:
    static constexpr Duration kLong = std::chrono::hours(1);

    // The board outlives the lines, which own their port.
    class BoardPort final : public LinePort {
    public:
        explicit BoardPort(SimBoard& board) : board_(board) {}
        LinePortInfo open() override { return board_.open(); }
        bool reopen() noexcept override { return board_.reopen(); }
        LineReading read() noexcept override { return board_.read(); }
        bool write(std::uint8_t outputs) noexcept override { return board_.write(outputs); }
        void wait(Duration longest) noexcept override { board_.wait(longest); }

    private:
        SimBoard& board_;
    };
    static ServoSettings settings() {
        ServoSettings s;
        s.model_deadline = false;
        s.dry_cycles = 20;
        s.visual_paths = kMeshPaths;
        s.watchdogs.timing_latches = false;
        s.watchdogs.device_watchdog_latches = false;
        s.watchdogs.sample_age_max = kLong;
        s.lines_age_max = kLong;
        return s;
    }

    std::unique_ptr<RtRegion> region_;
    ServoClock clock_{Duration{0}};
    SimDevice device_;
    StandingModel model_;
    HandParts hand_{};
    ServoMailbox mailbox_;
    SimBoard board_;
    PumpedLines lines_;
    Supervisor supervisor_;
    std::thread thread_;
    std::uint64_t sequence_ = 0;
};

}  // namespace tact
