// An Inverse3 or Minverse of Haply through the manufacturer's local Inverse Service 3.5 (README.md). Not yet
// tested on hardware, nor with the service itself.
//
// open()   connects, chooses the arm by its ID, puts the origin into the middle of its workspace, waits for the
//          first pose
// Pump     a thread of its own, 1 kHz or what the service answers: round() of inverse_pump.hpp
// Wrist    the orientation and buttons of a wireless VerseGrip, if exactly one is connected; no torque
// Replug   found again by its ID; never re-armed automatically
// Thread   open() and destruction at start-up and end; read(), write() and relax() per the contract
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "hal/haply/inverse_pump.hpp"
#include "ipc/base/fifo.hpp"

namespace tact {

struct Inverse3Settings {
    std::string serial;  // device ID, as "049D"; empty: the only arm
    std::uint16_t port = 10001;
    int pump_priority = kPumpPriority;  // FIFO; 0: ordinary scheduling
    bool thread = true;                 // false: the caller runs round(), for tests
    void (*say)(const char* text) = nullptr;
};

class Inverse3 final : public HapticDevice {
public:
    explicit Inverse3(const Inverse3Settings& settings);
    Inverse3(const Inverse3Settings& settings, std::unique_ptr<haply::Channel> channel, Clock& clock);
    ~Inverse3() override;
    Inverse3(const Inverse3&) = delete;
    Inverse3& operator=(const Inverse3&) = delete;

    DeviceInfo open() override;
    IoStatus read(DeviceSample& newest, Instant now) noexcept TACT_RT override;
    IoStatus write(const DeviceCommand& command, Instant now) noexcept TACT_RT override;
    void relax() noexcept override;

    void round() noexcept;
    [[nodiscard]] haply::InverseCounts counts() const noexcept;

private:
    void close() noexcept;
    void run() noexcept;

    Inverse3Settings settings_;
    std::unique_ptr<Clock> own_clock_;
    Clock* clock_;
    std::unique_ptr<haply::Channel> channel_;
    std::unique_ptr<haply::InversePump> pump_;
    std::thread thread_;
    std::atomic<bool> leave_{false};
};

}  // namespace tact
