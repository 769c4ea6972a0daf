// An emulated Phantom with an emulated hand: the default device, also used by tests.
//
// Lockstep   its only time source is the `now` argument, so the same calls give the same motion, on any
//            clock
// Encoders   the position is quantized to encoder steps at the tip, the orientation to steps of the gimbal
// Amplifier  on only after an enable edge 0 -> 1; off at once when enable falls
// Pointer    the newest target is read before each step; a real device has none, so no window can move it
// Watchdog   trips exactly 10 ms after the last new heartbeat: the amplifier switches off and needs a new
//            edge
// Saturation a wrench beyond the motors' limits is scaled down; the direction is kept
#pragma once

#include "hal/api/haptic_device.hpp"
#include "hal/sim/sim_hand.hpp"
#include "ipc/shm/latest.hpp"

namespace tact {

struct SimSettings {
    SimHandSettings hand;
    Duration watchdog = std::chrono::milliseconds(10);
    const Latest<MouseTarget>* mouse = nullptr;  // targets of a pointer; null: the hand follows none
};

// Faults that tests can inject at any time.
enum class SimFault : std::uint8_t {
    none,
    unplugged,  // read and write return lost
    frozen,     // no new samples
    amplifier,  // over-temperature: amplifier off, state fault
    watchdog,   // the watchdog trips although it was fed
    wild_pose,  // a pose with NaN
    hand_off,   // no person holds it
};

class SimDevice final : public HapticDevice {
public:
    explicit SimDevice(const SimSettings& settings);

    DeviceInfo open() override;
    IoStatus read(DeviceSample& newest, Instant now) noexcept TACT_RT override;
    IoStatus write(const DeviceCommand& command, Instant now) noexcept TACT_RT override;
    void relax() noexcept override;

    void inject(SimFault fault) noexcept { fault_ = fault; }
    // Moves the hand to this place in the device frame and keeps it there; see SimHand.
    void hold(const std::optional<Vec3>& at_dev_m) noexcept { hand_.hold(at_dev_m); }
    // The present output of the motors, as measured at the device.
    [[nodiscard]] const Wrench& shown_dev() const noexcept { return shown_; }
    [[nodiscard]] const Pose& hand_pose() const noexcept { return hand_.pose(); }
    [[nodiscard]] DeviceState state() const noexcept { return state_; }

private:
    void advance(Instant now) noexcept;
    void drop(DeviceState to) noexcept;
    void sample(Instant now) noexcept;

    SimSettings settings_;
    DeviceInfo info_;
    SimHand hand_;
    SimFault fault_ = SimFault::none;
    DeviceState state_ = DeviceState::closed;
    DeviceSample newest_;
    Wrench shown_;
    Instant moved_at_{};
    Instant fed_at_{};
    std::uint64_t heartbeat_ = 0;
    bool started_ = false;
    bool enable_before_ = false;
};

}  // namespace tact
