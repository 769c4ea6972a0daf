// Novint's Falcon: three degrees of freedom, through the firmware that its owner has, over its serial converter
// (PROTOCOL.md). Untried on hardware.
//
// open()    waits for the device for up to kFindMax, gives it its firmware if it does not run yet (some ten seconds), waits for its first
//           reply; then a pump thread owns the bus
// read()    newest state: position, speed, buttons (bit 0, the clutch: the middle one); no orientation. Until all
//           three encoders have found their marks it stands at the origin, nobody's hand is on it, and the
//           notice says what the person has to do: pull the grip out, and push it in all the way.
// write()   force to motor steps. None before the marks are found, with a fault, where the legs cannot show
//           it, and not before enable was low after these. Torques are not shown. The grip's weight is not
//           carried.
// relax()   any thread, any state: no torque from the next packet on, until enable was low
// Replug    found again by its serial, marks anew; never armed by itself
// Fails by  lost: no device, or 100 ms without a reply; fault: as latched; StartupError in open()
// Thread    open() and destruction on the main one; read() and write() on the servo's, memory only
#pragma once

#include <memory>
#include <string>

#include "hal/api/haptic_device.hpp"
#include "hal/arm/velocity.hpp"
#include "hal/falcon/pump.hpp"
#include "hal/usb/pump_thread.hpp"
#include "ipc/base/fifo.hpp"

namespace tact {

struct FalconSettings {
    std::string serial;    // empty: the only one there is
    std::string firmware;  // file; empty: it has to run already
    falcon::Geometry geometry;
    Duration hold_max = std::chrono::milliseconds(3);  // the newest state is good for so long
    int pump_priority = kPumpPriority;                 // FIFO; 0: ordinary scheduling
    bool thread = true;                                // false: the caller runs pump().round(), for tests
    void (*say)(const char* text) =
        nullptr;  // while open() waits or goes on with less; null: on standard error
};

class Falcon final : public HapticDevice {
public:
    // What its maker does not tell: low, and to be raised by who has measured it.
    static constexpr double kForceContinuousN = 2.5;
    static constexpr double kStiffnessNM = 1000.0;
    static constexpr Duration kFindMax = std::chrono::seconds(5);  // it is just being plugged or switched on

    explicit Falcon(const FalconSettings& settings);
    Falcon(const FalconSettings& settings, std::unique_ptr<usb::Bus> bus);
    ~Falcon() override;
    Falcon(const Falcon&) = delete;
    Falcon& operator=(const Falcon&) = delete;

    DeviceInfo open() override;
    IoStatus read(DeviceSample& newest, Instant now) noexcept TACT_RT override;
    IoStatus write(const DeviceCommand& command, Instant now) noexcept TACT_RT override;
    void relax() noexcept override;

    [[nodiscard]] falcon::Pump& pump() noexcept { return *pump_; }

private:
    void find();
    void wait_for_first_reply();
    void say(const std::string& text) const;
    [[nodiscard]] DeviceInfo describe() const;

    void latch(DeviceNotice fault) noexcept;
    void forget_position() noexcept;
    void begin_generation() noexcept;
    void take() noexcept;
    void locate() noexcept;
    [[nodiscard]] bool homed() const noexcept { return news_.reply.homed == falcon::kHomedAll; }

    FalconSettings settings_;
    falcon::Kinematics legs_;
    std::unique_ptr<usb::Bus> bus_;
    std::unique_ptr<falcon::Pump> pump_;
    std::string serial_;
    usb::PumpThread thread_;
    bool opened_ = false;

    // Of the servo's thread.
    falcon::PumpNews news_;
    DeviceSample sample_;
    falcon::ArmConfiguration configuration_;
    std::array<VelocityWindow, 3> velocity_;
    std::uint64_t replies_ = 0;
    std::uint32_t generation_ = 0, jumps_ = 0;
    DeviceNotice fault_ = DeviceNotice::none, cause_ = DeviceNotice::none;
    bool located_ = false;  // marks found, and the legs are where a Falcon's can be
    bool lowered_ = false;  // enable was low since the fault
    bool gate_ = false;     // enable may go to the pump
    std::uint32_t relaxed_ = 0;
};

}  // namespace tact
