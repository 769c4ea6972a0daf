// Monitors each state of an arm's board for faults: the table of PROTOCOL.md and the faults of encoders and
// drives in REALTIME.md.
//
// Jump    a joint moves faster than kRateMax, twice the speed of a quick hand: the count is wrong
// Stuck   an encoder does not change by one count while its motor has more than a tenth of its continuous
//         current and the other joints move kStuckWayRad, away from the joint's limits
// Drive   the measured current deviates from the accepted command by more than 20 % of the limit for 50 ms;
//         with the amplifier off the current must be zero
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
    static constexpr double kAwayRad = 0.05;  // from a joint limit
    static constexpr std::uint32_t kDriveUs = 50'000;

    explicit ArmWatch(const ArmParameters& parameters) : p_(&parameters) {}

    // limit_ma: limit of each motor, the smaller of arm and board. q: joint angles, nullptr before they are
    // known. Returns the fault of this state, or none.
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
    std::array<double, 6> others_rad_{};  // path of the other joints since this one last moved, under current
    std::array<std::uint32_t, 6> off_us_{};
};

}  // namespace tact::phantom
