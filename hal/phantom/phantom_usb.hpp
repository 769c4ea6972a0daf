// A Phantom arm on an amplifier board with the protocol of PROTOCOL.md, over USB.
//
// open()    waits for the board for up to kFindMax, agrees on a version, waits for the first state; then a
//           pump thread owns the bus
// read()    newest state: pose, velocity, buttons; faults of PROTOCOL.md's table are latched here, with
//           their cause as a notice. Before calibration the pose is the origin, hand_present is false, and
//           the notice gives the required action.
// write()   wrench to currents: gravity compensation while the amplifier is on, thermal limits, limits of
//           arm and board. No current before calibration, during a fault, or before enable was low after
//           it.
// relax()   any thread, any state: no current from the next packet on, until enable was low
// Replug    found again by its serial number, calibrated again; never re-armed automatically
// Errors    lost: no board, or 100 ms without a state; fault: as latched; StartupError in open()
// Thread    open() and destruction on the main thread; read() and write() on the servo thread, memory only
#pragma once

#include <memory>
#include <string>

#include "hal/api/haptic_device.hpp"
#include "hal/arm/arm_kinematics.hpp"
#include "hal/arm/calibration.hpp"
#include "hal/arm/velocity.hpp"
#include "hal/phantom/arm_watch.hpp"
#include "hal/phantom/usb_pump.hpp"
#include "hal/usb/pump_thread.hpp"
#include "ipc/base/fifo.hpp"

namespace tact {

struct PhantomUsbSettings {
    std::string serial;  // empty: the only board on the bus
    ArmParameterSet arm = arm_parameter_set("premium-1.5");
    Duration hold_max = std::chrono::milliseconds(3);        // validity of the newest state
    Duration watchdog_max = phantom::UsbPump::kWatchdogMax;  // of the board; a longer one is refused
    int pump_priority = kPumpPriority;                       // FIFO; 0: ordinary scheduling
    bool thread = true;  // false: the caller runs pump().round(), for tests
    void (*say)(const char* text) =
        nullptr;  // reports progress and reduced operation in open(); null: standard error
};

class PhantomUsb final : public HapticDevice {
public:
    static constexpr Duration kFindMax = std::chrono::seconds(5);  // for a board that was just connected

    // The board on this computer's bus, through libusb.
    explicit PhantomUsb(const PhantomUsbSettings& settings);
    PhantomUsb(const PhantomUsbSettings& settings, std::unique_ptr<usb::Bus> bus);
    ~PhantomUsb() override;
    PhantomUsb(const PhantomUsb&) = delete;
    PhantomUsb& operator=(const PhantomUsb&) = delete;

    DeviceInfo open() override;
    IoStatus read(DeviceSample& newest, Instant now) noexcept TACT_RT override;
    IoStatus write(const DeviceCommand& command, Instant now) noexcept TACT_RT override;
    void relax() noexcept override;

    [[nodiscard]] phantom::UsbPump& pump() noexcept { return *pump_; }
    [[nodiscard]] CalibrationState calibration() const noexcept { return calibration_.state(); }

private:
    void find_board();
    void wait_for_first_state();
    void say(const std::string& text) const;
    [[nodiscard]] DeviceInfo describe() const;
    [[nodiscard]] std::string versions() const;

    void latch(DeviceNotice fault) noexcept;
    void forget_counts() noexcept;
    void take(Instant now) noexcept;
    void calibrate(Instant now) noexcept;
    void heat() noexcept;
    [[nodiscard]] DeviceNotice silence(Instant now) const noexcept;
    [[nodiscard]] Joint6 limits_a() const noexcept;

    PhantomUsbSettings settings_;
    ArmKinematics arm_;
    Calibration calibration_;
    ArmVelocity velocity_;
    phantom::ArmWatch watch_;
    std::unique_ptr<usb::Bus> bus_;
    std::unique_ptr<phantom::UsbPump> pump_;
    usb::PumpThread thread_;
    bool opened_ = false;

    // Used by the servo thread only.
    phantom::PumpNews news_;
    DeviceSample sample_;
    std::uint64_t states_ = 0;
    std::uint32_t generation_ = 0, time_us_ = 0;
    Joint6 q_ = Joint6::Zero();
    std::array<MotorHeat, 6> heat_{};
    std::array<std::int16_t, 6> limit_ma_{};
    DeviceNotice fault_ = DeviceNotice::none, cause_ = DeviceNotice::none;
    bool lowered_ = false;  // enable was low since the fault
    bool gate_ = false;     // enable may be passed to the board
    std::uint32_t relaxed_ = 0;
};

}  // namespace tact
