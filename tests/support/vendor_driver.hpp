// What the tests of drivers with a manufacturer's library or service share: a clock that runs pump and device,
// and the fixture of a driver on it.
//
// Thread   one
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "hal/api/haptic_device.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/error.hpp"

namespace tact {

// Time advances only in wait_until(): each step of at most a millisecond is a round of the driver's pump, where the
// driver has one of its own, then a tick of the emulated device.
template <class Device>
class PumpClock : public Clock {
public:
    explicit PumpClock(std::function<void()> tick) : tick_(std::move(tick)) {}

    Instant now() noexcept override { return now_; }
    void wait_until(Instant t) noexcept override {
        while (now_ < t) {
            now_ = std::min(t, now_ + std::chrono::milliseconds(1));
            if constexpr (requires(Device & d) { d.round(); }) {
                if (device != nullptr) device->round();
            }
            tick_();
        }
    }
    void jump(Instant t) noexcept { now_ = t; }

    Device* device = nullptr;  // null: its pump does not run

private:
    std::function<void()> tick_;
    Instant now_ = instant_from_ns(1'000'000'000);
};

template <class Device, class ClockOfDevice>
class VendorDriverTest : public testing::Test {
protected:
    virtual void open() = 0;
    [[nodiscard]] virtual Vec3 shown() const = 0;  // force of the motors, in Tact's axes

    IoStatus cycle(const Vec3& force_n, bool enable) {
        command.wrench_dev.force_n = force_n;
        command.enable = enable;
        ++command.heartbeat;
        static_cast<void>(device->write(command, clock.now()));
        clock.wait_until(clock.now() + std::chrono::milliseconds(1));
        return device->read(sample, clock.now());
    }
    IoStatus cycles(int n, const Vec3& force_n, bool enable) {
        IoStatus status = IoStatus::ok;
        for (int i = 0; i < n; ++i) status = cycle(force_n, enable);
        return status;
    }
    void power() {
        cycles(3, Vec3::Zero(), false);
        cycles(cycles_to_power, Vec3(1.0, 0.0, 0.0), true);
        ASSERT_EQ(sample.state, DeviceState::powered);
        ASSERT_EQ(shown().x(), 1.0);
    }
    std::string refusal() {
        try {
            open();
        } catch (const StartupError& e) {
            return e.what();
        }
        return "it opened";
    }

    ClockOfDevice clock;
    std::unique_ptr<Device> device;
    DeviceInfo info;
    DeviceSample sample;
    DeviceCommand command;
    int cycles_to_power = 3;
};

}  // namespace tact
