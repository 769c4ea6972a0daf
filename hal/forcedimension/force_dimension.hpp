// An omega, delta, sigma or lambda of Force Dimension through the manufacturer's library, where installed.
//
// open()    loads the library, opens the arm, checks that it is initialized (or initializes it, where the
//           settings say so: then the arm moves by itself), and waits for the first sample
// Pump      a thread of its own, 2 kHz: round() of fd_pump.hpp, which owns the device
// Gravity   off: every force passes Tact's output chain. On by a setting, and open() says so: the library then
//           holds the weight of the arm while the force is on
// Gripper   a button, without a force
// Replug    found again by its serial number; never re-armed automatically
// Thread    open() and destruction at start-up and end; read(), write() and relax() per the contract
// Tested    with the tests' replacement library only, not on a real arm
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "hal/forcedimension/fd_library.hpp"
#include "hal/forcedimension/fd_pump.hpp"
#include "ipc/base/fifo.hpp"

namespace tact {

struct ForceDimensionSettings {
    std::string library;                // libdrd.so or libdhd.so; empty: searched
    std::string serial;                 // decimal number; empty: the only device
    bool initialize = false;            // let an arm that is not initialized move by itself in open()
    bool gravity = false;               // the library holds the weight of the arm
    int pump_priority = kPumpPriority;  // FIFO; 0: ordinary scheduling
    bool thread = true;                 // false: the caller runs round(), for tests
    Duration first_sample_max = std::chrono::seconds(5);
    void (*say)(const char* text) =
        nullptr;  // progress and reduced operation in open(); null: standard error
};

class ForceDimension final : public HapticDevice {
public:
    explicit ForceDimension(const ForceDimensionSettings& settings);
    ForceDimension(const ForceDimensionSettings& settings, Clock& clock);  // the clock outlives it
    ~ForceDimension() override;
    ForceDimension(const ForceDimension&) = delete;
    ForceDimension& operator=(const ForceDimension&) = delete;

    DeviceInfo open() override;
    IoStatus read(DeviceSample& newest, Instant now) noexcept TACT_RT override;
    IoStatus write(const DeviceCommand& command, Instant now) noexcept TACT_RT override;
    void relax() noexcept override;

    void round() noexcept;  // without a thread
    [[nodiscard]] fd::Counts counts() const noexcept;

private:
    void close() noexcept;
    void run() noexcept;
    void say(const std::string& text) const;
    void wait_for_first_sample();
    [[nodiscard]] DeviceInfo describe() const;

    ForceDimensionSettings settings_;
    std::unique_ptr<Clock> own_clock_;
    Clock* clock_;
    std::optional<fd::Library> library_;
    std::optional<fd::Session> session_;
    std::unique_ptr<fd::Pump> pump_;
    std::thread thread_;
    std::atomic<bool> leave_{false};
};

}  // namespace tact
