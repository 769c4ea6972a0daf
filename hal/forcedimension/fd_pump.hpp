// One round of the pump: reads the pose, sends the newest command, checks the device's state, and searches a
// lost device.
//
// Frame     the device frame of hal/api: axes turned by fd_models.hpp, origin in the middle of the workspace
// Enable    force only after an enable edge, and only while heartbeats arrive (hal/vendor/output_gate.hpp);
//           the device's own watchdog of 10 ms stands behind it. Brakes are on while the force is off
// Errors    zero force in the same round, counted by kind, latched as hal/vendor/output_gate.hpp says
// Lost      closed; one attempt to open it every 500 ms, by its serial number. A device that must be
//           initialized is closed again, so that the manufacturer's program can do it. No automatic motion,
//           no automatic force
// Buttons   bit 0: first button, or a closed gripper; further bits as the library numbers them
// Delay     from a sample's round to the first one after the command that answered it, plus two periods of
//           the library's communication rate (of 1 kHz, where it reports none)
// Numbers   non-finite values, poses beyond any arm and transforms that are no rotation are refused and
//           counted; the last good sample stays and ages
// Thread    round() and finish() on the pump's; read(), write() and relax() on the servo's: memory only
#pragma once

#include <array>
#include <memory>

#include "hal/forcedimension/fd_session.hpp"
#include "hal/vendor/output_gate.hpp"

namespace tact::fd {

struct Counts {
    std::array<std::uint64_t, kFaultKinds> faults{};  // by FaultKind
    std::uint64_t rounds = 0;
    std::uint64_t repeated_samples = 0;    // TimeGuard: the pose of the communication before
    std::uint64_t refused_samples = 0;     // not finite, out of reach, or no rotation
    std::uint64_t missing_velocities = 0;  // the library's estimator was not ready: zero
    std::uint64_t refused_commands = 0;    // with NaN
    std::uint64_t saturated = 0;           // rounds with a motor at its limit
    std::uint64_t watchdog_trips = 0;
    std::uint64_t reopened = 0;
    int last_code = 0;  // of the library
    FaultKind last_kind = FaultKind::none;
};

class Pump {
public:
    static constexpr Duration kPeriod = std::chrono::microseconds(500);
    static constexpr Duration kReopenEvery = std::chrono::milliseconds(500);
    static constexpr Duration kSettle = std::chrono::milliseconds(50);  // from force on to its status
    static constexpr std::uint64_t kStatusEvery = 8;                    // rounds
    // The gripper as a button: closed below, open above.
    static constexpr double kGripperClosedRad = 0.12, kGripperOpenRad = 0.17;

    // The session is open and outlives the pump.
    Pump(const Api& api, Session& session);

    void round(Instant now) noexcept;
    void finish() noexcept;  // the last act: no force, brakes on

    IoStatus read(DeviceSample& newest, Instant now) noexcept TACT_RT { return mail_.read(newest, now); }
    IoStatus write(const DeviceCommand& command) noexcept TACT_RT { return mail_.write(command); }
    void relax() noexcept { mail_.relax(); }
    [[nodiscard]] Counts counts() const noexcept;

private:
    void reopen(Instant now) noexcept;
    void take_sample(Instant now) noexcept;
    void take_velocity() noexcept;
    void take_buttons() noexcept;
    void take_status(Instant now) noexcept;
    void check(int result, Instant now) noexcept;
    void fail(FaultKind kind, Instant now) noexcept;
    void apply(Instant now) noexcept;
    void send(Instant now) noexcept;
    void switch_output(bool on, Instant now) noexcept;
    void publish() noexcept;

    const Api* api_;
    Session* session_;
    vendor::ServoMail mail_;
    std::unique_ptr<Latest<Counts>> published_;

    // Used on the pump's thread.
    vendor::SampleWords sample_{};
    vendor::CommandWords command_{};
    vendor::OutputGate gate_;
    Counts counts_;
    Duration transport_ = std::chrono::milliseconds(2);
    Instant switched_at_{}, retry_at_{};
    bool output_on_ = false, gripped_ = false;
    bool waits_ = false;  // lost: for a device that is not initialized
};

}  // namespace tact::fd
