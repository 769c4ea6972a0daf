// The driver with its own thread on the bus: mailboxes, start and end. hal_phantom_usb_test covers its decisions.
#include <gtest/gtest.h>

#include <thread>

#include "tests/support/board_bus.hpp"

namespace tact::hal_phantom_thread_test {
namespace {

using std::chrono::milliseconds;

// An arm that calibrates itself, so that the tests need no person.
emu::BoardSettings board() {
    emu::BoardSettings s = emu::usual<emu::BoardSettings>();
    s.arm.calibration = CalibrationStyle::automatic;
    s.ritual = false;
    return s;
}

class PhantomThread : public testing::Test {
protected:
    PhantomThread() {
        auto owned = std::make_unique<emu::BoardBus>(board());
        bus_ = owned.get();
        PhantomUsbSettings settings = emu::usual<PhantomUsbSettings>();
        settings.arm = board().arm;
        settings.pump_priority = 0;  // the thread must not preempt the test
        settings.hold_max = milliseconds(5);
        device_ = std::make_unique<PhantomUsb>(settings, std::move(owned));
    }
    void open() {
        EXPECT_EQ(device_->open().serial, "EMU-1");
        time_ = bus_->reached();
        bus_->hold_time_at(time_);
    }
    // Advances the board by 1 ms with the pump running, then runs a servo cycle. Returns false if the pump hangs.
    bool cycle(bool enable) {
        time_ += milliseconds(1);
        bus_->hold_time_at(time_);
        const Instant end = Monotonic::now() + std::chrono::seconds(100);  // only against a hang
        while (bus_->reached() < time_) {
            if (Monotonic::now() > end) return false;
            std::this_thread::yield();
        }
        time_ = bus_->reached();
        static_cast<void>(device_->read(sample_, time_));
        static_cast<void>(
            device_->write({.wrench_dev = {}, .enable = enable, .heartbeat = ++heartbeat_}, time_));
        return true;
    }
    template <class Done>
    bool until(bool enable, Done done) {
        for (int i = 0; i < 5000; ++i) {
            if (!cycle(enable)) return false;
            if (done()) return true;
        }
        return false;
    }

    emu::BoardBus* bus_ = nullptr;
    std::unique_ptr<PhantomUsb> device_;
    DeviceSample sample_;

private:
    Instant time_{};
    std::uint64_t heartbeat_ = 0;
};

TEST_F(PhantomThread, owns_the_bus_while_the_servo_and_others_use_the_device) {
    open();
    EXPECT_EQ(device_->open().serial, "EMU-1");  // a second open changes nothing
    ASSERT_TRUE(until(false, [&] { return device_->calibration() == CalibrationState::done; }));
    ASSERT_TRUE(until(true, [&] { return sample_.state == DeviceState::powered; }));
    const std::uint64_t before = sample_.sequence;
    EXPECT_TRUE(until(true, [&] { return sample_.sequence > before + 20 && sample_.delay > Duration{0}; }));
    EXPECT_EQ(sample_.state, DeviceState::powered) << device_notice_text(sample_.notice);
    std::thread other([&] { device_->relax(); });
    EXPECT_TRUE(until(true, [&] { return sample_.state == DeviceState::ready; }));
    other.join();
    for (int i = 0; i < 50; ++i) ASSERT_TRUE(cycle(true));
    EXPECT_EQ(sample_.state, DeviceState::ready);  // enable never fell, so power does not return
    ASSERT_TRUE(until(false, [&] { return sample_.sequence > before + 100; }));
    EXPECT_TRUE(until(true, [&] { return sample_.state == DeviceState::powered; }));
}

TEST_F(PhantomThread, ends_with_the_amplifier_on_and_time_stopped) {
    open();
    ASSERT_TRUE(until(false, [&] { return device_->calibration() == CalibrationState::done; }));
    ASSERT_TRUE(until(true, [&] { return sample_.state == DeviceState::powered; }));
    device_.reset();
}

std::vector<std::string>& heard() {
    static std::vector<std::string> all;
    return all;
}

TEST(PhantomPriority, a_refused_priority_is_reported_once_with_a_fix_and_the_driver_continues) {
    PhantomUsbSettings settings = emu::usual<PhantomUsbSettings>();
    settings.arm = board().arm;
    settings.say = [](const char* text) { heard().emplace_back(text); };
    for (const int priority : {0, 1000}) {  // root cannot use the latter either
        heard().clear();
        settings.pump_priority = priority;
        PhantomUsb device(settings, std::make_unique<emu::BoardBus>(board()));
        EXPECT_EQ(device.open().serial, "EMU-1");
        ASSERT_EQ(heard().size(), priority == 0 ? 0U : 1U);
        if (priority == 0) continue;
        EXPECT_NE(heard()[0].find("cannot use SCHED_FIFO at priority 1000 for the arm's USB"),
                  std::string::npos)
            << heard()[0];
        EXPECT_NE(heard()[0].find("fix: run tact doctor to find the missing right"), std::string::npos)
            << heard()[0];
    }
}

TEST_F(PhantomThread, ends_at_once_after_open_and_relax) {
    EXPECT_EQ(device_->open().serial, "EMU-1");
    device_->relax();
    device_->relax();
}

}  // namespace
}  // namespace tact::hal_phantom_thread_test
