// One tick of the vendor's scheduler: reads the sample, sends the command, handles errors. Runs inside the
// vendor's servo loop.
//
// Frame     the device frame of hal/api: the library's axes are the same; its origin is shifted to the
//           middle
// Enable    force only after an enable edge, and only while heartbeats arrive: 10 ms without one trip the
//           watchdog, independently of the servo thread
// Calibrate done by the device after the user has completed the action in the notice. Before that, and
// after calibration is lost, the arm reports the origin with hand_present false, and there is no force
// Errors    zero force in the same tick, counted by kind, latched until enable was low for a whole tick and
//           no error occurred for 100 ms; an error that ends the scheduler stays until the device is opened
//           again. Nothing re-arms automatically: the next enable edge comes from a person.
// Delay     from a sample's tick to the one after the tick that sent its answer, plus the transport of
//           PumpSettings
// Numbers   non-finite values and transforms that are no rotation are refused and counted; the last good
//           sample stays and ages
// Thread    tick() on the vendor's; read(), write() and relax() on the servo's: they only touch memory
#pragma once

#include <array>
#include <memory>

#include "hal/api/haptic_device.hpp"
#include "hal/openhaptics/hd_faults.hpp"
#include "hal/vendor/output_gate.hpp"

namespace tact::hd {

struct Counts {
    std::array<std::uint64_t, kFaultKinds> faults{};  // by FaultKind
    std::uint64_t ticks = 0;
    std::uint64_t refused_samples = 0;   // with NaN or without a rotation
    std::uint64_t refused_commands = 0;  // with NaN
    std::uint64_t watchdog_trips = 0;
    std::uint64_t calibrations = 0;
    unsigned last_code = 0;  // of the library
    FaultKind last_kind = FaultKind::none;
};

struct PumpSettings {
    Vec3 centre_mm = Vec3::Zero();  // middle of the workspace in the library's frame
    double force_n_max = 0.0, torque_n_m_max = 0.0;
    int styles = 0;         // calibration styles
    Duration transport{0};  // of counts to the library and of force to the motors, not measurable in a tick
};

class Pump {
public:
    Pump(const Api& api, Handle device);

    // Before the first tick, on the thread that opens.
    void set(const PumpSettings& settings) noexcept { settings_ = settings; }

    Enum tick(Instant now) noexcept;  // the return value of the callback

    IoStatus read(DeviceSample& newest, Instant now) noexcept TACT_RT { return mail_.read(newest, now); }
    IoStatus write(const DeviceCommand& command) noexcept TACT_RT { return mail_.write(command); }
    void relax() noexcept { mail_.relax(); }
    [[nodiscard]] Counts counts() const noexcept;

    static constexpr Duration kHold = std::chrono::milliseconds(500);  // still in the reset pose
    static constexpr double kStillMm = 1.0;

private:
    void take_sample(Instant now) noexcept;
    void calibrate(Instant now) noexcept;
    [[nodiscard]] bool confirmed(Instant now) noexcept;
    [[nodiscard]] DeviceNotice asked() const noexcept;
    void take_errors(Instant now) noexcept;
    void fail(FaultKind kind, bool ends, Instant now) noexcept;
    void apply(Instant now) noexcept;
    void show() noexcept;
    void publish() noexcept;

    const Api* api_;
    Handle device_;
    PumpSettings settings_;
    vendor::ServoMail mail_;
    std::unique_ptr<Latest<Counts>> published_;

    // Used on the vendor's thread.
    vendor::SampleWords sample_{};
    vendor::CommandWords command_{};
    vendor::OutputGate gate_;
    Counts counts_;
    Instant held_since_{};
    Vec3 position_mm_ = Vec3::Zero(), held_mm_ = Vec3::Zero();
    bool ended_ = false, inkwell_ = false, output_on_ = false, calibrated_ = false;
    bool button_before_ = true;  // a button that is already down at the start is no confirmation
};

}  // namespace tact::hd
