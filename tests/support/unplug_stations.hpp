// Every driver of hal/registry.cpp on its emulated device, with a plug that a test can pull at any instant.
//
// Time     of the station's clock; pass() moves it together with device, bus and pump. The device in a process of its
//          own has real time: its pass() does nothing, since the servo waits itself.
// Thread   one
#pragma once

#include <signal.h>
#include <sys/wait.h>

#include <memory>
#include <string>
#include <vector>

#include "hal/sim/process_device.hpp"
#include "ipc/base/servo_clock.hpp"
#include "tests/support/board_bus.hpp"
#include "tests/support/falcon_board.hpp"
#include "tests/support/forcedimension_driver.hpp"
#include "tests/support/inverse_driver.hpp"
#include "tests/support/openhaptics_driver.hpp"
#include "tests/support/polhem_board.hpp"

namespace tact {

class UnplugStation {
public:
    UnplugStation() = default;
    virtual ~UnplugStation() = default;
    UnplugStation(const UnplugStation&) = delete;
    UnplugStation& operator=(const UnplugStation&) = delete;

    virtual HapticDevice& device() = 0;
    virtual Clock& clock() = 0;
    virtual void pass(Duration d) = 0;
    virtual void unplug() = 0;
    virtual void plug() = 0;
    // As measured at the device, which may be out of the driver's reach.
    [[nodiscard]] virtual bool powered() = 0;
    [[nodiscard]] virtual double force_n() = 0;

