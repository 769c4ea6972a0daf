// An emulated Phantom with an emulated hand on it: the default device, and the one that tests use.
//
// Lockstep   its time is the `now` that it is given, so the same calls give the same motion, on any clock
// Encoders   the position comes in steps of the encoder at the tip, the orientation in steps of the gimbal's
// Amplifier  on only after an enable edge 0 -> 1; off at once when enable falls
// Watchdog   no new heartbeat for 10 ms: the amplifier drops, at that very instant, and needs a new edge
// Saturation what is asked beyond the motors is shortened, direction kept
#pragma once

#include "hal/api/haptic_device.hpp"
#include "hal/sim/sim_hand.hpp"

namespace tact {

struct SimSettings {
    SimHandSettings hand;
    Duration watchdog = std::chrono::milliseconds(10);
};

// What can be made to go wrong, at any instant, for tests.
enum class SimFault : std::uint8_t {
    none,
    unplugged,  // read and write say lost
    frozen,     // the newest sample stays the newest
    amplifier,  // over-temperature: amplifier off, state fault
    watchdog,   // its watchdog trips although it was fed
    wild_pose,  // a pose that is not a number
    hand_off,   // nobody holds it
};

class SimDevice final : public HapticDevice {
public:
    explicit SimDevice(const SimSettings& settings);

    DeviceInfo open() override;
    IoStatus read(DeviceSample& newest, Instant now) noexcept TACT_RT override;
    IoStatus write(const DeviceCommand& command, Instant now) noexcept TACT_RT override;
    void relax() noexcept override;

    void inject(SimFault fault) noexcept { fault_ = fault; }
    // The hand goes there, device frame, and rests; see SimHand.
    void hold(const std::optional<Vec3>& at_dev_m) noexcept { hand_.hold(at_dev_m); }
    // What the motors do now, as someone at the device would measure it.
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
