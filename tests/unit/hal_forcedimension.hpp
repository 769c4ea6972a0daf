// The substitute library of the tests, a clock that runs it, and a fixture with the driver on both.
#pragma once

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>

#include "hal/forcedimension/force_dimension.hpp"
#include "ipc/base/error.hpp"
#include "tests/support/fake_fd.hpp"
#include "tests/support/says.hpp"

namespace tact {

inline FakeFd& fake_fd_of(const char* path) {
    void* const library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) std::abort();
    return *reinterpret_cast<FakeFdAccess>(dlsym(library, kFakeFdAccess))();
}
inline FakeFd& fake_fd_library() {
    static FakeFd& f = fake_fd_of(TACT_FAKE_FD);
    return f;
}

// Time advances only here: each millisecond is a round of the pump, then one of the arm.
class FdClock final : public Clock {
public:
    Instant now() noexcept override { return now_; }
    void wait_until(Instant t) noexcept override {
        while (now_ < t) {
            now_ = std::min(t, now_ + std::chrono::milliseconds(1));
            if (device != nullptr) device->round();
            fake_fd_library().tick();
        }
    }
    void jump(Instant t) noexcept { now_ = t; }

    ForceDimension* device = nullptr;

private:
    Instant now_ = instant_from_ns(1'000'000'000);
};

inline std::string& said() {
    static std::string text;
    return text;
}

inline ForceDimensionSettings fd_settings() {
    ForceDimensionSettings s;
    s.library = TACT_FAKE_FD;
    s.thread = false;
    s.say = [](const char* text) { said() += std::string(text) + "\n"; };
    return s;
}

class ForceDimensionTest : public testing::Test {
protected:
    ForceDimensionTest() { fake().reset(); }
    static FakeFd& fake() { return fake_fd_library(); }
    static FakeFdArm& arm() { return fake().arms[0]; }

    void open() {
        clock.device = nullptr;
        device.reset();
        device = std::make_unique<ForceDimension>(settings, clock);
        info = device->open();
        clock.device = device.get();
        command.enable = false;
    }
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
        cycles(3, Vec3(1.0, 0.0, 0.0), true);
        ASSERT_EQ(sample.state, DeviceState::powered);
        ASSERT_EQ(shown().x(), 1.0);
    }
    // In Tact's axes.
    static Vec3 shown() {
        return {arm().force_n[1].load(), arm().force_n[2].load(), arm().force_n[0].load()};
    }
    std::string refusal() {
        try {
            open();
        } catch (const StartupError& e) {
            return e.what();
        }
        return "it opened";
    }

    FdClock clock;
    ForceDimensionSettings settings = fd_settings();
    std::unique_ptr<ForceDimension> device;
    DeviceInfo info;
    DeviceSample sample;
    DeviceCommand command;
};

}  // namespace tact
