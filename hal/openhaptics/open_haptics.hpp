// A Touch, Omni, Desktop or Premium through the manufacturer's library, where installed.
//
// Pump     the library's own scheduler thread, 1 kHz: it calls tick() of hd_pump.hpp, which owns the device
// Home     open() waits for the first sample; calibration follows during operation, with notices for the
//          user
// Ramp     the library's force ramp is off, since Tact's output chain has one; its clamp stays on
// Thread   open() and destruction at start-up and end; read(), write() and relax() per the contract
// Tested   with the tests' replacement library only, not on a real arm
#pragma once

#include <memory>
#include <optional>

#include "hal/openhaptics/hd_library.hpp"
#include "hal/openhaptics/hd_pump.hpp"

namespace tact {

struct OpenHapticsSettings {
    std::string library;  // libHD.so; empty: searched
    std::string device;   // as named in the manufacturer's set-up program; empty: the default one
    Duration first_sample_max = std::chrono::seconds(5);
};

class OpenHaptics final : public HapticDevice {
public:
    explicit OpenHaptics(const OpenHapticsSettings& settings);
    OpenHaptics(const OpenHapticsSettings& settings, Clock& clock);  // the clock outlives it
    ~OpenHaptics() override;
    OpenHaptics(const OpenHaptics&) = delete;
    OpenHaptics& operator=(const OpenHaptics&) = delete;

    DeviceInfo open() override;
    IoStatus read(DeviceSample& newest, Instant now) noexcept TACT_RT override;
    IoStatus write(const DeviceCommand& command, Instant now) noexcept TACT_RT override;
    void relax() noexcept override;

    [[nodiscard]] hd::Counts counts() const noexcept;

private:
    static hd::Enum callback(void* self) noexcept;
    void close() noexcept;
    void check(const std::string& attempt);
    void forget_errors();
    [[nodiscard]] double rate_hz();
    DeviceInfo describe(hd::PumpSettings& settings);
    void wait_for_first_sample();

    OpenHapticsSettings settings_;
    std::unique_ptr<Clock> own_clock_;
    Clock* clock_;
    std::optional<hd::Library> library_;
    std::unique_ptr<hd::Pump> pump_;
    hd::Handle device_ = hd::kInvalidDevice;
    hd::SchedulerHandle scheduled_ = 0;
    bool running_ = false;
};

}  // namespace tact