    // The device's silence is the only sign of its loss: found when the newest sample is too old.
    bool silent_loss = false;
    // The driver never finds it again: the controller must be started again.
    bool final_loss = false;
};

class SimStation final : public UnplugStation {
public:
    SimStation() { clock_.advance(std::chrono::seconds(1)); }
    HapticDevice& device() override { return device_; }
    Clock& clock() override { return clock_; }
    void pass(Duration d) override { clock_.advance(d); }
    void unplug() override { device_.inject(SimFault::unplugged); }
    void plug() override {
        device_.inject(SimFault::none);
        static_cast<void>(device_.open());
    }
    bool powered() override { return device_.state() == DeviceState::powered; }
    double force_n() override { return device_.shown_dev().force_n.norm(); }

private:
    ManualClock clock_;
    SimDevice device_{SimSettings{}};
};

class ProcessStation final : public UnplugStation {
public:
    ProcessStation() { silent_loss = final_loss = true; }
    HapticDevice& device() override { return device_; }
    Clock& clock() override { return clock_; }
    void pass(Duration /*d*/) override {}
    void unplug() override { kill(device_.process(), SIGKILL); }
    void plug() override {}
    bool powered() override { return false; }
    double force_n() override { return 0.0; }

private:
    static SimSettings lenient() {
        SimSettings s;
        s.watchdog = std::chrono::seconds(1);  // a busy machine delays both processes
        return s;
    }
    ServoClock clock_{Duration{0}};
    ProcessDevice device_{lenient(), ""};
};

class PhantomStation final : public UnplugStation {
public:
    HapticDevice& device() override { return device_; }
    Clock& clock() override { return clock_; }
    void pass(Duration d) override {
        bus_->advance(d);
        device_.pump().round(Duration{0});
        clock_.wait_until(bus_->now());
    }
    void unplug() override { bus_->unplug(); }
    void plug() override { bus_->plug(); }
    bool powered() override {
        return bus_->plugged && bus_->board().amplifier().state() == phantom::AmplifierState::on;
    }
    double force_n() override { return powered() ? 1.0 : 0.0; }  // the board tells only its amplifier

private:
    static PhantomUsbSettings settings() {
        PhantomUsbSettings s = emu::usual<PhantomUsbSettings>();
        s.thread = false;
        s.arm = emu::usual<emu::BoardSettings>().arm;
        return s;
    }
    std::unique_ptr<emu::BoardBus> owned_ = std::make_unique<emu::BoardBus>(emu::usual<emu::BoardSettings>());
    emu::BoardBus* bus_ = owned_.get();
    ManualClock clock_;
    PhantomUsb device_{settings(), std::move(owned_)};
};

class PolhemStation final : public UnplugStation {
public:
    HapticDevice& device() override { return device_; }
    Clock& clock() override { return clock_; }
    void pass(Duration d) override {
        port_->advance(d);
        device_.pump().round(Duration{0});
        clock_.wait_until(port_->now());
        // The person repeats the ritual until the arm is calibrated.
        const bool calibrated = device_.calibration() == CalibrationState::done;
        if (port_->plugged && !calibrated && ++waited_ % 1000 == 0) port_->board().calibrate_again();
    }
    void unplug() override { port_->plugged = false; }
    void plug() override {
        port_->current_ma = {};  // without power it forgets
        port_->plugged = true;
    }
    bool powered() override { return port_->plugged && port_->current_ma != std::array<std::int16_t, 3>{}; }
    double force_n() override { return powered() ? 1.0 : 0.0; }

private:
    static PhantomUsbSettings settings() {
        PhantomUsbSettings s;
        s.thread = false;
        s.arm = emu::usual<emu::BoardSettings>().arm;
        return s;
    }
    std::unique_ptr<emu::PolhemBoard> owned_ =
        std::make_unique<emu::PolhemBoard>(emu::usual<emu::BoardSettings>());
    emu::PolhemBoard* port_ = owned_.get();
    ManualClock clock_;
    int waited_ = 0;
    PhantomUsb device_{settings(), std::make_unique<polhem::PolhemBus>(std::move(owned_))};
};

class FalconStation final : public UnplugStation {
public:
    HapticDevice& device() override { return device_; }
    Clock& clock() override { return clock_; }
    void pass(Duration d) override {
        for (Duration left = d; left > Duration{0};) {
            const Duration piece = std::min<Duration>(left, std::chrono::microseconds(250));
            board_->advance(piece);
            device_.pump().round(Duration{0});
            left -= piece;
        }
        clock_.wait_until(board_->now());
        // The person pushes the grip in some time after each start.
        if (board_->homed == 0 && board_->plugged && ++waited_ > 300) {
            board_->push_through();
            waited_ = 0;
        }
    }
    void unplug() override { board_->unplug(); }
    void plug() override {
        board_->plug();
        board_->runs = true;  // the test is not about its firmware
    }
    bool powered() override { return board_->plugged && board_->torque != falcon::Torque3{}; }
    double force_n() override { return board_->plugged ? board_->force_n().norm() : 0.0; }

private:
    static FalconSettings settings() {
        FalconSettings s;
        s.thread = false;
        s.say = [](const char* /*text*/) {};
        return s;
    }
    std::unique_ptr<emu::FalconBoard> owned_ = std::make_unique<emu::FalconBoard>();
    emu::FalconBoard* board_ = owned_.get();
    ManualClock clock_;
    int waited_ = 0;
    Falcon device_{settings(), std::move(owned_)};
};

class OpenHapticsStation final : public UnplugStation {
public:
    OpenHapticsStation() {
        final_loss = true;  // an error of the link ends the library's scheduler
        fake_hd_library().reset();
    }
    HapticDevice& device() override { return device_; }
    Clock& clock() override { return clock_; }
    void pass(Duration d) override { clock_.wait_until(clock_.now() + d); }
    void unplug() override {
        fake_hd_library().always = true;
        fake_hd_library().raise(0x302);
    }
    void plug() override { fake_hd_library().always = false; }
    bool powered() override { return fake_hd_library().output.load() && force_n() > 0.0; }
    double force_n() override {
        const auto& f = fake_hd_library().force_n;
        return std::hypot(f[0].load(), f[1].load(), f[2].load());
    }

private:
    HdClock clock_;
    OpenHaptics device_{hd_settings(), clock_};
};

class ForceDimensionStation final : public UnplugStation {
public:
    ForceDimensionStation() { fake_fd_library().reset(); }
    HapticDevice& device() override { return device_; }
    Clock& clock() override {
        clock_.device = &device_;
        return clock_;
    }
    void pass(Duration d) override { clock().wait_until(clock_.now() + d); }
    void unplug() override { arm().plugged = false; }
    void plug() override { arm().plugged = true; }
    bool powered() override { return arm().force.load(); }
    double force_n() override {
        return std::hypot(arm().force_n[0].load(), arm().force_n[1].load(), arm().force_n[2].load());
    }

private:
    static FakeFdArm& arm() { return fake_fd_library().arms[0]; }
    FdClock clock_;
    ForceDimension device_{fd_settings(), clock_};
};

class InverseStation final : public UnplugStation {
public:
    HapticDevice& device() override { return device_; }
    Clock& clock() override {
        clock_.device = &device_;
        clock_.service = &service_;
        return clock_;
    }
    void pass(Duration d) override { clock().wait_until(clock_.now() + d); }
    void unplug() override { service_.plugged = false; }
    void plug() override { service_.plugged = true; }
    bool powered() override { return force_n() > 0.0; }
    double force_n() override {
        return std::hypot(service_.force_n[0], service_.force_n[1], service_.force_n[2]);
    }

private:
    InverseClock clock_;
    FakeInverse service_;
    Inverse3 device_{inverse_settings(), std::make_unique<FakeInverseChannel>(service_), clock_};
};

struct UnplugCase {
    const char* driver;
    std::unique_ptr<UnplugStation> (*make)();
};
inline void PrintTo(const UnplugCase& c, std::ostream* out) { *out << c.driver; }

template <class Station>
std::unique_ptr<UnplugStation> make_station() {
    return std::make_unique<Station>();
}

inline constexpr std::array kUnplugCases{
    UnplugCase{"sim", &make_station<SimStation>},
    UnplugCase{"sim-process", &make_station<ProcessStation>},
    UnplugCase{"phantom-usb", &make_station<PhantomStation>},
    UnplugCase{"openhaptics", &make_station<OpenHapticsStation>},
    UnplugCase{"forcedimension", &make_station<ForceDimensionStation>},
    UnplugCase{"inverse3", &make_station<InverseStation>},
    UnplugCase{"polhem", &make_station<PolhemStation>},
    UnplugCase{"falcon", &make_station<FalconStation>},
};

}  // namespace tact
