// One hand, a spring and a CycleState, for tests that call a single stage of the servo cycle.
//
// Time     manual; begins at 100 s
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <memory>
#include <vector>

#include "hal/api/haptic_device.hpp"
#include "hal/api/lines.hpp"
#include "ipc/base/clock.hpp"
#include "rt/servo/cycle.hpp"
#include "rt/servo/servo_io.hpp"
#include "tests/support/spring_model.hpp"

namespace tact {

// Returns what a test sets, and keeps the last command.
class StubDevice final : public HapticDevice {
public:
    DeviceInfo open() override {
        return {.name = "stub",
                .serial = "",
                .workspace_half_m = Vec3::Constant(0.1),
                .force_n_max = 2.0,
                .force_n_continuous = 0.0,
                .torque_n_m_max = 0.1,
                .stiffness_n_m_max = 1000.0,
                .position_step_m = 0.0};
    }
    IoStatus read(DeviceSample& newest, Instant /*now*/) noexcept override {
        newest = sample;
        return status;
    }
    IoStatus write(const DeviceCommand& c, Instant /*now*/) noexcept override {
        command = c;
        return write_status;
    }
    void relax() noexcept override {}

    DeviceSample sample;
    DeviceCommand command;
    IoStatus status = IoStatus::ok, write_status = IoStatus::ok;
};

class StubLines final : public Lines {
public:
    LinesInfo open() override { return {}; }
    bool read(LinesSample& newest, Instant /*now*/) noexcept override {
        newest = sample;
        return true;
    }
    void write(const LinesCommand& c, Instant /*now*/) noexcept override { command = c; }
    void drop() noexcept override {}
    [[nodiscard]] LinesHealth health() const noexcept override { return {}; }

    LinesSample sample;
    LinesCommand command;
};

// A path of the display that belongs to no system.
inline constexpr std::array kStubPaths{VisualPath{{.path = "stub.display", .floor = 0.1F, .start = 1.0F},
                                                  &HousekeepingReport::gui_vertices_max,
                                                  &HousekeepingReport::gui_vertices,
                                                  &HousekeepingReport::gui_busy_s}};

struct CycleFixture {
    explicit CycleFixture(ServoSettings wanted = {})
        : region(new RtRegion{}),
          settings(with_paths(wanted)),
          hand{&device, &model, device.open()},
          c(settings, {&hand, 1}, begin()),
          io{clock, *region, mailbox} {
        c.now = c.before = c.device_now = clock.now();
        device.sample.taken_at = clock.now();
        device.sample.sequence = 1;
        device.sample.state = DeviceState::powered;
        device.sample.hand_present = true;
        c.hand[0].sample = device.sample;
        c.hand[0].sample_usable = true;
        c.run.state = RunState::ready;
    }
    void fit_lines() {
        io.lines = &lines;
        c.lines.fitted = true;
        lines.sample.sequence = 1;
        lines.sample.taken_at = c.now;
        lines.sample.state = LinesState::permitted;
        lines.sample.cause = LinesCause::none;
    }
    [[nodiscard]] std::vector<EventTopic> events() const {
        RingCursor cursor;
        EventTopic e{};
        std::vector<EventTopic> all;
        while (region->events.next(cursor, e)) all.push_back(e);
        return all;
    }
    [[nodiscard]] bool reported(EventCode code) const {
        for (const EventTopic& e : events())
            if (e.code == static_cast<std::uint16_t>(code)) return true;
        return false;
    }
    ServoOrder order(CommandKind kind, double value = 0.0, std::uint32_t index = 0) {
        const ServoOrder o{++sequence, value, static_cast<std::uint32_t>(kind), index};
        mailbox.orders.push(o);
        return o;
    }

    ManualClock clock;
    std::unique_ptr<RtRegion> region;
    StubDevice device;
    StubLines lines;
    SpringModel model;
    ServoMailbox mailbox;
    ServoSettings settings;
    HandParts hand;
    CycleState c;
    ServoIo io;
    std::uint64_t sequence = 0;

private:
    Instant begin() {
        clock.advance(std::chrono::seconds(100));
        return clock.now();
    }
    static ServoSettings with_paths(ServoSettings s) {
        s.model_deadline = false;
        if (s.visual_paths.empty()) s.visual_paths = kStubPaths;
        return s;
    }
};

template <class Topic>
[[nodiscard]] Topic newest(const Latest<Topic>& latest) {
    Topic t{};
    EXPECT_TRUE(latest.read(t));
    return t;
}

}  // namespace tact
