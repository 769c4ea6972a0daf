// The head tracker on a CAN bus: a CanReader on its own thread.
//
// Thread   "can", FIFO 70 where permitted, else ordinary; never the servo's. It wakes for frames or every
//          10 ms, and blocks all signals.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "hal/tracker/can_reader.hpp"
#include "ipc/base/servo_clock.hpp"

namespace tact {

class CanTracker final : public Tracker {
public:
    static constexpr int kPriority = 70;

    CanTracker(const CanTrackerSettings& settings, const std::string& interface);
    // With any source of frames; `name` is for people.
    CanTracker(const CanTrackerSettings& settings, std::unique_ptr<CanSource> source, std::string name);
    ~CanTracker() override;
    CanTracker(const CanTracker&) = delete;
    CanTracker& operator=(const CanTracker&) = delete;

    TrackerInfo open() override;
    TrackerState read(unsigned sensor, TrackerSample& newest, Instant now) noexcept TACT_RT override;
    [[nodiscard]] TrackerHealth health() const noexcept TACT_RT override;

private:
    void live() noexcept;

    CanTrackerSettings settings_;
    std::string name_;
    std::unique_ptr<CanSource> source_;
    ServoClock clock_{Duration{0}};  // no spinning
    CanReader reader_;
    std::atomic<bool> leave_{false};
    std::thread thread_;
};

}  // namespace tact
