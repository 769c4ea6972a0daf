// Novint's Falcon: three degrees of freedom, with the firmware that the user supplies, over its serial
// converter (PROTOCOL.md). Not yet tested on hardware.
//
// open()    waits for the device for up to kFindMax, loads the firmware if none runs (about ten seconds),
//           waits for the first reply; then a pump thread owns the bus
// read()    newest state: position, velocity, buttons (bit 0, the clutch: the middle one); no orientation.
//           Until all three encoders have found their marks, the position is the origin, hand_present is
//           false, and the notice tells the user to pull the grip out and push it in all the way.
// write()   force to motor steps. None before the marks are found, during a fault, where the legs cannot
//           exert it, or before enable was low after these. Torques are ignored. The grip's weight is not
//           compensated.
// relax()   any thread, any state: no torque from the next packet on, until enable was low
// Replug    found again by its serial number, marks searched again; never re-armed automatically
// Errors    lost: no device, or 100 ms without a reply; fault: as latched; StartupError in open()
// Thread    open() and destruction on the main thread; read() and write() on the servo thread, memory only
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
    std::string serial;    // empty: the only Falcon on the bus
    std::string firmware;  // file; empty: the firmware must already run
    falcon::Geometry geometry;
    Duration hold_max = std::chrono::milliseconds(3);  // validity of the newest state
    int pump_priority = kPumpPriority;                 // FIFO; 0: ordinary scheduling
    bool thread = true;                                // false: the caller runs pump().round(), for tests
    void (*say)(const char* text) =
        nullptr;  // reports progress and reduced operation in open(); null: standard error
};

class Falcon final : public HapticDevice {
public:
    // The manufacturer states neither: low values, to be raised after a measurement.
    static constexpr double kForceContinuousN = 2.5;
    static constexpr double kStiffnessNM = 1000.0;
    static constexpr Duration kFindMax = std::chrono::seconds(5);  // a device that was just connected

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

    // Used by the servo thread only.
    falcon::PumpNews news_;
    DeviceSample sample_;
    falcon::ArmConfiguration configuration_;
    std::array<VelocityWindow, 3> velocity_;
    std::uint64_t replies_ = 0;
    std::uint32_t generation_ = 0, jumps_ = 0;
    DeviceNotice fault_ = DeviceNotice::none, cause_ = DeviceNotice::none;
    bool located_ = false;  // marks found, and the leg angles are possible
    bool lowered_ = false;  // enable was low since the fault
    bool gate_ = false;     // enable may be passed to the pump
    std::uint32_t relaxed_ = 0;
};

}  // namespace tact
