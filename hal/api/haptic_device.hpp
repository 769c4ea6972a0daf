// Interface of a force-feedback device for the servo loop.
//
// read() and write() only touch memory; a pump thread does the I/O of a bus. Frame: the
// device's own (x right, y up, z to the user, origin at the middle of the workspace), SI units.
#pragma once

#include <cstdint>
#include <string>

#include "ipc/base/bus_counts.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/device_notice.hpp"
#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

enum class IoStatus : std::uint8_t { ok, stale, lost, fault };
enum class DeviceState : std::uint8_t { closed, ready, powered, watchdog_tripped, fault };

struct DeviceInfo {
    std::string name, serial;
    Vec3 workspace_half_m = Vec3::Zero();  // box about the origin
    double force_n_max = 0.0;              // peak force
    double force_n_continuous = 0.0;
    double torque_n_m_max = 0.0;     // 0: no torque output
    double stiffness_n_m_max = 0.0;  // largest stable stiffness, from the manufacturer
    double position_step_m = 0.0;    // encoder resolution at the tip
};

struct DeviceSample {
    Instant taken_at{};
    std::uint64_t sequence = 0;  // rises with every new sample
    Pose T_dev_tool;
    Twist twist_dev;            // estimated by the driver
    std::uint32_t buttons = 0;  // bit 0: clutch; bit 1: drives the tool
    bool hand_present = false;
    DeviceState state = DeviceState::closed;
    DeviceNotice notice = DeviceNotice::none;  // action or condition to show to the user
    // From a sample to the first later one that the command in reply to it can have moved: the path from
    // encoders to motors in whole samples, rounded up. 0: unknown.
    Duration delay{0};
    BusCounts bus{};
    // Temperature of the hottest winding in degrees C from the driver's thermal model; winding_c_max 0: no model.
    float winding_c = 0.0F, winding_c_max = 0.0F;
    std::uint8_t hottest_motor = 0;
};

struct DeviceCommand {
    Wrench wrench_dev;
    bool enable = false;          // amplifier on; false means no force, regardless of the wrench
    std::uint64_t heartbeat = 0;  // rises with every cycle; input of the device's own watchdog
};

class HapticDevice {
public:
    virtual ~HapticDevice() = default;
    virtual DeviceInfo open() = 0;  // start-up: finds, checks and homes the device; throws StartupError
    virtual IoStatus read(DeviceSample& newest, Instant now) noexcept TACT_RT = 0;
    virtual IoStatus write(const DeviceCommand& command, Instant now) noexcept TACT_RT = 0;
    virtual void relax() noexcept = 0;  // motors to zero; safe at any time, in any state, and when repeated
};

}  // namespace tact
