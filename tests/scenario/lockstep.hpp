// The whole servo loop on a manual clock, with the emulated device: no waiting, repeatable.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "hal/sim/sim_device.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/topics/regions.hpp"
#include "rt/servo/servo.hpp"
#include "rt/start/visual_paths.hpp"
#include "tests/support/spring_model.hpp"

namespace tact {

// Parts of a second hand, if there is one.
struct SecondHand {
    SimSettings sim;
    ForceModel* model = nullptr;
    DriveInput drive = {};
};

class Lockstep {
public:
    // lines: already open. model: replaces the spring.
    explicit Lockstep(ServoSettings settings = {}, SimSettings sim = {}, Lines* lines = nullptr,
                      ForceModel* model = nullptr, const SecondHand& second = {}, DriveInput drive = {})
        : region_(new RtRegion{}), device_(sim), device2_(second.sim) {
        settings.model_deadline = false;
        settings.dry_cycles = 20;
        if (settings.visual_paths.empty()) settings.visual_paths = kMeshPaths;
        clock_.advance(std::chrono::seconds(100));
        hands_ = {HandParts{&device_, model != nullptr ? model : &model_, device_.open(), drive},
                  HandParts{&device2_, second.model, device2_.open(), second.drive}};
        const std::span<const HandParts> hands(hands_.data(), second.model != nullptr ? 2 : 1);
        servo_.emplace(ServoParts{clock_, hands, *region_, mailbox_, lines}, settings);
        servo_->warm_up();
    }

    void cycles(int n) {
        for (int i = 0; i < n && !servo_->finished(); ++i) servo_->cycle();
    }
    void order(CommandKind kind, double value = 0.0, std::uint32_t index = 0) {
        mailbox_.orders.push({++sequence_, value, static_cast<std::uint32_t>(kind), index});
    }
    // Armed and active, and the ramp has ended.
    void active() {
        order(CommandKind::arm);
        cycles(600);
    }
    [[nodiscard]] RunState state() const { return servo_->state().run.state; }
    [[nodiscard]] RunReason reason() const { return servo_->state().run.reason; }
    [[nodiscard]] double shown_n() const { return device_.shown_dev().force_n.norm(); }
    [[nodiscard]] ToolTopic tool() const {
        ToolTopic t{};
        static_cast<void>(region_->tool[0].read(t));
        return t;
    }
    [[nodiscard]] DrillTopic drill() const {
        DrillTopic t{};
        static_cast<void>(region_->drill.read(t));
        return t;
    }
    [[nodiscard]] HealthTopic health() const {
        HealthTopic t{};
        static_cast<void>(region_->health.read(t));
        return t;
    }
    [[nodiscard]] DevicesTopic devices() const {
        DevicesTopic t{};
        static_cast<void>(region_->devices.read(t));
        return t;
    }
    [[nodiscard]] LevelsTopic levels() const {
        LevelsTopic t{};
        static_cast<void>(region_->levels.read(t));
        return t;
    }
    // Number of events with this code so far.
    [[nodiscard]] int said(EventCode code) const {
        RingCursor cursor;
        EventTopic e{};
        int n = 0;
        while (region_->events.next(cursor, e)) n += e.code == static_cast<std::uint16_t>(code);
        return n;
    }

    ManualClock clock_;
    std::unique_ptr<RtRegion> region_;
    SimDevice device_, device2_;
    SpringModel model_;
    ServoMailbox mailbox_;
    std::array<HandParts, 2> hands_{};
    std::optional<Servo> servo_;
    std::uint64_t sequence_ = 0;
};

// The housekeeping report about a visual process that reported at time t.
inline HousekeepingReport gui_at(Instant t) {
    HousekeepingReport r{};
    r.gui_heartbeat_ns = to_ns(t);
    r.gui_attached = 1;
    r.gui_generation = 5;
    r.gui_vertices_max = 10000;
    return r;
}

}  // namespace tact
