// Looks at each state of an arm's board for what must not go on: PROTOCOL.md's table and REALTIME.md's faults
// of encoders and drives.
//
// Jump    a joint faster than kRateMax, twice what a quick hand makes of an arm: the count is wrong
// Stuck   an encoder that does not move by one count while its motor pushes with more than a tenth of its
//         continuous current and the arm's other joints go kStuckWayRad, away from the ends of its joint
// Drive   the measured current is off the one that the board has taken by more than 20 % of the limit for
//         50 ms; with the amplifier off nothing may flow
// Thread  servo; TACT_RT
#pragma once

#include <array>

#include "hal/arm/arm_kinematics.hpp"
#include "hal/phantom/usb_pump.hpp"
#include "ipc/base/device_notice.hpp"

namespace tact::phantom {

class ArmWatch {
public:
    static constexpr double kRateMax = 40.0;  // rad/s
    static constexpr double kStuckWayRad = 0.2;
    static constexpr double kAwayRad = 0.05;  // from a joint's end
    static constexpr std::uint32_t kDriveUs = 50'000;

    explicit ArmWatch(const ArmParameters& parameters) : p_(&parameters) {}

    // limit_ma: of each motor, the smaller of arm and board. q: joint angles, nullptr before they are known.
    // What is wrong with this state; none: nothing.
    DeviceNotice look(const PumpNews& news, const std::array<std::int16_t, 6>& limit_ma,
                      const Joint6* q) noexcept TACT_RT;
    void restart() noexcept TACT_RT { *this = ArmWatch(*p_); }

private:
    [[nodiscard]] bool jumped(const State& s, double dt_s) const noexcept;
    [[nodiscard]] bool stuck(const State& s, const Joint6* q) noexcept;
    [[nodiscard]] bool drive_broken(const PumpNews& news, const std::array<std::int16_t, 6>& limit_ma,
                                    std::uint32_t dt_us) noexcept;

    const ArmParameters* p_;
    bool started_ = false;
    State before_;
    std::array<double, 6> others_rad_{};  // way of the other joints since this one last moved, under current
    std::array<std::uint32_t, 6> off_us_{};
};

}  // namespace tact::phantom
