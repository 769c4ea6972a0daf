// The emulated Phantom and hand in a separate process that outlives the controller, like a real device.
//
// Purpose   tests of a sudden death of tact-rt: the child's watchdog switches the amplifier off, its log
//           records it
// Child     forked in open(); steps at 1 kHz on the machine's clock, exchanges the newest command and
//           sample through shared memory; ends when its parent is gone
// Log       one line per change of state: monotonic ns, state, force in N, silence of the controller in ms
// Thread    open() and destruction on the main thread before other threads exist; read and write on the
//           servo's
// Errors    lost when the child gave no sample for 100 ms
#pragma once

#include <sys/types.h>

#include <string>

#include "hal/api/haptic_device.hpp"
#include "hal/sim/sim_device.hpp"

namespace tact {

class ProcessDevice final : public HapticDevice {
public:
    ProcessDevice(const SimSettings& settings, std::string log_path);
    ~ProcessDevice() override;
    ProcessDevice(const ProcessDevice&) = delete;
    ProcessDevice& operator=(const ProcessDevice&) = delete;

    DeviceInfo open() override;
    IoStatus read(DeviceSample& newest, Instant now) noexcept TACT_RT override;
    IoStatus write(const DeviceCommand& command, Instant now) noexcept TACT_RT override;
    void relax() noexcept override;

    [[nodiscard]] pid_t process() const noexcept { return child_; }  // of the device; tests kill it

private:
    struct Shared;
    [[noreturn]] void live(const SimSettings& settings, pid_t parent) noexcept;
    void wait_for_life();

    SimSettings settings_;
    std::string log_path_;
    Shared* shared_ = nullptr;
    pid_t child_ = -1;
    std::uint64_t sequence_ = 0;
    std::uint64_t heartbeat_ = 0;
};

}  // namespace tact
